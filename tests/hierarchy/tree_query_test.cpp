// Lookups in serialised trees against the plain descent of the tree they stand for, for every code, layout,
// level, instruction set, with and without a top grid.

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <random>

#include "core/isa.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/codes/query.h"
#include "hierarchy/codes/tree_step.h"
#include "raster/interval_map.h"
#include "raster/view.h"
#include "tests/hierarchy/code_cases.h"
#include "tests/hierarchy/tree_oracle.h"
#include "tests/raster/raster_solids.h"

namespace obscura {
namespace {

Image<DepthInterval> scene_intervals(std::uint32_t seed, int side) {
    const Mesh mesh = solids::random_solids(seed, 40, seed % 2 == 0, false);
    const LightView view = orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.3, -1, 0.2}), side);
    return interval_map(mesh, view, {}, Exec{});
}

/// Constant but for noise: deep trees, many empty nodes.
Image<DepthInterval> random_intervals(std::uint32_t seed, int side) {
    std::mt19937 rng(seed);
    Image<DepthInterval> map(side, side);
    for (DepthInterval& i : map.pixels) {
        const auto entry = static_cast<float>(rng() % 13), exit = entry + static_cast<float>(rng() % 5);
        i = rng() % 4 == 0 ? DepthInterval{entry / 16.0f, exit / 16.0f} : DepthInterval{0.0f, 0.75f};
    }
    return map;
}

/// Points of a map of `size` texels: everywhere, some outside, runs of neighbours.
struct Points {
    std::vector<std::int32_t> x, y;
    std::vector<float> depth;
    MapPoints view() const { return {x.data(), y.data(), depth.data(), x.size()}; }
};

Points random_points(std::uint32_t seed, int size, std::size_t count, bool inside) {
    std::mt19937 rng(seed);
    Points p;
    const int margin = inside ? 0 : 3;
    std::uniform_int_distribution<int> place(-margin, size - 1 + margin), near(-2, 2);
    for (std::size_t i = 0; i < count; ++i) {
        const bool jump = i % 16 == 0 ? rng() % 2 == 0 || i == 0 : rng() % 40 == 0;
        const auto next = [&](const std::vector<std::int32_t>& v) {
            const int n = jump ? place(rng) : v.back() + near(rng);
            return inside ? std::clamp(n, 0, size - 1) : n;
        };
        p.x.push_back(next(p.x));
        p.y.push_back(next(p.y));
        p.depth.push_back(static_cast<float>(rng() % 17) / 16.0f);
    }
    return p;
}

std::vector<std::uint16_t> expected_bits(const MultiresTree& tree, const Points& p, int level) {
    const int size = 1 << tree.levels;
    std::vector<std::uint16_t> lit((p.x.size() + 15) / 16, 0);
    for (std::size_t i = 0; i < p.x.size(); ++i) {
        const bool inside = p.x[i] >= 0 && p.y[i] >= 0 && p.x[i] < size && p.y[i] < size;
        const bool is_lit =
            !inside || p.depth[i] <= value_at_level(tree, static_cast<std::uint32_t>(p.x[i]),
                                                    static_cast<std::uint32_t>(p.y[i]), level);
        lit[i / 16] = static_cast<std::uint16_t>(lit[i / 16] | (is_lit ? 1u << (i % 16) : 0u));
    }
    return lit;
}

void expect_lookups(const MultiresTree& tree, const TreeCode& code, std::size_t count, std::uint32_t seed) {
    const int size = 1 << tree.levels;
    for (int level = 0; level <= tree.levels; ++level) {
        const Points all = random_points(seed, size, count, false),
                     in = random_points(seed, size, count, true);
        const std::vector<std::uint16_t> expected = expected_bits(tree, all, level);
        for (const Isa isa : supported_isas()) {
            // One word more than is written, to see that nothing is written beyond.
            std::vector<std::uint16_t> lit(expected.size() + 1, 0xabcd),
                coherent(expected.size() + 1, 0xabcd);
            std::vector<float> value(count + 1, -7.0f);
            OBSCURA_DISPATCH(isa, visibility, code, all.view(), level, lit.data());
            OBSCURA_DISPATCH(isa, coherent_visibility, code, all.view(), level, coherent.data());
            OBSCURA_DISPATCH(isa, stored_values, code, in.x.data(), in.y.data(), count, level, value.data());
            ASSERT_EQ(lit.back(), 0xabcd);
            ASSERT_EQ(value.back(), -7.0f);
            lit.pop_back();
            coherent.pop_back();
            ASSERT_EQ(lit, expected) << isa_name(isa) << " level " << level;
            ASSERT_EQ(coherent, expected) << isa_name(isa) << " level " << level;
            for (std::size_t i = 0; i < count; ++i) {
                const float want = value_at_level(tree, static_cast<std::uint32_t>(in.x[i]),
                                                  static_cast<std::uint32_t>(in.y[i]), level);
                ASSERT_EQ(std::bit_cast<std::uint32_t>(value[i]), std::bit_cast<std::uint32_t>(want))
                    << isa_name(isa) << " level " << level << " point " << i;
            }
        }
    }
}

