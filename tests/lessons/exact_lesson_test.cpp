// What lesson 19 says of shadow maps and exact shadows, at other sizes than it draws.

#include <gtest/gtest.h>

#include <vector>

#include "lessons/exact_scene.h"
#include "raster/camera_rays.h"
#include "raster/exact/casters.h"
#include "raster/exact/exact_shadow.h"

namespace obscura {
namespace {

/// Finer maps are wrong at fewer samples, but not at none; exact shadows at none, in finer
/// pictures too.
TEST(Lessons, LessonNineteensSamplesNeedNoMap) {
    const ExactScene scene = exact_scene();
    CasterScratch scratch;
    const std::vector<Casters> casters = build_casters(scene.mesh, scene.sun, {}, scratch);
    const ExactLight light =
        exact_light(scene.sun, casters, scene.mesh, camera_rays(scene.camera, exact_width, exact_height));
    const SeenPoints seen = seen_points(scene, 2, {});
    const Visibility truth = by_rays(scene, seen, {});
    ExactWork work(seen.size());
    ExactCounts counts;
    std::vector<std::uint32_t> lit(seen.covered.size());
    work.shadows(seen.points(), light, best_isa(), lit.data(), counts);
    EXPECT_EQ(of_bits(lit), truth);
    int before = static_cast<int>(seen.size());
    for (const int texels : {128, 256, 512, 1024}) {
        const WrongSamples wrong =
            wrong_samples(by_map(scene, seen, map_of(scene, texels, {}), 1, {}), truth);
        EXPECT_LT(wrong.dark + wrong.lit, before * 2 / 3) << texels;
        EXPECT_GT(wrong.dark + wrong.lit, 0) << texels;
        before = wrong.dark + wrong.lit;
    }
}

}  // namespace
}  // namespace obscura
