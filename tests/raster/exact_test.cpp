// Shadows of a picture's own samples against brute force, on drawn scenes.

#include "raster/exact/exact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>

#include "core/topology.h"
#include "raster/camera_rays.h"
#include "raster/exact/casters.h"
#include "raster/exact/exact_shadow.h"
#include "raster/view.h"
#include "tests/raster/exact_oracle.h"
#include "tests/raster/exact_points.h"
#include "tests/raster/exact_scenes.h"

namespace obscura {
namespace {

using namespace exact_scenes;

struct Outcome {
    std::int64_t points = 0, lit = 0, dark = 0, unsure = 0;
};

void compare(unsigned seed, int count, Outcome& sum) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Source source(seed);
    const bool far_off = source.below(6) == 0;
    // Far off the floats of a mesh are 1/16 m apart; nothing else changes.
    const double unit = far_off ? 64 : std::pow(10, source.between(-2, 3));
    const Vec3d origin = far_off ? Vec3d{1e6, 2e6, -1e6} : source.in(-3, 3) * unit;
    const Mesh mesh = draw_mesh(source, unit, origin);
    const Light light = draw_light(source, mesh, unit, origin);
    // Near by, or so far that positions relative to it are coarse.
    const Vec3d eye = origin + source.in(-4, 7) * (unit * (source.below(4) == 0 ? 300 : 1));
    CasterScratch scratch;
    const Exec exec;
    const auto casters = build_casters(mesh, light, exec, scratch);
    const double pixel = std::pow(10, source.between(-4, -2));
    const CameraRays rays = rays_from(eye, pixel);
    const ExactLight exact = exact_light(light, casters, mesh, rays);
    const Points drawn = draw_points(source, mesh, eye, count);
    const ExactPoints points = drawn.view();

    // Kernels and ref agree, whatever the isa.
    std::vector<std::uint32_t> lit(drawn.covered.size());
    ExactWork work(drawn.face.size());
    ExactCounts counts;
    work.shadows(points, exact, Isa::ref, lit.data(), counts);
    std::optional<ExactCounts> of_kernels;
    for (const Isa isa : supported_isas()) {
        std::vector<std::uint32_t> other(lit.size());
        ExactCounts work_done;
        work.shadows(points, exact, isa, other.data(), work_done);
        ASSERT_EQ(other, lit) << isa_name(isa);
        EXPECT_EQ(work_done.samples, counts.samples);
        if (isa == Isa::ref) continue;
        if (!of_kernels) of_kernels = work_done;
        EXPECT_EQ(work_done.groups, of_kernels->groups) << isa_name(isa);
        EXPECT_EQ(work_done.triangles, of_kernels->triangles) << isa_name(isa);
    }

    const oracle::BruteForce brute(mesh, light, eye, pixel / 256, casters);
    for (int i = 0; i < drawn.count(); ++i) {
        const ref::ExactShadow s = ref::exact_shadow(points, exact, i);
        const bool is_lit = (lit[static_cast<std::size_t>(i) / 16] >> (i % 16) & 1u) != 0;
        ASSERT_EQ(is_lit, s.asks && s.lit) << "point " << i;
        if (!s.asks) continue;
        const auto at = static_cast<std::size_t>(i);
        const Vec3d p{drawn.p[0][at], drawn.p[1][at], drawn.p[2][at]};
        const Vec3d g = to_double(Vec3f{drawn.g[0][at], drawn.g[1][at], drawn.g[2][at]});
        ++sum.points;
        if (is_lit && !s.on_map) {
            // A point light's six views reach everywhere beyond their near planes.
            const Casters& view = casters[static_cast<std::size_t>(s.view)];
            const auto& w = view.view.to_map.m[3];
            const double distance = w[0] * p.x + w[1] * p.y + w[2] * p.z + w[3];
            ASSERT_TRUE(light.kind != LightKind::point || view.count == 0 ||
                        distance < view.view.near_w * (1 + 1e-9))
                << "point " << i << " of view " << s.view << ", " << distance << " m from the light";
            ++sum.lit;
            continue;
        }
        const int truth = brute.lit(p, g, s, drawn.triangle[at]);
        if (truth < 0) {
            ++sum.unsure;
            continue;
        }
        ++(truth == 1 ? sum.lit : sum.dark);
        ASSERT_EQ(is_lit, truth == 1)
            << "point " << i << " at " << p.x << ' ' << p.y << ' ' << p.z << ", grid " << s.x << ' ' << s.y;
    }
}

TEST(ExactShadows, AreThoseOfBruteForceOnDrawnScenes) {
    Outcome sum;
    // OBSCURA_SLOW_TESTS=45000 draws ten million points, in two minutes.
    const char* slow = std::getenv("OBSCURA_SLOW_TESTS");
    const unsigned scenes = slow != nullptr ? static_cast<unsigned>(std::max(3000, std::atoi(slow))) : 120;
    for (unsigned seed = 0; seed < scenes && !testing::Test::HasFatalFailure(); ++seed)
        compare(seed, 400, sum);
    EXPECT_GT(sum.lit, sum.points / 4);
    EXPECT_GT(sum.dark, sum.points / 4);
    EXPECT_LT(sum.unsure, sum.points / 20);
    RecordProperty("points", std::to_string(sum.points));
    RecordProperty("unsure", std::to_string(sum.unsure));
}

}  // namespace
}  // namespace obscura
