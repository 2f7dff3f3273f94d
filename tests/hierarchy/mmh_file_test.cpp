// Files of merged trees: children may be shared, and every way through them must be sound.
#include <gtest/gtest.h>

#include <algorithm>

#include "hierarchy/codes/decode.h"
#include "tests/hierarchy/crafted_tree_file.h"

namespace obscura {
namespace {

TEST(MergedTreeFile, RefusesCraftedMergedTrees) {
    const ShadowTree tree = small_tree(merged_case), bits = small_tree(merged_bits_case);
    const auto unchanged = [](TreeRecord&, std::uint8_t*) {};
    EXPECT_EQ(crafted(tree, unchanged), "accepted");
    EXPECT_EQ(crafted(bits, unchanged), "accepted");

    const auto other_code = [](TreeRecord& record, std::uint8_t*) { record.code = 0; };
    EXPECT_EQ(crafted(tree, other_code), "shadow tree 0: has an unknown layout");
    const auto no_code = [](TreeRecord& record, std::uint8_t*) { record.code = 77; };
    EXPECT_EQ(crafted(tree, no_code), "shadow tree 0: has an unknown code");
    const auto mh_layout = [](TreeRecord& record, std::uint8_t*) { record.layout = 1; };
    EXPECT_EQ(crafted(tree, mh_layout), "shadow tree 0: has an unknown layout");
    const auto far_away = [](TreeRecord&, std::uint8_t* units) {
        set_word(units, 0, word_at(units, 0) | 0xffffff00u);
    };
    EXPECT_EQ(crafted(tree, far_away), "shadow tree 0: children lie outside the tree");
    // A loop needs an offset of nothing: they are never negative.
    const auto own_child = [](TreeRecord& record, std::uint8_t*) { record.offset_scale[4] = 0; };
    EXPECT_EQ(crafted(tree, own_child), "shadow tree 0: children do not follow their parent");
    const auto loop = [](TreeRecord&, std::uint8_t* units) { set_word(units, 0, word_at(units, 0) & 0xffu); };
    EXPECT_EQ(crafted(tree, loop), "shadow tree 0: children do not follow their parent");
    const auto too_low = [](TreeRecord& record, std::uint8_t*) {
        record.levels = record.top_levels = 2;
        record.width = record.height = 4;
    };
    EXPECT_EQ(crafted(tree, too_low), "shadow tree 0: an inner node at the height of texels");
    const auto miscounted = [](TreeRecord& record, std::uint8_t*) { ++record.leaf; };
    EXPECT_EQ(crafted(tree, miscounted), "shadow tree 0: the number of nodes is not the one stated");
    const auto padded = [](TreeRecord& record, std::uint8_t*) { record.padding_bytes += 4; };
    EXPECT_EQ(crafted(tree, padded), "shadow tree 0: has other padding than stated");
    const auto half_word = [](TreeRecord& record, std::uint8_t*) { record.bytes -= 2; };
    EXPECT_NE(crafted(tree, half_word), "accepted");

    // Any fraction is a depth; not every word is the bits of one, nor every sum of differences.
    const auto set_root = [](std::uint32_t value) {
        return [=](TreeRecord&, std::uint8_t* units) { set_word(units, 1, value); };
    };
    EXPECT_EQ(crafted(tree, set_root(0xffffffffu)), "accepted");
    for (const std::uint32_t value : {0x7fc00000u, 0x3f800001u, 0xffffffffu, 0x80000000u})
        EXPECT_EQ(crafted(bits, set_root(value)), "shadow tree 0: a value is not a depth in [0, 1]") << value;
}

/// Twenty levels in which all four children of a node are full and share their children: 4^20 nodes in 200
/// words.
struct SharedTree {
    std::vector<std::uint32_t> words = std::vector<std::uint32_t>(2 + 8 * 19 + 4);
    ShadowTree tree;

