// The code facet: every texel decodes to a depth of its own interval, whatever the solids, the view and the
// receivers; the same tree for any threads and instruction set.

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "core/isa.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/codes/query.h"
#include "hierarchy/facet/facet.h"
#include "hierarchy/facet/facet_step.h"
#include "raster/interval_map.h"
#include "raster/view.h"
#include "tests/hierarchy/hard_meshes.h"
#include "tests/raster/raster_solids.h"

namespace obscura {
namespace {

struct Case {
    std::string name;
    Mesh mesh;
    LightView view;
    Receivers receivers;
};

BuildParams params_of(const Case& c) {
    BuildParams params;
    params.receivers = c.receivers;
    return params;
}

ShadowTree tree_of(const Case& c, const Exec& exec = {}) {
    return encode_facet(build_facet_tree(c.mesh, c.view, params_of(c), exec), c.view, {});
}

Image<DepthInterval> intervals_of(const Case& c) {
    IntervalParams params;
    params.receivers = c.receivers;
    return interval_map(c.mesh, c.view, params, Exec{});
}

/// Solids that touch, nest, coincide, cross and are open or turned inside out, in every kind of view, for
/// both kinds of receivers.
template <class Check>
void for_each_case(int side, int seeds, const Check& check) {
    const Vec3d ways[] = {{0.3, -1, 0.2}, {1, -0.12, 0.4}, {0, -1, 0}};
    for (std::uint32_t seed = 1; seed <= static_cast<std::uint32_t>(seeds); ++seed) {
        for (const bool open : {false, true}) {
            const Mesh mesh = solids::random_solids(seed + 40, 20 + 40 * (seed % 2), open, seed % 2 == 0);
            const Bounds b = bounds_of(mesh);
            for (const Vec3d& way : ways) {
                const Vec3d to = normalize(way), middle = (b.low + b.high) * 0.5;
                const LightView views[] = {
                    orthographic_light_view(b, to, side),
                    perspective_light_view(middle - to * 14.0, to, 40, 4, 30, side),
                };
                for (const LightView& view : views) {
                    for (const Receivers receivers : {Receivers::any, Receivers::static_only})
                        check(Case{"solids " + std::to_string(seed) + (open ? " open" : ""), mesh, view,
                                   receivers});
                }
            }
        }
    }
}

void expect_lossless(const Case& c) {
    const ShadowTree tree = tree_of(c);
    const char* fault = facet_fault_of(tree);
    ASSERT_EQ(fault, nullptr) << c.name << ": " << fault;
    const Image<DepthInterval> map = intervals_of(c);
    int outside = 0;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const float depth =
                tree_value(tree.code, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
            const DepthInterval i = map(x, y);
            if (i.entry <= depth && depth <= i.exit) continue;
            if (++outside == 1) {
                ADD_FAILURE() << c.name << " " << (c.receivers == Receivers::any ? "any" : "static")
                              << " texel " << x << ", " << y << ": " << depth << " not in [" << i.entry
                              << ", " << i.exit << "], below by " << i.entry - depth << ", above by "
                              << depth - i.exit;
            }
        }
    }
    EXPECT_EQ(outside, 0) << c.name << " of " << map.width;
}

TEST(Facet, EveryTexelDecodesToADepthOfItsInterval) {
    for (const int side : {1, 2, 8, 64, 128})
        for_each_case(side, side == 128 ? 4 : 2, expect_lossless);
}

TEST(Facet, EveryTexelDecodesToADepthOfItsIntervalAtFinerMaps) {
    for_each_case(512, 2, expect_lossless);
}

TEST(Facet, TheSameTreeForAnyThreadsAndInstructionSet) {
    // Large enough to be shared out among threads; every fourth of the cases.
    int number = 0;
    for_each_case(256, 1, [&](const Case& c) {
        if (number++ % 4 != 0) return;
        const ShadowTree first = tree_of(c, {Isa::sse2, 1});
        for (const Isa isa : supported_isas()) {
            for (const int threads : {1, 3}) {
                const ShadowTree other = tree_of(c, {isa, threads});
                ASSERT_EQ(other.bytes, first.bytes);
                ASSERT_EQ(
                    std::memcmp(other.code.units, first.code.units, static_cast<std::size_t>(first.bytes)),
                    0);
            }
        }
    });
}

/// One tap, any level, kernels and the coherent form, against the plain descent.
TEST(Facet, LanesFindWhatThePlainDescentFinds) {
    for_each_case(128, 2, [](const Case& c) {
        ShadowTree tree = tree_of(c);
        const int size = c.view.width;
        std::vector<std::int32_t> xs, ys;
        std::vector<float> depths;
        for (int i = 0; i < 1037; ++i) {
            xs.push_back((i * 7919 / 13 + (i % 4)) % size);
            ys.push_back((i * 104729 / 29 + (i / 4 % 4)) % size);
        }
        for (const int top : {0, 3}) {
            set_top_grid(tree, top);
            for (int level = 0; level <= tree.code.levels; ++level) {
                std::vector<float> want(xs.size()), got(xs.size());
                depths.clear();
                for (std::size_t i = 0; i < xs.size(); ++i) {
                    want[i] = tree_value_at_level(tree.code, static_cast<std::uint32_t>(xs[i]),
                                                  static_cast<std::uint32_t>(ys[i]), level);
                    depths.push_back(i % 3 == 0 ? want[i] : want[i] + (i % 3 == 1 ? 1e-7f : -1e-7f));
                }
                const MapPoints points{xs.data(), ys.data(), depths.data(), xs.size()};
                std::vector<std::uint16_t> lit(xs.size() / 16 + 1), coherent(lit.size()),
                    expected(lit.size());
                ref::visibility(tree.code, points, level, expected.data());
                for (const Isa isa : supported_isas()) {
                    OBSCURA_DISPATCH(isa, stored_values, tree.code, xs.data(), ys.data(), xs.size(), level,
                                     got.data());
                    ASSERT_EQ(std::memcmp(got.data(), want.data(), want.size() * sizeof want[0]), 0)
                        << isa_name(isa) << " level " << level;
                    OBSCURA_DISPATCH(isa, visibility, tree.code, points, level, lit.data());
                    OBSCURA_DISPATCH(isa, coherent_visibility, tree.code, points, level, coherent.data());
                    ASSERT_EQ(lit, expected) << isa_name(isa);
                    ASSERT_EQ(coherent, expected) << isa_name(isa);
                }
            }
        }
    });
}

}  // namespace
}  // namespace obscura
