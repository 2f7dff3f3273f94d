// The serialised tree: every texel decodes to the value of the tree it was made from, in every layout and
// with every width of offsets; sizes, padding and scales are what the format promises.
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <array>
#include <cstring>
#include <numeric>
#include <random>

#include "core/buffer.h"
#include "core/error.h"
#include "hierarchy/codes/codes.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/layout_plan.h"
#include "hierarchy/mh/mh.h"
#include "hierarchy/tree_units.h"
#include "tests/hierarchy/tree_samples.h"

namespace obscura {
namespace {

constexpr std::array<TreeLayout, tree_layout_count> layouts = [] {
    std::array<TreeLayout, tree_layout_count> all{};
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i] = tree_layouts[i].layout;
    return all;
}();

std::uint64_t node_bytes(const ShadowTree& tree) {
    const MultiresCounts& c = tree.counts;
    // A tree of one node is stored as a full one.
    if (c.full + c.empty == 0) return tree.code.layout == TreeLayout::bytes16 ? 7 : 8;
    return tree.code.layout == TreeLayout::bytes16 ? 7 * c.full + 3 * c.empty + 4 * c.leaf
                                                   : 8 * c.full + 4 * (c.empty + c.leaf);
}

void expect_same_values(const MultiresTree& tree, const ShadowTree& encoded) {
    const std::uint32_t side = 1u << tree.levels;
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const float expected = value_at(tree, x, y);
            ASSERT_EQ(tree_value(encoded.code, x, y), expected) << x << "," << y;
            if (encoded.code.top != nullptr) {
                ASSERT_EQ(tree_value_from_top(encoded.code, x, y), expected) << x << "," << y;
            }
        }
    }
}

bool same_nodes(const MultiresTree& a, const MultiresTree& b) {
    const auto same = [](const MultiresNode& p, const MultiresNode& q) {
        return p.value == q.value && p.kinds == q.kinds &&
               (p.kinds == 0 || p.first_child() == q.first_child());
    };
    return a.levels == b.levels && a.root.value == b.root.value && a.root.kinds == b.root.kinds &&
           std::equal(a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(), same);
}

TEST(TreeEncode, EveryTexelDecodesInEveryLayout) {
    for (const TreeSample& sample : tree_samples()) {
        for (const TreeLayout layout : layouts) {
            for (const int top : {0, 1, 3, sample.tree.levels}) {
                if (top > sample.tree.levels) continue;
                SCOPED_TRACE(sample.name + ", layout " + std::to_string(static_cast<int>(layout)) + ", top " +
                             std::to_string(top));
                const ShadowTree encoded = encode_tree(sample.tree, {}, {layout, top, 0, 0.125});
                EXPECT_EQ(encoded.counts, count_nodes(sample.tree));
                EXPECT_EQ(encoded.bytes, node_bytes(encoded) + encoded.padding_bytes);
                EXPECT_EQ(encoded.code.top_levels, top);
                expect_same_values(sample.tree, encoded);
            }
        }
    }
}

TEST(TreeEncode, ShortOffsetsGrowScalesAndLoseNothing) {
    int scaled[3] = {};
    for (const TreeSample& sample : tree_samples()) {
        for (const TreeLayout layout : layouts) {
            for (const int bits : {4, 5, 6, 8, 10}) {
                SCOPED_TRACE(sample.name + ", " + std::to_string(bits) + " bits");
                // Any padding is borne, so that the layout asked for is tested.
                const ShadowTree encoded = encode_tree(sample.tree, {}, {layout, 0, bits, 1e9});
                EXPECT_EQ(encoded.code.layout, layout);
                EXPECT_EQ(encoded.bytes, node_bytes(encoded) + encoded.padding_bytes);
                const auto& scale = encoded.code.offset_scale;
                scaled[static_cast<int>(layout)] += *std::max_element(scale, scale + 21) > 1;
                expect_same_values(sample.tree, encoded);
                EXPECT_TRUE(same_nodes(decode_mh(encoded), sample.tree));
            }
        }
    }
    for (const int count : scaled)
        EXPECT_GT(count, 10);
}