    SharedTree() {
        words[0] = 0xffu | 2u << 8;
        for (std::size_t level = 1; level < 20; ++level) {
            for (std::size_t i = 0; i < 4; ++i) {
                const std::size_t node = 2 + 8 * (level - 1) + 2 * i;
                words[node] = (level < 19 ? 0xffu : 0x55u) | static_cast<std::uint32_t>(8 - 2 * i) << 8;
                words[node + 1] = static_cast<std::uint32_t>(i) << 20;
            }
        }
        tree.view = any_view(20);
        tree.bytes = words.size() * 4;
        tree.counts = {1 + 4 * 19, 0, 4};
        tree.code.units = reinterpret_cast<const std::uint8_t*>(words.data());
        tree.code.code = ShadowCode::mmh;
        tree.code.layout = TreeLayout::fractions;
        tree.code.levels = 20;
        std::fill(std::begin(tree.code.offset_scale), std::end(tree.code.offset_scale), 1u);
    }
};

TEST(MergedTreeFile, LooksAtSharedChildrenOnce) {
    const SharedTree shared;
    EXPECT_TRUE(try_trees(file_of({shared.tree}), false));
    EXPECT_EQ(tree_value(shared.tree.code, 0, 0), 0.0f);
    // Child 3 at every level but the last, whose leaves are zero.
    EXPECT_EQ(tree_value(shared.tree.code, 0xfffff, 0xfffff), 19 * 3 * 0x1p-12f);
}

TEST(MergedTreeFile, RefusesSharedChildrenThatMeanDifferentThings) {
    const auto fault = [](const auto& change) {
        SharedTree shared;
        change(shared);
        const char* text = row_of(ShadowCode::mmh).fault_of(shared.tree);
        return std::string(text == nullptr ? "sound" : text);
    };
    EXPECT_EQ(fault([](SharedTree&) {}), "sound");
    const auto other_kinds = [](SharedTree& s) { s.words[4] = 0x7fu | 6u << 8; };
    EXPECT_EQ(fault(other_kinds), "shared children are of different kinds");
    // Overlapping: the second node's children begin one word further on.
    const auto overlapping = [](SharedTree& s) { s.words[4] += 1u << 8; };
    EXPECT_NE(fault(overlapping), "sound");
    const auto leaves_below_texels = [](SharedTree& s) { s.words[2 + 8 * 18] = 0xffu | 8u << 8; };
    EXPECT_NE(fault(leaves_below_texels), "sound");
    // The last node of the root's group points past one level, so that what is below stands higher on that
    // way: where scales differ, its offsets would mean something else there.
    const auto skipped = [](SharedTree& s) { s.words[2 + 6] = 0xffu | 10u << 8; };
    EXPECT_EQ(fault(skipped), "sound") << "sharing between levels is what offsets of words are for";
    const auto scaled = [&](SharedTree& s) {
        s.tree.code.offset_scale[2] = 2;
        for (std::size_t i = 0; i < 4; ++i)
            s.words[2 + 8 * 17 + 2 * i] = 0xffu | static_cast<std::uint32_t>(4 - i) << 8;
    };
    EXPECT_EQ(fault(scaled), "sound");
    const auto both = [&](SharedTree& s) {
        skipped(s);
        scaled(s);
    };
    EXPECT_EQ(fault(both), "shared children have different scales");
    const auto beyond_one = [](SharedTree& s) {
        s.tree.code.layout = TreeLayout::float_bits;
        s.words[1] = 0x3f000000u;
    };
    // .5 and 19 times three steps of 2^20 in the bits are beyond one.
    EXPECT_EQ(fault(beyond_one), "a value is not a depth in [0, 1]");
}

/// What is wrong with a tree of these words and nodes.
std::string fault_of_words(const std::vector<std::uint32_t>& words, int levels, const MultiresCounts& counts,
                           std::uint64_t padding_bytes = 0) {
    ShadowTree tree;
    tree.view = any_view(levels);
    tree.bytes = words.size() * 4;
    tree.padding_bytes = padding_bytes;
    tree.counts = counts;
    tree.code.units = reinterpret_cast<const std::uint8_t*>(words.data());
    tree.code.code = ShadowCode::mmh;
    tree.code.layout = TreeLayout::fractions;
    tree.code.levels = levels;
    std::fill(std::begin(tree.code.offset_scale), std::end(tree.code.offset_scale), 1u);
    const char* fault = row_of(ShadowCode::mmh).fault_of(tree);
    return fault == nullptr ? "sound" : fault;
}
constexpr std::uint32_t node_word(std::uint32_t kinds, std::uint32_t offset) {
    return kinds | offset << 8;
}

TEST(MergedTreeFile, RefusesSharedChildrenTooLowForTheirHeight) {
    // Root, two nodes a, b; c below b; d below a, and below c, if that may be; a leaf below d.
    const std::vector<std::uint32_t> words{node_word(0x0f, 2),
                                           0,
                                           node_word(0x03, 6),
                                           0,
                                           node_word(0x03, 2),
                                           0,
                                           node_word(0x03, 2),
                                           0,
                                           node_word(0x01, 2),
                                           0,
                                           0};
    EXPECT_EQ(fault_of_words(words, 4, {5, 0, 1}), "sound");
    EXPECT_EQ(fault_of_words(words, 3, {5, 0, 1}), "an inner node at the height of texels");
}

TEST(MergedTreeFile, RefusesGroupsThatOverlap) {
    // Four leaves each, the second's one word behind the first's.
    std::vector<std::uint32_t> words{
        node_word(0x0f, 2), 0, node_word(0x55, 4), 0, node_word(0x55, 3), 0, 0, 0, 0, 0, 0};
    const MultiresCounts counts{3, 0, 8};
    const std::uint64_t missing = 0 - std::uint64_t{3 * 4};
    for (const std::uint64_t padding : {std::uint64_t{0}, missing})
        EXPECT_EQ(fault_of_words(words, 2, counts, padding), "has other padding than stated");
    words[4] = node_word(0x55, 2);
    words.pop_back();
    EXPECT_EQ(fault_of_words(words, 2, {3, 0, 4}), "sound") << "shared whole";
}

}  // namespace
}  // namespace obscura
