// Serialised octrees: what was encoded comes back, every texel of every map decodes to a depth of its
// interval.

#include <gtest/gtest.h>

#include "hierarchy/stack/encode.h"
#include "hierarchy/stack/stack_units.h"
#include "tests/hierarchy/tree_compare.h"
#include "tests/stack/stack_oracle.h"
#include "tests/stack/stack_scenes.h"

namespace obscura {
namespace {

using lit::Lamp;

StackTree stack_of(const oracle::Maps& maps, int anisotropy) {
    StackTreeParams params;
    params.anisotropies = {anisotropy};
    int levels = 0;
    while (1 << levels < maps[0].width)
        ++levels;
    return build_stack_tree(
        static_cast<int>(maps.size()), levels,
        [&](int k) { return oracle::certain_tree_of(maps[static_cast<std::size_t>(k)]); }, params, Exec{});
}

ShadowStack encoded(const StackTree& tree, const StackEncodeParams& params = {}) {
    ShadowStack stack;
    encode_stack(tree, params, stack);
    return stack;
}

std::size_t texels_outside(const ShadowStack& stack, const oracle::Maps& maps) {
    std::size_t outside = 0;
    for (std::size_t k = 0; k < maps.size(); ++k) {
        for (int y = 0; y < maps[k].height; ++y) {
            for (int x = 0; x < maps[k].width; ++x) {
                outside +=
                    !contains(maps[k](x, y), stack_value(stack.code, static_cast<unsigned>(x),
                                                         static_cast<unsigned>(y), static_cast<unsigned>(k)));
            }
        }
    }
    return outside;
}

TEST(StackEncode, GivesTheOctreeBack) {
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
        const oracle::Maps maps =
            oracle::drawn_maps(seed, 1 << (seed % 6), 1 + static_cast<int>(seed * 7 % 20), 1, 90);
        for (const int a : {-2, 0, 1}) {
            const StackTree tree = stack_of(maps, a);
            for (const StackLayout layout : {StackLayout::narrow, StackLayout::wide}) {
                StackEncodeParams params;
                params.layout = layout;
                const ShadowStack stack = encoded(tree, params);
                EXPECT_EQ(stack.code.layout, layout);
                EXPECT_EQ(stack.code.shape, tree.shape);
                MultiresTree expected = tree.tree;
                expected.root_interval = {expected.root.value, expected.root.value};
                EXPECT_TRUE(oracle::same_octree(decode_stack(stack), expected));
                EXPECT_EQ(stack.counts, count_nodes(tree.tree));
                EXPECT_EQ(stack.bytes, 4 * node_units(layout, stack.counts) + stack.padding_bytes);
                EXPECT_EQ(texels_outside(stack, maps), 0u);
            }
        }
    }
}

/// Few bits for offsets: scales above one, or the wide layout.
TEST(StackEncode, OffsetsThatDoNotReach) {
    const oracle::Maps maps = oracle::drawn_maps(5, 32, 32, 1, 80);
    const StackTree tree = stack_of(maps, 0);
    bool scaled = false, widened = false;
    for (int bits = 5; bits <= 16; ++bits) {
        StackEncodeParams params;
        params.offset_bits = bits;
        const ShadowStack stack = encoded(tree, params);
        for (const std::uint32_t scale : stack.code.offset_scale)
            scaled = scaled || (scale > 1 && stack.code.layout == StackLayout::narrow);
        widened = widened || stack.code.layout == StackLayout::wide;
        EXPECT_EQ(texels_outside(stack, maps), 0u) << bits;
    }
    EXPECT_TRUE(scaled && widened);
    StackEncodeParams params;
    params.max_units = encoded(tree, {.layout = StackLayout::wide}).bytes / 4;
    EXPECT_NO_THROW(encoded(tree, params));
    params.max_units = encoded(tree).bytes / 4 - 1;
    EXPECT_THROW(encoded(tree, params), LimitError);
}

}  // namespace
}  // namespace obscura