TEST(TreeEncode, DecodingGivesTheTreeBack) {
    for (const TreeSample& sample : tree_samples()) {
        for (const TreeLayout layout : layouts)
            EXPECT_TRUE(
                same_nodes(decode_mh(encode_tree(sample.tree, {}, {layout, 0, 0, 0.125})), sample.tree))
                << sample.name;
    }
}

TEST(TreeEncode, LevelsStopWhereAsked) {
    const MultiresTree tree = build_bottom_up(random_interval_map(3, 64).view());
    const ShadowTree encoded = encode_tree(tree, {});
    int changed = 0;
    for (int level = 0; level <= tree.levels; ++level) {
        for (std::uint32_t y = 0; y < 64; y += 3) {
            for (std::uint32_t x = 0; x < 64; ++x) {
                // The same descent over the tree under construction.
                const MultiresNode* node = &tree.root;
                float expected = node->value;
                for (int l = tree.levels - 1; l >= level; --l) {
                    const int child = static_cast<int>((x >> l & 1u) + 2 * (y >> l & 1u));
                    if (node->child(child) == ChildKind::none) break;
                    std::uint64_t place = node->first_child();
                    for (int i = 0; i < child; ++i)
                        place += node->child(i) != ChildKind::none;
                    const bool has_value = node->child(child) != ChildKind::empty;
                    node = &tree.nodes[place];
                    if (has_value) expected = node->value;
                }
                ASSERT_EQ(tree_value_at_level(encoded.code, x, y, level), expected);
                changed += expected != value_at(tree, x, y);
            }
        }
    }
    EXPECT_GT(changed, 100) << "stopping early must matter";
    EXPECT_EQ(tree_value_at_level(encoded.code, 5, 5, tree.levels), tree.root.value);
}

TEST(TreeEncode, ASingleNodeIsAFullOne) {
    const Image<DepthInterval> background(64, 64);
    const ShadowTree words = encode_tree(build_bottom_up(background.view()), {});
    ASSERT_EQ(words.bytes, 8u);
    std::uint32_t header;
    float value;
    std::memcpy(&header, words.code.units, 4);
    std::memcpy(&value, words.code.units + 4, 4);
    EXPECT_EQ(header, 0u);
    EXPECT_EQ(value, 1.0f);
    EXPECT_EQ(encode_tree(build_bottom_up(background.view()), {}, {TreeLayout::bytes16, 0, 0, 0}).bytes, 7u);
}

