// The construction from triangles against its definition: bottom-up over every texel's interval, bit for bit.

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "core/error.h"
#include "core/topology.h"
#include "hierarchy/build.h"
#include "hierarchy/combine.h"
#include "raster/interval_map.h"
#include "raster/view.h"
#include "raster_solids.h"
#include "scenes/city.h"
#include "scenes/shapes.h"

namespace obscura {
namespace {

LightView oblique_view(const Mesh& mesh, int side) {
    return orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.31, -1, 0.23}), side);
}

/// Node by node in the order of the construction, bits of the values included.
::testing::AssertionResult same_tree(const MultiresTree& a, const MultiresTree& b) {
    if (a.levels != b.levels || a.nodes.size() != b.nodes.size()) {
        return ::testing::AssertionFailure() << a.nodes.size() << " nodes and " << b.nodes.size();
    }
    const auto same = [](const MultiresNode& p, const MultiresNode& q) {
        return std::memcmp(&p.value, &q.value, sizeof p.value) == 0 && p.kinds == q.kinds &&
               (p.kinds == 0 || p.first_child() == q.first_child());
    };
    if (!same(a.root, b.root) || a.root_interval != b.root_interval)
        return ::testing::AssertionFailure() << "root differs";
    for (std::size_t i = 0; i < a.nodes.size(); ++i) {
        if (!same(a.nodes[i], b.nodes[i])) return ::testing::AssertionFailure() << "node " << i << " differs";
    }
    return ::testing::AssertionSuccess();
}

MultiresTree reference(const Mesh& mesh, const LightView& view, Receivers receivers) {
    IntervalParams params;
    params.receivers = receivers;
    return build_bottom_up(interval_map(mesh, view, params, Exec{}).view());
}

void expect_equal(const Mesh& mesh, const LightView& view, Receivers receivers = Receivers::any) {
    BuildParams params;
    params.receivers = receivers;
    const MultiresTree expected = reference(mesh, view, receivers);
    EXPECT_TRUE(same_tree(build_shadow_tree(mesh, view, params, Exec{}), expected));
    params.mesh_certificate = false;
    EXPECT_TRUE(same_tree(build_shadow_tree(mesh, view, params, Exec{}), expected));
}

TEST(ShadowBuild, EqualsBottomUpOnRandomSolids) {
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        const Mesh mesh = solids::random_solids(seed, 40, seed % 2 == 0, seed % 3 == 0);
        for (const int side : {1, 2, 8, 16, 64, 512}) {
            SCOPED_TRACE(::testing::Message() << "seed " << seed << ", side " << side);
            expect_equal(mesh, oblique_view(mesh, side),
                         seed % 4 == 0 ? Receivers::static_only : Receivers::any);
        }
    }
}

TEST(ShadowBuild, EqualsBottomUpStraightDown) {
    // Faces of constant depth, edge-on walls, coinciding faces.
    for (std::uint32_t seed = 20; seed <= 24; ++seed) {
        const Mesh mesh = solids::random_solids(seed, 60, true, false);
        const LightView view = orthographic_light_view(bounds_of(mesh), {0, -1, 0}, 512);
        expect_equal(mesh, view);
        expect_equal(mesh, view, Receivers::static_only);
    }
}

TEST(ShadowBuild, EqualsBottomUpInPerspective) {
    for (std::uint32_t seed = 30; seed <= 34; ++seed) {
        const Mesh mesh = solids::random_solids(seed, 50, seed % 2 == 0, false);
        for (const LightView& view :
             {perspective_light_view({0.5, 9, 0.3}, normalize(Vec3d{0.1, -1, 0.2}), 70, 0.1, 30, 512),
              perspective_light_view({0.2, 0.1, 0.3}, normalize(Vec3d{1, -0.2, 0.4}), 100, 0.05, 20, 256)}) {
            expect_equal(mesh, view);
        }
    }
}

TEST(ShadowBuild, EqualsBottomUpOnSmoothMeshes) {
    // Many facets to a surface: the mesh certificate's own ground.
    Mesh mesh;
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> place(-3, 3);
    for (int i = 0; i < 7; ++i)
        solids::add(mesh, solids::shifted(sphere(1.2, 64, 32), {place(rng), place(rng), place(rng)}));
    for (const int side : {128, 1024, 2048})
        expect_equal(mesh, oblique_view(mesh, side));
}

TEST(ShadowBuild, StopsBeforeItGrowsTooLarge) {
    const Mesh mesh = solids::random_solids(5, 60, true, false);
    const LightView view = oblique_view(mesh, 1024);
    BuildParams params;
    params.max_nodes = build_shadow_tree(mesh, view, params, Exec{}).nodes.size();
    EXPECT_NO_THROW(build_shadow_tree(mesh, view, params, Exec{}));
    params.max_nodes /= 2;
    EXPECT_THROW(build_shadow_tree(mesh, view, params, Exec{}), LimitError);
}

TEST(ShadowBuild, SameBitsForEveryExec) {
    const Mesh mesh = solids::random_solids(5, 60, true, false);
    const LightView view = oblique_view(mesh, 1024);
    const MultiresTree expected = build_shadow_tree(mesh, view, {}, {Isa::ref, 1});
    for (const Isa isa : supported_isas()) {
        for (const int threads : {1, 2, 3, 7})
            EXPECT_TRUE(same_tree(build_shadow_tree(mesh, view, {}, {isa, threads}), expected));
    }
}

}  // namespace
}  // namespace obscura
