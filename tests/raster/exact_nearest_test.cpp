// What stands before points in shadow: kernels against the definition, the definition against every triangle.

#include "raster/exact/exact_nearest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/topology.h"
#include "raster/depth_tile.h"
#include "raster/exact/casters.h"
#include "raster/exact/exact_shadow.h"
#include "tests/raster/exact_points.h"
#include "tests/raster/exact_scenes.h"

namespace obscura {
namespace {

using namespace exact_scenes;

struct Hits {
    std::vector<std::uint32_t> triangle;
    std::vector<float> distance_m;
    explicit Hits(std::size_t count) : triangle(count, no_triangle), distance_m(count, -1) {}
    ExactHits view() { return {triangle.data(), distance_m.data()}; }
    friend bool operator==(const Hits&, const Hits&) = default;
};

Hits hits_of(const ExactPoints& points, const ExactLight& light, Isa isa) {
    const auto count = static_cast<std::size_t>(points.count);
    ExactWork work(count);
    ExactCounts counts;
    std::vector<std::uint32_t> lit(count / 16);
    work.shadows(points, light, isa, lit.data(), counts);
    Hits hits(count);
    std::vector<std::uint32_t> lit_beside(count / 16, 0xaaaau);
    work.nearest(points, light, isa, lit_beside.data(), hits.view(), counts);
    EXPECT_EQ(lit_beside, lit) << isa_name(isa);
    return hits;
}

struct Seen {
    std::int64_t points = 0, dark = 0;
};

void compare(unsigned seed, Seen& sum) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Source source(seed);
    const double unit = std::pow(10, source.between(-2, 3));
    const Vec3d origin = source.below(6) == 0 ? Vec3d{1e5, 2e5, -1e5} : source.in(-3, 3) * unit;
    const Mesh mesh = draw_mesh(source, unit, origin);
    Light light = draw_light(source, mesh, unit, origin);
    light.kind = LightKind::directional;
    light.direction = normalize(source.in(-1, 1));
    const Vec3d eye = origin + source.in(-4, 7) * unit;
    CasterScratch scratch;
    const auto casters = build_casters(mesh, light, {}, scratch);
    const ExactLight exact =
        exact_light(light, casters, mesh, rays_from(eye, std::pow(10, source.between(-4, -2))));
    const Points drawn = draw_points(source, mesh, eye, 400);
    const ExactPoints points = drawn.view();

    Hits found = hits_of(points, exact, Isa::ref);
    for (const Isa isa : supported_isas())
        ASSERT_EQ(hits_of(points, exact, isa), found) << isa_name(isa);
    for (int i = 0; i < drawn.count(); ++i) {
        const ref::ExactShadow s = ref::exact_shadow(points, exact, i);
        const auto at = static_cast<std::size_t>(i);
        ++sum.points;
        ASSERT_EQ(found.triangle[at] != no_triangle, s.asks && !s.lit) << "point " << i;
        if (found.triangle[at] == no_triangle) continue;
        ++sum.dark;
        // Several triangles of one plane may be as near.
        EXPECT_NEAR(found.distance_m[at], s.distance_m, 1e-6 * s.distance_m) << "point " << i;
    }
}

TEST(ExactNearest, IsTheNearestOfAllThatDarken) {
    Seen sum;
    const char* slow = std::getenv("OBSCURA_SLOW_TESTS");
    const unsigned scenes = slow != nullptr ? static_cast<unsigned>(std::max(1000, std::atoi(slow))) : 80;
    for (unsigned seed = 0; seed < scenes && !testing::Test::HasFatalFailure(); ++seed)
        compare(seed, sum);
    EXPECT_GT(sum.dark, sum.points / 5);
}

/// So many small triangles, and large ones, in a column below the light.
Mesh column(Source& source, int triangles) {
    Mesh mesh;
    for (int t = 0; t < triangles; ++t) {
        const Vec3d at{source.between(-1, 1), source.between(0, 30), source.between(-1, 1)};
        const double size = t % 50 == 0 ? 3 : 0.2;
        for (int k = 0; k < 3; ++k) {
            mesh.positions.push_back(to_float(at + source.in(-1, 1) * size));
            mesh.normals.push_back({0, 1, 0});
        }
        const auto v = static_cast<std::uint32_t>(3 * t);
        mesh.triangles.push_back({{v, v + 1, v + 2}});
    }
    mesh.material.assign(mesh.triangles.size(), 0);
    mesh.object.assign(mesh.triangles.size(), 0);
    mesh.objects.assign(1, Object{"column", true});
    analyse_topology(mesh);
    return mesh;
}

TEST(ExactNearest, InColumnsOfAnyNumber) {
    // Up to 256 near sixteen bunches, up to 4096 near one, and more.
    for (const int triangles : {40, 600, 6000}) {
        Source source(static_cast<unsigned>(triangles));
        const Mesh mesh = column(source, triangles);
        Light light;
        light.kind = LightKind::directional;
        light.direction = normalize(Vec3d{0.02, -1, 0.01});
        CasterScratch scratch;
        const auto casters = build_casters(mesh, light, {}, scratch);
        const ExactLight exact = exact_light(light, casters, mesh, rays_from({0, 40, 60}, 1e-3));
        const Points drawn = draw_points(source, mesh, {0, 40, 60}, 160);
        const ExactPoints points = drawn.view();
        const Hits found = hits_of(points, exact, Isa::ref);
        std::int64_t dark = 0;
        for (const std::uint32_t t : found.triangle)
            dark += t != no_triangle ? 1 : 0;
        EXPECT_GT(dark, 8) << triangles;
        for (const Isa isa : supported_isas())
            ASSERT_EQ(hits_of(points, exact, isa), found) << isa_name(isa) << ", " << triangles;
    }
}

TEST(ExactNearest, WantsParallelLight) {
    Source source(1);
    const Mesh mesh = draw_mesh(source, 1, {});
    Light light;
    light.kind = LightKind::point;
    light.position = {0, 50, 0};
    CasterScratch scratch;
    const auto casters = build_casters(mesh, light, {}, scratch);
    const ExactLight exact = exact_light(light, casters, mesh, rays_from({0, 9, 9}, 1e-3));
    const Points drawn = draw_points(source, mesh, {0, 9, 9}, 16);
    EXPECT_DEATH(hits_of(drawn.view(), exact, Isa::ref), "parallel");
}

}  // namespace
}  // namespace obscura