TEST(TreeEncode, ChildKindsCountUnits) {
    // The root of a two by two map with four depths: one covered child, three leaves behind the root.
    Image<DepthInterval> map(2, 2);
    for (int i = 0; i < 4; ++i)
        map.pixels[static_cast<std::size_t>(i)] = {0.25f * static_cast<float>(i),
                                                   0.25f * static_cast<float>(i)};
    const ShadowTree tree = encode_tree(build_bottom_up(map.view()), {});
    const std::uint32_t expected[] = {0b01'01'01'00u | 2u << 8, 0u, 0x3e800000u, 0x3f000000u, 0x3f400000u};
    ASSERT_EQ(tree.bytes, sizeof expected);
    EXPECT_EQ(std::memcmp(tree.code.units, expected, sizeof expected), 0);
}

TEST(TreeEncode, WidensWhatShortOffsetsCannotCarry) {
    const MultiresTree tree = build_bottom_up(distinct_interval_map(256).view());
    const ShadowTree bytes = encode_tree(tree, {}, {TreeLayout::bytes16, 0, 5, 0.125});
    const ShadowTree words = encode_tree(tree, {}, {TreeLayout::words16, 0, 5, 0.125});
    EXPECT_EQ(bytes.code.layout, TreeLayout::words24);
    EXPECT_EQ(words.code.layout, TreeLayout::words24);
    expect_same_values(tree, bytes);
    // Offsets of 16 bits carry it in bytes, with scales and a little padding.
    const ShadowTree enough = encode_tree(tree, {}, {TreeLayout::bytes16, 0, 0, 0.125});
    EXPECT_EQ(enough.code.layout, TreeLayout::bytes16);
    EXPECT_GT(enough.code.offset_scale[tree.levels - 1], 1u);
    EXPECT_LT(enough.padding_bytes * 100, enough.bytes);
}

TEST(TreeEncode, EqualTreesGiveEqualBytes) {
    const MultiresTree tree = build_bottom_up(solid_interval_map(2, 256, true).view());
    for (const TreeLayout layout : layouts) {
        const ShadowTree a = encode_tree(tree, {}, {layout, 0, 6, 1e9});
        EXPECT_GT(a.padding_bytes, 0u);
        // Leave dirty memory of about that size around: padding must not show it.
        for (std::size_t size = a.bytes - 64; size < a.bytes + 65; size += 16) {
            Buffer<std::uint8_t> dirty(size);
            std::fill(dirty.begin(), dirty.end(), std::uint8_t{0xee});
        }
        const ShadowTree b = encode_tree(tree, {}, {layout, 0, 6, 1e9});
        ASSERT_EQ(a.bytes, b.bytes);
        EXPECT_EQ(std::memcmp(a.code.units, b.code.units, a.bytes), 0);
    }
}

// --- the plan alone -------------------------------------------------------------------------------------

std::uint64_t padding_with(TreeLayout layout, const std::vector<std::uint8_t>& parents,
                           const std::vector<std::uint32_t>& blocks, std::uint32_t scale,
                           std::uint32_t max_offset) {
    std::uint64_t padding = 0;
    const std::uint32_t* next = blocks.data();
    for (const std::uint8_t kinds : parents) {
        const Family family = family_of<4>(units_of_kinds(layout), kinds, next);
        const Placement placed = place(family, scale);
        std::uint64_t used = family.group_units;
        for (int i = 0; i < family.inner; ++i)
            used += *next++;
        if (placed.reach > std::uint64_t{max_offset} * scale) return ~std::uint64_t{0};
        padding += placed.end - used;
    }
    return padding;
}

TEST(LayoutPlan, TheScaleIsTheBestOfAll) {
    std::mt19937 engine(7);
    const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(engine() % n); };
    for (int round = 0; round < 200; ++round) {
        const TreeLayout layout = layouts[static_cast<std::size_t>(round) % layouts.size()];
        std::vector<std::uint8_t> parents(1 + below(6));
        std::vector<std::uint32_t> blocks;
        for (std::uint8_t& kinds : parents) {
            kinds = static_cast<std::uint8_t>(below(256));
            for (int i = 0; i < 4; ++i) {
                if (kind_of(kinds, i) >= 2) blocks.push_back(1 + below(round % 2 != 0 ? 2000 : 90));
            }
        }
        const std::uint32_t max_offset = 15 + below(17);
        const ScaleChoice choice = best_scale<4>(units_of_kinds(layout), parents, blocks, max_offset);
        std::uint64_t best = ~std::uint64_t{0};
        std::uint32_t best_scale_by_hand = 0;
        // Beyond the longest distance every further step only adds padding.
        for (std::uint32_t scale = 1; scale < 9000; ++scale) {
            const std::uint64_t padding = padding_with(layout, parents, blocks, scale, max_offset);
            if (padding < best) {
                best = padding;
                best_scale_by_hand = scale;
            }
        }
        ASSERT_EQ(choice.padding, best) << round;
        ASSERT_EQ(choice.scale, best_scale_by_hand) << round;
    }
}

