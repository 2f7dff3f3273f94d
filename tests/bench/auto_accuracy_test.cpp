// Shadows at the resolution that "auto" finds, against exact rays at every pixel: the default shadow of every
// scene, built for the frame, with one tap per pixel.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/shadows/scenes.h"
#ifdef OBSCURA_HAS_EMBREE
#include "app/frame/shadows.h"
#include "bench/shadows/exact_rays.h"
#include "bench/shadows/visible_points.h"
#include "bench/shadows/wrong_pixels.h"
#include "core/parallel.h"

namespace obscura {
namespace {

constexpr double goal = 0.0005;  ///< wrong pixels, of those that see a surface

/// Texels as large as pixels, at the pixel that needs most, do not always reach the goal in so small a
/// picture: nearly all wrong pixels lie on the outlines of shadows, whose share of a picture grows as the
/// picture shrinks, and each outline is off by up to half a texel. What half as large texels do is tested
/// too.
struct Case {
    const char* scene;
    double most;       ///< wrong pixels allowed at max_magnification = 1, as a share
    double most_fine;  ///< and at 0.5
};

/// What happened at one max_magnification.
struct Found {
    FoundResolution resolution;
    std::uint64_t bytes = 0;
    WrongPixels wrong;
};

/// A scene's points and what is so at them.
struct Stage {
    Exec exec{best_isa(), hardware_threads()};
    Scene scene;
    VisiblePoints points;
    ExactRays rays;
    TrueShadows truth;

    explicit Stage(const ShadowRecipe& recipe)
        : scene(stage_shadows(recipe, {640, 360})),
          points(visible_points(scene, exec)),
          rays(scene.mesh),
          truth(true_shadows_of(scene, points, rays, exec)) {}

    Found wrong_at(double max_magnification) {
        SceneLight& light = scene.lights[0];
        light.shadow = ShadowSettings{};  // compressed, auto, scope frame
        light.shadow.filter_px = 1;
        light.shadow.max_magnification = max_magnification;
        FrameCache cache;
        FrameStats stats;
        prepare_scene(scene, exec, cache, stats);
        TileScene tiles = prepare_tiles(scene, exec, cache);
        EXPECT_TRUE(prepare_shadows(scene, 0, exec, cache, tiles, stats));
        const LightShadow& shadow = cache.shadows.at(0);
        const PcfLight& pcf = *tiles.lights.at(0).pcf;
        const auto lookup = [&](const SurfaceBlock& surface, float* visibility) {
            OBSCURA_DISPATCH(exec.isa, pcf_block, surface, pcf, visibility);
        };
        const auto shown = shown_shadows(points, lookup, exec);
        return {*shadow.stats.found, shadow.stats.bytes, wrong_pixels(truth, shown, shadow.view(0), exec)};
    }
};

std::filesystem::path data_folder() {
    const char* elsewhere = std::getenv("OBSCURA_DATA");
    return elsewhere != nullptr ? elsewhere : OBSCURA_SOURCE_DIR "/../shared/data";
}

class AutoAccuracy : public testing::TestWithParam<Case> {};

TEST_P(AutoAccuracy, WrongPixelsAgainstExactRays) {
    std::vector<ShadowRecipe> recipes = shadow_recipes(data_folder(), false);
    const auto recipe = std::find_if(recipes.begin(), recipes.end(),
                                     [](const ShadowRecipe& r) { return r.name == GetParam().scene; });
    if (recipe == recipes.end()) GTEST_SKIP() << "no " << GetParam().scene << " in " << data_folder();
    Stage stage(*recipe);
    for (const double most : {1.0, 0.5}) {
        const Found found = stage.wrong_at(most);
        const WrongPixels& w = found.wrong;
        std::printf("%s, max_magnification %g: %d texels (%.2f), %.2f MB, %zu of %zu wrong = %.4f %% (%s)\n",
                    GetParam().scene, most, found.resolution.resolution, found.resolution.magnification,
                    1e-6 * static_cast<double>(found.bytes), w.wrong, w.covered, 100 * w.fraction(),
                    kinds_text(w).c_str());
        EXPECT_GT(w.facing, 50000u);
        EXPECT_FALSE(found.resolution.capped);
        EXPECT_LT(w.fraction(), most == 1.0 ? GetParam().most : GetParam().most_fine);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, AutoAccuracy,
                         testing::Values(Case{"city", 2 * goal, goal}, Case{"town", 2 * goal, goal},
                                         Case{"vienna_west", goal, goal}, Case{"fzk_house", goal, goal},
                                         Case{"armadillo", 2 * goal, goal}),
                         [](const auto& one) { return std::string(one.param.scene); });

}  // namespace
}  // namespace obscura
#else
TEST(AutoAccuracy, NeedsEmbree) {
    GTEST_SKIP() << "this build has no Embree to trace exact rays with";
}
#endif
