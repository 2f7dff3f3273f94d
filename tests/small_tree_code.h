#pragma once
// A serialised tree the plain way: for tests of lookups that choose layout, scales and top grid themselves.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "hierarchy/multires.h"
#include "hierarchy/tree_code.h"

namespace obscura::small_tree {

/// Owns what `code` points to.
struct SmallTree {
    std::vector<std::uint8_t> bits;
    std::vector<TopNode> top;
    TreeCode code;
    bool bytes() const { return code.layout == TreeLayout::bytes16; }
};

class Writer {
  public:
    Writer(const MultiresTree& tree, SmallTree& out) : tree_(tree), out_(out) {}

    void run() {
        put_node(0, tree_.root, ChildKind::full, tree_.levels);
        out_.bits.resize(out_.bits.size() + 3);  // readable beyond the end
    }

  private:
    std::size_t unit() const { return out_.bytes() ? 1 : 4; }
    std::size_t header() const { return out_.bytes() ? 3 : 1; }
    std::size_t size_of(ChildKind kind) const {
        const std::size_t value = out_.bytes() ? 4 : 1;
        switch (kind) {
            case ChildKind::none:
                return 0;
            case ChildKind::leaf:
                return value;
            case ChildKind::empty:
                return header();
            case ChildKind::full:
                return header() + value;
        }
        return 0;
    }
    void put(std::size_t at, const void* from, std::size_t bytes) {
        out_.bits.resize(std::max(out_.bits.size(), at * unit() + bytes));
        std::memcpy(out_.bits.data() + at * unit(), from, bytes);
    }

    void put_node(std::size_t at, const MultiresNode& node, ChildKind kind, int height) {
        if (kind == ChildKind::leaf) {
            put(at, &node.value, 4);
            return;
        }
        // Children go to the end, at the next whole offset.
        const std::size_t used = (out_.bits.size() + unit() - 1) / unit();
        const std::size_t end = std::max(used, at + size_of(kind));
        const std::size_t scale = out_.code.offset_scale[height];
        const std::size_t offset = node.kinds == 0 ? 0 : (end - at + scale - 1) / scale;
        const std::size_t limit = out_.code.layout == TreeLayout::words24 ? 1u << 24 : 1u << 16;
        CHECK(offset < limit, "choose larger scales");
        const std::uint32_t word = static_cast<std::uint32_t>(offset << 8) | node.kinds;
        put(at, &word, out_.bytes() ? 3 : 4);
        if (kind == ChildKind::full) put(at + header(), &node.value, 4);
        if (node.kinds == 0) return;

        std::size_t place[4], next = at + offset * scale;
        for (int i = 0; i < 4; ++i) {
            place[i] = next;
            next += size_of(node.child(i));
        }
        out_.bits.resize(std::max(out_.bits.size(), next * unit()));
        std::uint64_t child = node.first_child;
        for (int i = 0; i < 4; ++i) {
            if (node.child(i) == ChildKind::none) continue;
            put_node(place[i], tree_.nodes[child++], node.child(i), height - 1);
        }
    }

    const MultiresTree& tree_;
    SmallTree& out_;
};

/// scale: of the offsets of every height; 0: as large as the height wants.
inline SmallTree encode(const MultiresTree& tree, TreeLayout layout, std::uint32_t scale = 1) {
    SmallTree out;
    out.code.layout = layout;
    out.code.levels = tree.levels;
    for (int h = 0; h <= tree.levels; ++h)
        out.code.offset_scale[h] = scale != 0 ? scale : std::max(1u, 1u << h >> 2);
    Writer(tree, out).run();
    out.code.units = out.bits.data();
    return out;
}

/// Value of the square of 2^level texels that holds (x, y): plain descent that stops there.
inline float value_at_level(const MultiresTree& tree, std::uint32_t x, std::uint32_t y, int level) {
    const MultiresNode* node = &tree.root;
    float value = node->value;
    for (int h = tree.levels - 1; h >= level; --h) {
        const int child = static_cast<int>((x >> h & 1u) + 2 * (y >> h & 1u));
        const ChildKind kind = node->child(child);
        if (kind == ChildKind::none) break;
        std::uint64_t place = node->first_child;
        for (int i = 0; i < child; ++i)
            place += node->child(i) != ChildKind::none;
        node = &tree.nodes[place];
        if (kind != ChildKind::empty) value = node->value;
    }
    return value;
}

}  // namespace obscura::small_tree
