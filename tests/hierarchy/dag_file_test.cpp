// Files of graphs: parts may be shared, and every way through them must be sound.
#include <gtest/gtest.h>

#include <algorithm>

#include "hierarchy/codes/decode.h"
#include "hierarchy/dag/dag.h"
#include "hierarchy/dag/dag_step.h"
#include "tests/hierarchy/crafted_tree_file.h"

namespace obscura {
namespace {

constexpr std::uint32_t root = dag_header_words;

TEST(DagFile, RefusesCraftedGraphs) {
    // Treelets of one level: everything else is inner nodes.
    const ShadowTree tree = small_tree(dag_low_case), bits = small_tree(dag_bits_case);
    const auto fault = [&](const ShadowTree& of, std::size_t at, const auto& change) {
        return crafted(of, [&](TreeRecord&, std::uint8_t* units) {
            set_word(units, at, static_cast<std::uint32_t>(change(word_at(units, at))));
        });
    };
    const auto same = [](std::uint32_t w) { return w; };
    EXPECT_EQ(fault(tree, 0, same), "accepted");
    EXPECT_EQ(fault(bits, 0, same), "accepted");
    const auto plus = [](std::uint32_t n) { return [n](std::uint32_t w) { return w + n; }; };
    const auto to = [](std::uint32_t n) { return [n](std::uint32_t) { return n; }; };

    // The header.
    for (const std::size_t part : {0u, 1u, 2u}) {
        for (const std::uint32_t n : {1u, ~0u, 1u << 31}) {
            EXPECT_NE(fault(tree, part, plus(n)), "accepted") << part << " " << n;
            EXPECT_NE(fault(bits, part, plus(n)), "accepted") << part << " " << n;
        }
        EXPECT_EQ(fault(tree, part, to(0)), "shadow tree 0: has parts that do not fit each other");
        EXPECT_EQ(fault(tree, part, to(~0u)), "shadow tree 0: has parts that do not fit each other");
    }
    EXPECT_EQ(fault(tree, 3, to(0)), "shadow tree 0: has no number of values that it can have");
    EXPECT_EQ(fault(tree, 3, to(~0u)), "shadow tree 0: has no number of values that it can have");
    EXPECT_EQ(fault(tree, 3, plus(1u << 20)), "shadow tree 0: has parts that do not fit each other");
    for (const std::uint32_t form : {0u, 0x50u, 0x56u, 0x34u, 0x84u, 0x354u, 0x454u, ~0u})
        EXPECT_EQ(fault(tree, 4, to(form)), "shadow tree 0: has an unknown form") << form;

    // Nodes.
    const auto first_child = [&](const auto& change) { return fault(tree, root + 1, change); };
    EXPECT_EQ(first_child(to(root)), "shadow tree 0: children do not follow their parent") << "a loop";
    EXPECT_EQ(first_child(to(0)), "shadow tree 0: children do not follow their parent");
    EXPECT_EQ(first_child(plus(1)), "shadow tree 0: a child is no inner node") << "between two";
    EXPECT_EQ(first_child(to(~0u)), "shadow tree 0: a child is no inner node");
    EXPECT_EQ(first_child(to(word_at(tree.code.units, 0))), "shadow tree 0: a child is no inner node")
        << "a treelet";
    EXPECT_EQ(fault(tree, root, plus(1u << 8)), "shadow tree 0: an inner node has other values than stated");
    EXPECT_EQ(fault(tree, root, plus(0xff000000u)),
              "shadow tree 0: an inner node has other values than stated");
    EXPECT_NE(fault(tree, root, to(0)), "accepted");
    const auto too_low = [](TreeRecord& record, std::uint8_t*) {
        record.levels = record.top_levels = 2;
        record.width = record.height = 4;
    };
    EXPECT_EQ(crafted(tree, too_low), "shadow tree 0: an inner node at the height of texels");

    // Treelets: of four levels in `bits`.
    const std::size_t treelet = word_at(bits.code.units, 0);
    EXPECT_EQ(fault(bits, treelet, plus(1)), "shadow tree 0: a treelet has other values than stated");
    EXPECT_EQ(fault(bits, treelet + 2, [](std::uint32_t w) { return w | 1u << 31; }),
              "shadow tree 0: a treelet has nodes of another");
    EXPECT_EQ(fault(tree, word_at(tree.code.units, 0), to(0)), "shadow tree 0: a treelet has no values");

    // Chunks.
    const std::size_t chunk = word_at(bits.code.units, 1);
    EXPECT_EQ(fault(bits, chunk + 3, plus(4)), "shadow tree 0: factors do not follow each other");
    EXPECT_EQ(fault(bits, chunk + 4, [](std::uint32_t w) { return w ^ 1u; }) == "accepted", false);
    EXPECT_EQ(fault(bits, chunk, to(0x7fc00000u)), "shadow tree 0: a value is not a depth in [0, 1]");
    EXPECT_EQ(fault(bits, chunk, to(0x3f800001u)), "shadow tree 0: a value is not a depth in [0, 1]");
    EXPECT_EQ(fault(small_tree(dag_case), word_at(small_tree(dag_case).code.units, 1), to(~0u)), "accepted")
        << "any fraction is a depth";
}

TEST(DagFile, RefusesCraftedPackedGraphs) {
    const ShadowTree tree = small_tree(packed_low_case), bits = small_tree(packed_bits_case);
    const auto fault = [&](const ShadowTree& of, std::size_t byte, int change) {
        return crafted(of, [&](TreeRecord&, std::uint8_t* units) {
            units[byte] = static_cast<std::uint8_t>(units[byte] + change);
        });
    };
    constexpr std::size_t first = 4 * root;
    EXPECT_EQ(fault(tree, first, 0), "accepted");
    EXPECT_EQ(fault(bits, first, 0), "accepted");
    EXPECT_EQ(fault(tree, 17, 1), "shadow tree 0: has an unknown form") << "wide and packed";
    EXPECT_NE(fault(tree, first + 1, 1), "accepted") << "pointers of more bytes";
    EXPECT_NE(fault(tree, first + 1, 4), "accepted") << "counts of more bytes";
    EXPECT_EQ(fault(tree, first + 1, 0x80), "shadow tree 0: an inner node has bits that mean nothing");
    const DagCode::PackedNode node = DagCode::packed_node_at(tree.code, first);
    ASSERT_EQ(node.children, 4u);
    ASSERT_EQ(node.kinds & 3u, 2u) << "to a node";
    EXPECT_EQ(fault(tree, node.counts, 1), "shadow tree 0: an inner node has other values than stated");
    // The root's first pointer, to the root and elsewhere.
    EXPECT_EQ(crafted(tree,
                      [&](TreeRecord&, std::uint8_t* units) {
                          std::memset(units + node.pointers, 0, node.pointer_bytes);
                      }),
              "shadow tree 0: children do not follow their parent");
    EXPECT_EQ(fault(tree, node.pointers, 1), "shadow tree 0: a child is no inner node");
    EXPECT_NE(fault(tree, node.pointers + node.pointer_bytes - 1, 1), "accepted");
    EXPECT_EQ(fault(bits, 4 * word_at(bits.code.units, 0) - 1, 1) == "accepted", false)
        << "what a word has left";

    const std::size_t record = 4 * word_at(bits.code.units, 1), chunk = 4 * word_at(bits.code.units, 2);
    EXPECT_EQ(fault(bits, record, 1), "shadow tree 0: factors do not follow each other");
    EXPECT_NE(fault(bits, chunk, 1), "accepted") << "another number of classes";
    EXPECT_EQ(fault(bits, chunk + 3, 0x80), "shadow tree 0: a chunk has a class that means nothing");
    EXPECT_EQ(fault(bits, chunk + 8, 32), "shadow tree 0: a chunk has a class that means nothing");
    EXPECT_EQ(fault(bits, chunk + 7, 0x80), "shadow tree 0: a value is not a depth in [0, 1]");
    EXPECT_EQ(fault(tree, 4 * word_at(tree.code.units, 2) + 7, 0x80), "accepted")
        << "any fraction is a depth";
    // The last byte of the factors is a bit too few.
    const auto shorter = [](TreeRecord& record_of, std::uint8_t*) { --record_of.bytes; };
    EXPECT_NE(crafted(bits, shorter), "accepted");
}

TEST(DagFile, RefusesAClassThatAChunkDoesNotHave) {
    // A root alone, whose value is of class `of` of three.
    const auto fault = [](std::uint32_t of) {
        std::vector<std::uint8_t> bytes(4 * 7 + 4 + 3 * 5 + 2 * 2 + tree_slack_bytes);
        const DagHeader header{6, 6, 7, 1, DagForm{4, 4, false, true}.bits()};
        std::memcpy(bytes.data(), &header, sizeof header);
        bytes[28] = 2;
        bytes[28 + 4 + 15] = static_cast<std::uint8_t>(of & 1u);
        bytes[28 + 4 + 15 + 2] = static_cast<std::uint8_t>(of >> 1);
        ShadowTree tree;
        tree.bytes = bytes.size() - tree_slack_bytes;
        tree.counts = {0, 0, 1};
        tree.code.units = bytes.data();
        tree.code.code = ShadowCode::dag;
        tree.code.layout = TreeLayout::fractions;
        const char* text = dag_fault_of(tree);
        return std::string(text == nullptr ? "sound" : text);
    };
    for (const std::uint32_t of : {0u, 1u, 2u})
        EXPECT_EQ(fault(of), "sound") << of;
    EXPECT_EQ(fault(3), "a chunk has a class that means nothing");
}

TEST(DagFile, RefusesRecordsOfOtherTrees) {
    const ShadowTree tree = small_tree(dag_case);
    const auto with = [&](const auto& change) {
        return crafted(tree, [&](TreeRecord& record, std::uint8_t*) { change(record); });
    };
    EXPECT_EQ(with([](TreeRecord& r) { r.layout = 0; }), "shadow tree 0: has an unknown layout");
    EXPECT_EQ(with([](TreeRecord& r) { ++r.leaf; }),
              "shadow tree 0: the number of nodes is not the one stated");
    EXPECT_EQ(with([](TreeRecord& r) { r.padding_bytes = 4; }),
              "shadow tree 0: has other padding than stated");
    EXPECT_NE(with([](TreeRecord& r) { r.code = 1; }), "accepted");
    EXPECT_NE(with([](TreeRecord& r) { r.code = 0; }), "accepted");
    EXPECT_NE(with([](TreeRecord& r) { r.bytes -= 1; }), "accepted");
    EXPECT_NE(with([](TreeRecord& r) { r.bytes = 3; }), "accepted");
}

/// A chain of nodes whose four children are the next one; treelets of one node below the last.
struct SharedGraph {
    std::vector<std::uint32_t> words;
    ShadowTree tree;

