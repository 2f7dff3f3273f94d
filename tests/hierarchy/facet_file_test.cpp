// Files of trees with planes and edges: every altered byte and every length is refused, and what was written
// on purpose under right checksums leads no lookup outside.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "core/file_output.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/facet/facet.h"
#include "hierarchy/facet/facet_step.h"
#include "tests/hierarchy/crafted_tree_file.h"

namespace obscura {
namespace {

/// With planes, edges, ramps and inherited sides.
ShadowTree solid_tree(int side, std::uint32_t seed = 42, int count = 12) {
    const Mesh mesh = solids::random_solids(seed, count, false, false);
    const LightView view = orthographic_light_view(bounds_of(mesh), normalize(Vec3d{0.3, -1, 0.2}), side);
    BuildParams params;
    params.receivers = Receivers::static_only;
    ShadowTree tree = facet_from_mesh(mesh, view, params, {}, nullptr, nullptr);
    set_top_grid(tree, 1);
    return tree;
}

TEST(FacetFile, HoldsPlanesAndEdges) {
    const ShadowTree tree = solid_tree(64);
    EXPECT_GT(facet_stats(tree).planes, 3u);
    EXPECT_GT(facet_stats(tree).edges, 3u);
    const std::vector<std::uint8_t> bytes = file_of({tree});
    EXPECT_TRUE(try_trees(bytes, false));
}

TEST(FacetFile, RefusesEveryAlteredByteAndEveryLength) {
    const std::vector<std::uint8_t> good = file_of({solid_tree(16, 42, 4)});
    ASSERT_LT(good.size(), 6000u);
    EXPECT_TRUE(try_trees(good, false));
    std::vector<std::uint8_t> bytes = good;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        for (const int flip : {0x01, 0x80, 0xff}) {
            bytes[i] = static_cast<std::uint8_t>(good[i] ^ flip);
            EXPECT_FALSE(try_trees(bytes, false)) << "byte " << i << " ^ " << flip;
        }
        bytes[i] = good[i];
        EXPECT_FALSE(try_trees(std::span(good).first(i), false)) << "first " << i << " bytes";
    }
}

TEST(FacetFile, RefusesWhatWasWrittenOnPurpose) {
    const ShadowTree tree = solid_tree(32);
    FacetHeader header;
    std::memcpy(&header, tree.code.units, sizeof header);
    const auto fault = [&](std::size_t at, const auto& change) {
        return crafted(tree, [&](TreeRecord&, std::uint8_t* units) {
            set_word(units, at, static_cast<std::uint32_t>(change(word_at(units, at))));
        });
    };
    const auto plus = [](std::uint32_t n) { return [n](std::uint32_t w) { return w + n; }; };
    const auto to = [](std::uint32_t n) { return [n](std::uint32_t) { return n; }; };
    const std::string at_tree = "shadow tree 0: ";
    EXPECT_EQ(fault(0, plus(0)), "accepted");

    // The header.
    for (const std::size_t part : {0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u}) {
        for (const std::uint32_t n : {1u, 2u, ~0u, 1u << 31})
            EXPECT_EQ(fault(part, plus(n)), at_tree + "has a header that means nothing") << part << " " << n;
    }

    // Nodes: loops, places outside, other kinds than there is room for.
    constexpr std::size_t root_node = facet_header_words;
    const std::uint32_t head = word_at(tree.code.units, root_node), kinds = head & 0xfffu;
    ASSERT_NE(kinds, 0u);
    EXPECT_EQ(fault(root_node, to(kinds)), at_tree + "children do not follow their parent") << "a loop";
    EXPECT_EQ(fault(root_node, to(kinds | 0xfffffu << 12)), at_tree + "children lie outside the tree");
    EXPECT_EQ(fault(root_node, to(head & ~0xfffu)), at_tree + "the number of nodes is not the one stated");
    EXPECT_EQ(fault(root_node, to((head & ~7u) | 4u)), at_tree + "a line without values of its own");
    EXPECT_NE(fault(root_node, plus(1u << 12)), "accepted");
    EXPECT_EQ(fault(root_node + 1, to(0x7fc00000u)), at_tree + "a value is not a depth in [0, 1]");
    EXPECT_EQ(fault(root_node + 1, to(0x3f800001u)), at_tree + "a value is not a depth in [0, 1]");
    EXPECT_EQ(fault(root_node + 1, to(facet_plane_value(header.planes, 3, 63))),
              at_tree + "a value is not a depth in [0, 1]");
    EXPECT_EQ(fault(root_node + 1, to(facet_plane_value(header.planes - 1, 3, 63))), "accepted");
    const auto too_low = [](TreeRecord& record, std::uint8_t*) {
        record.levels = 1;
        record.top_levels = 0;
        record.width = record.height = 2;
    };
    EXPECT_NE(crafted(tree, too_low), "accepted");

    // Lines name edges.
    TreePlace line;
    for (int i = 0; i < 32 * 32 && line.count == 0; ++i) {
        line = FacetCode::root(tree.code);
        for (int h = 5; h > 0 && line.node != no_tree_node; --h)
            line = FacetCode::child(tree.code, line, h, i % 32, i / 32);
    }
    ASSERT_NE(line.count, 0u);
    EXPECT_EQ(fault(line.count, to(header.edges)), at_tree + "an edge is not in the table");
    EXPECT_EQ(fault(line.count, to(header.edges - 1)), "accepted");

    // Tables.
    const std::size_t edge = header.first_edge, plane = header.first_plane;
    EXPECT_EQ(fault(edge + 1, to(0x7ff80000u)), at_tree + "an edge means nothing") << "not a number";
    EXPECT_EQ(fault(edge + 1, to(0x43500000u)), at_tree + "an edge means nothing") << "beyond exact sums";
    EXPECT_EQ(fault(edge + 1, to(0x3fe00000u)), at_tree + "an edge means nothing") << "not whole";
    EXPECT_EQ(fault(edge + 2, to(1u << 31)), at_tree + "an edge means nothing");
    for (const std::size_t part : {1u, 3u, 5u}) {
        EXPECT_EQ(fault(plane + part, to(0x7ff00000u)), at_tree + "a plane means nothing");
        EXPECT_EQ(fault(plane + part, to(0x48000000u)), at_tree + "a plane means nothing");
    }
    for (const std::size_t part : {6u, 7u}) {
        for (const std::uint32_t z : {0x7fc00000u, 0x3f800001u, 0xbf000000u})
            EXPECT_EQ(fault(plane + part, to(z)), at_tree + "a plane means nothing");
    }
    EXPECT_EQ(fault(plane + 6, to(0x3f800000u)), at_tree + "a plane means nothing") << "least above most";
}

TEST(FacetFile, RefusesTreesThatShareChildren) {
    // Twenty levels in which all four children of a node are full and have the same children: walks would
    // meet 4^20 nodes in a file of 200 words.
    constexpr std::size_t first = facet_header_words, levels = 20, nodes = 2 + 8 * (levels - 1) + 4;
    constexpr std::uint32_t all_full = 03333, all_leaves = 01111;
    std::vector<std::uint32_t> words(first + nodes + nodes % 2, 0);
    words[first] = all_full | 2u << facet_kind_bits;
    for (std::size_t level = 1; level < levels; ++level) {
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t node = first + 2 + 8 * (level - 1) + 2 * i, below = first + 2 + 8 * level;
            words[node] = (level + 1 < levels ? all_full : all_leaves) |
                          static_cast<std::uint32_t>(below - node) << facet_kind_bits;
        }
    }
    FacetHeader header;
    header.nodes = static_cast<std::uint32_t>(nodes + nodes % 2);
    header.first_edge = header.first_plane = static_cast<std::uint32_t>(words.size());
    std::memcpy(words.data(), &header, sizeof header);
    ShadowTree bomb;
    bomb.view = any_view(20);
    bomb.bytes = 4 * words.size();
    bomb.counts = {1 + 4 * (levels - 1), 0, 4};
    bomb.code.units = reinterpret_cast<const std::uint8_t*>(words.data());
    bomb.code.code = ShadowCode::facet;
    bomb.code.layout = TreeLayout::floats;
    bomb.code.levels = static_cast<std::int32_t>(levels);
    std::fill(std::begin(bomb.code.offset_scale), std::end(bomb.code.offset_scale), 1u);
    EXPECT_STREQ(facet_fault_of(bomb), "the number of nodes is not the one stated");
    EXPECT_FALSE(try_trees(file_of({bomb}), false));
}

TEST(FacetFile, CraftedFilesLeadNoLookupOutside) {
    // Random damage under right checksums: refused, or harmless. Run under sanitizers to see it fail.
    std::mt19937 rng(12);
    int read = 0, refused = 0;
    const std::vector<std::uint8_t> good = file_of({solid_tree(32), solid_tree(16)});
    for (int round = 0; round < 6000; ++round) {
        std::vector<std::uint8_t> bytes = good;
        for (int change = 0; change <= round % 4; ++change) {
            const std::size_t at = sizeof(TreeFileHeader) + rng() % (bytes.size() - sizeof(TreeFileHeader));
            bytes[at] = static_cast<std::uint8_t>(round % 3 == 0 ? rng() : bytes[at] ^ 1u << rng() % 8);
        }
        ++(try_trees(bytes, true) ? read : refused);
    }
    EXPECT_GT(read, 100);
    EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace obscura