TEST(LayoutPlan, SmallBlocksComeFirst) {
    // Distances are then at most the three lesser blocks, not the three first.
    const std::uint32_t blocks[] = {5000, 7, 100, 7};
    const Family family = family_of<4>(units_of_kinds(TreeLayout::words24), 0b11'10'11'10, blocks);
    EXPECT_EQ(family.group_units, 6u);
    EXPECT_EQ(family.inner, 4);
    const Placement placed = place(family, 1);
    EXPECT_EQ(placed.start[0], 6u);
    EXPECT_EQ(family.member[0].child, 1);
    EXPECT_EQ(family.member[3].child, 0);
    EXPECT_EQ(placed.end, 6u + 5114);
    EXPECT_EQ(placed.reach, 6u + 114) << "from the first child, whose block is the last";
}

TEST(LayoutPlan, ReachesBeyondFourGibibytes) {
    // Four blocks of 2 GB of words each: the tree ends where lookups end.
    const std::vector<std::uint8_t> parents{0xff};
    const std::vector<std::uint32_t> blocks(4, 500'000'000);
    const ScaleChoice choice = best_scale<4>(units_of_kinds(TreeLayout::words16), parents, blocks, 0xffff);
    EXPECT_GE(choice.scale, 1'500'000'000u / 0xffff);
    EXPECT_LT(choice.padding, 4u * choice.scale);
    const Placement placed =
        place(family_of<4>(units_of_kinds(TreeLayout::words16), 0xff, blocks.data()), choice.scale);
    EXPECT_GT(byte_of_unit(TreeLayout::words16, placed.start[3]), std::size_t{5'999'999'999u});
    EXPECT_LE(placed.end, max_tree_units);
}

/// Every node that a tree of these levels can have, without values.
TreeShape full_shape(int levels) {
    TreeShape shape;
    shape.levels = levels;
    shape.kinds[levels + 1] = {3};
    for (int height = levels; height > 0; --height) {
        const std::size_t nodes = std::size_t{1} << (2 * (levels - height));
        shape.kinds[height].assign(nodes, height == 1 ? 0x55 : 0xff);
    }
    return shape;
}

TEST(LayoutPlan, CountsUnitsOfAFullTree) {
    const TreeShape shape = full_shape(11);
    // 4^11 leaves and as many half as many units above them.
    const LayoutPlan words = plan_layout<4>(shape, units_of_kinds(TreeLayout::words24), 0xffffff);
    EXPECT_TRUE(words.fits);
    EXPECT_EQ(words.padding, 0u);
    EXPECT_EQ(words.units, (1u << 22) + 2 * ((1u << 22) - 1) / 3);
    EXPECT_TRUE(plan_layout<4>(shape, units_of_kinds(TreeLayout::words24), 0xffffff, words.units).fits);
    EXPECT_FALSE(plan_layout<4>(shape, units_of_kinds(TreeLayout::words24), 0xffffff, words.units - 1).fits);
}

TEST(TreeEncode, RefusesWhatNoLayoutCanName) {
    const MultiresTree tree = build_bottom_up(distinct_interval_map(32).view());
    EncodeParams params{TreeLayout::bytes16, 0, 0, 0.125};
    const std::uint64_t bytes = encode_tree(tree, {}, params).bytes;
    // Too many bytes to name are fewer words.
    params.max_units = bytes - 1;
    const ShadowTree words = encode_tree(tree, {}, params);
    EXPECT_EQ(words.code.layout, TreeLayout::words16);
    params.max_units = words.bytes / 4 - 1;
    EXPECT_THROW(encode_tree(tree, {}, params), LimitError);
}

/// Memory that is promised, not used: only pages written to exist.
struct Reservation {
    explicit Reservation(std::size_t bytes_) : bytes(bytes_) {
        p = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1,
                   0);
    }
    ~Reservation() {
        if (p != MAP_FAILED) ::munmap(p, bytes);
    }
    Reservation(const Reservation&) = delete;
    Reservation& operator=(const Reservation&) = delete;
    void* p;
    std::size_t bytes;
};

TEST(TreeDecode, ReadsNodesBeyondFourGibibytes) {
    const Reservation memory(std::size_t{1} << 33);
    if (memory.p == MAP_FAILED) GTEST_SKIP() << "8 GiB of address space cannot be had";
    // A root whose four leaves are the last words that can be named.
    const std::uint32_t scale = 130, offset = static_cast<std::uint32_t>((max_tree_units - 4) / scale);
    const std::uint64_t group = std::uint64_t{scale} * offset;
    TreeCode code;
    code.units = static_cast<const std::uint8_t*>(memory.p);
    code.levels = 1;
    code.offset_scale[1] = scale;
    auto* words = static_cast<std::uint32_t*>(memory.p);
    words[0] = 0b01'01'01'01u | offset << 8;
    const float depths[] = {0.25f, 0.5f, 0.75f, 1.0f};
    std::memcpy(words + group, depths, sizeof depths);
    EXPECT_GT(byte_of_unit(code.layout, group), std::size_t{1} << 32);
    for (std::uint32_t i = 0; i < 4; ++i)
        EXPECT_EQ(tree_value(code, i % 2, i / 2), depths[i]);
}

}  // namespace
}  // namespace obscura