    SharedGraph(int nodes, DagKind kind, const std::vector<std::uint64_t>& counts) {
        const auto treelet =
            static_cast<std::uint32_t>(dag_header_words) + 6 * static_cast<std::uint32_t>(nodes);
        const std::uint32_t chunks = (static_cast<std::uint32_t>(counts[0]) + 1 + 127) / 128;
        words = {treelet, treelet + 1, treelet + 1 + 8 * chunks, static_cast<std::uint32_t>(counts[0]) + 1,
                 DagForm{1, 7, true}.bits()};
        for (int i = 0; i < nodes; ++i) {
            const bool last = i + 1 == nodes;
            const std::uint32_t next = dag_header_words + 6 * static_cast<std::uint32_t>(i + 1);
            words.push_back(0x55u * static_cast<std::uint32_t>(last ? DagKind::treelet : kind));
            words.push_back(static_cast<std::uint32_t>(counts[static_cast<std::size_t>(i)]));
            for (int c = 0; c < 4; ++c)
                words.push_back(last ? treelet : next);
        }
        words.push_back(1u | 1u << treelet_count_bits);
        if (chunks < 100'000) words.resize(words.size() + 8 * chunks);
        tree.view = any_view(nodes);
        tree.bytes = words.size() * 4;
        words.push_back(0);
        tree.code.units = reinterpret_cast<const std::uint8_t*>(words.data());
        tree.code.code = ShadowCode::dag;
        tree.code.layout = TreeLayout::fractions;
        tree.code.levels = nodes;
        std::uint64_t inner = 0;
        for (int i = 1; i < nodes; ++i)
            inner += std::uint64_t{1} << (2 * i);
        tree.counts = {1 + (kind == DagKind::full ? inner : 0), kind == DagKind::full ? 0 : inner,
                       std::uint64_t{1} << (2 * nodes)};
    }
    /// Values below each node of the chain when they are counted right.
    static std::vector<std::uint64_t> right(int nodes, DagKind kind) {
        std::vector<std::uint64_t> counts(static_cast<std::size_t>(nodes), 4);
        for (std::size_t i = counts.size() - 1; i-- > 0;)
            counts[i] = 4 * (counts[i + 1] + (kind == DagKind::full ? 1 : 0));
        return counts;
    }
};

TEST(DagFile, LooksAtSharedNodesOnce) {
    for (const DagKind kind : {DagKind::full, DagKind::empty}) {
        const SharedGraph shared(8, kind, SharedGraph::right(8, kind));
        EXPECT_EQ(dag_fault_of(shared.tree), nullptr);
        EXPECT_TRUE(try_trees(file_of({shared.tree}), false));
        EXPECT_EQ(tree_value(shared.tree.code, 255, 0), 0.0f);
    }
}

TEST(DagFile, RefusesCountsThatOverflow) {
    // Sixteen levels have 4^16 values, a zero in 32 bits; twenty have more bits still.
    for (const int nodes : {16, 17, 20}) {
        for (const DagKind kind : {DagKind::full, DagKind::empty}) {
            const SharedGraph shared(nodes, kind, SharedGraph::right(nodes, kind));
            EXPECT_NE(dag_fault_of(shared.tree), nullptr) << nodes;
        }
    }
    // As many values as the header says, whatever the nodes have.
    std::vector<std::uint64_t> small = SharedGraph::right(16, DagKind::empty);
    for (std::uint64_t& count : small)
        count &= 0xffffffffu;
    const SharedGraph wrapped(16, DagKind::empty, small);
    EXPECT_STREQ(dag_fault_of(wrapped.tree), "an inner node has other values than stated");
    std::vector<std::uint64_t> wrong = SharedGraph::right(5, DagKind::full);
    wrong[2] += 1;
    EXPECT_STREQ(dag_fault_of(SharedGraph(5, DagKind::full, wrong).tree),
                 "an inner node has other values than stated");
    // More levels than the map has.
    SharedGraph deep(6, DagKind::empty, SharedGraph::right(6, DagKind::empty));
    deep.tree.code.levels = 5;
    EXPECT_STREQ(dag_fault_of(deep.tree), "an inner node at the height of texels");
}

}  // namespace
}  // namespace obscura