class Codes : public testing::TestWithParam<CodeCase> {};

TEST_P(Codes, FindTheValuesOfThePlainDescentAtEveryLevel) {
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        for (const Image<DepthInterval>& map : {scene_intervals(seed, 128), random_intervals(seed, 64)}) {
            const MultiresTree tree = build_bottom_up(map.view());
            for (const int offset_bits : {0, 9}) {
                ShadowTree code = encode_tree(tree, {}, params_of(GetParam(), 0, offset_bits));
                ASSERT_EQ(code.code.code, GetParam().code);
                ASSERT_EQ(code.code.layout, GetParam().layout);
                const MultiresTree behind = tree_behind(code, tree);
                expect_lookups(behind, code.code, 517, seed);
                for (const int top : {1, 4, tree.levels}) {
                    set_top_grid(code, top);
                    expect_lookups(behind, code.code, 230, seed + 10);
                }
            }
        }
    }
}

TEST_P(Codes, HoldTreesOfOneNodeAndMapsOfOneTexel) {
    for (const int side : {1, 2, 64}) {
        const Image<DepthInterval> background(side, side, DepthInterval{0.25f, 0.5f});
        const MultiresTree tree = build_bottom_up(background.view());
        ShadowTree code = encode_tree(tree, {}, params_of(GetParam()));
        const MultiresTree behind = tree_behind(code, tree);
        for (const std::size_t count : {std::size_t{1}, std::size_t{16}, std::size_t{33}})
            expect_lookups(behind, code.code, count, 5);
        set_top_grid(code, tree.levels);
        expect_lookups(behind, code.code, 40, 6);
    }
}
INSTANTIATE_TEST_SUITE_P(Query, Codes, testing::ValuesIn(code_cases),
                         [](const testing::TestParamInfo<CodeCase>& c) { return std::string(c.param.name); });

TEST(Query, NoPointsAreNoWork) {
    const Image<DepthInterval> background(8, 8);
    const ShadowTree code = encode_tree(build_bottom_up(background.view()), {});
    for (const Isa isa : supported_isas()) {
        std::uint16_t lit = 77;
        OBSCURA_DISPATCH(isa, visibility, code.code, MapPoints{}, 0, &lit);
        OBSCURA_DISPATCH(isa, coherent_visibility, code.code, MapPoints{}, 0, &lit);
        EXPECT_EQ(lit, 77);
    }
}

TEST(Query, NodesMayStandBeyondTwoToThe31Units) {
    // Nodes that the top grid names by large indices, and units that begin as far before them: only what is
    // read needs to be there.
    const Image<DepthInterval> map = random_intervals(4, 32);
    const MultiresTree tree = build_bottom_up(map.view());
    ShadowTree encoded = encode_tree(tree, {});
    set_top_grid(encoded, 2);
    constexpr std::uint32_t shift = 3u << 30;
    std::vector<TopNode> top = *encoded.top;
    for (TopNode& t : top) {
        t.node = t.node == no_tree_node ? t.node : t.node + shift;
        t.value += shift;
    }
    TreeCode far = encoded.code;
    far.top = top.data();
    far.units = reinterpret_cast<const std::uint8_t*>(reinterpret_cast<std::uintptr_t>(far.units) -
                                                      std::uintptr_t{shift} * 4);
    const Points in = random_points(1, 32, 400, true);
    for (const Isa isa : supported_isas()) {
        if (isa == Isa::ref) continue;  // starts at the root, which stands at unit 0
        std::vector<float> value(400);
        OBSCURA_DISPATCH(isa, stored_values, far, in.x.data(), in.y.data(), 400, 0, value.data());
        for (std::size_t i = 0; i < 400; ++i) {
            ASSERT_EQ(value[i], value_at(tree, static_cast<std::uint32_t>(in.x[i]),
                                         static_cast<std::uint32_t>(in.y[i])));
        }
    }
}

TEST(Query, APathVisitsOnlyWhatIsNew) {
    const Image<DepthInterval> map = random_intervals(9, 64);
    const MultiresTree tree = build_bottom_up(map.view());
    const ShadowTree code = encode_tree(tree, {});
    using Code = MhCode<TreeLayout::words24>;
    TreePath path;
    start_path<Code>(code.code, path);
    extend_path<Code>(code.code, 21, 40, 0, path);
    const int first = path.steps;
    EXPECT_GT(first, 3);
    EXPECT_LE(first, 6);
    extend_path<Code>(code.code, 21, 40, 0, path);
    EXPECT_EQ(path.steps, first) << "the same texel costs nothing";
    extend_path<Code>(code.code, 20, 40, 0, path);
    EXPECT_LE(path.steps, first + 1) << "a sibling costs a step at most";
    extend_path<Code>(code.code, 21, 40, 6, path);
    EXPECT_LE(path.steps, first + 1) << "the root is known";
}

}  // namespace
}  // namespace obscura
