#pragma once
// Every way to write a tree, and what each must be read as: the table that tests of lookups, filters and
// files run over. A new code has a row here.

#include <bit>
#include <cstring>
#include <string>

#include "hierarchy/codes/codes.h"
#include "hierarchy/multires.h"
#include "hierarchy/tree_units.h"

namespace obscura {

struct CodeCase {
    const char* name;
    ShadowCode code;
    TreeLayout layout;
    DagParams dag = {};
};
inline constexpr CodeCase code_cases[] = {{"words24", ShadowCode::mh, TreeLayout::words24},
                                          {"words16", ShadowCode::mh, TreeLayout::words16},
                                          {"bytes16", ShadowCode::mh, TreeLayout::bytes16},
                                          {"fractions", ShadowCode::mmh, TreeLayout::fractions},
                                          {"float_bits", ShadowCode::mmh, TreeLayout::float_bits},
                                          {"dag", ShadowCode::dag, TreeLayout::fractions},
                                          {"dag_bits", ShadowCode::dag, TreeLayout::float_bits},
                                          {"dag_low", ShadowCode::dag, TreeLayout::fractions, {1, 4}},
                                          {"dag_two", ShadowCode::dag, TreeLayout::fractions, {2, 6}},
                                          {"dag_wide", ShadowCode::dag, TreeLayout::fractions, {3, 7, 0}},
                                          {"dag_tall", ShadowCode::dag, TreeLayout::float_bits, {5, 7}}};

inline EncodeParams params_of(const CodeCase& c, int top_levels = 0, int offset_bits = 0,
                              double bearable_padding = 1e9) {
    EncodeParams params{c.layout, top_levels, offset_bits, bearable_padding};
    params.code = c.code;
    params.dag = c.dag;
    return params;
}

/// The tree that a merged tree's bytes stand for, read word by word: nothing of the lookups is used.
class Unfolding {
  public:
    explicit Unfolding(const ShadowTree& merged) : code_(merged.code) {}

    MultiresTree run() {
        MultiresTree tree;
        tree.levels = code_.levels;
        tree.root = below(0, code_.levels, word(1), tree);
        tree.root.value = depth(word(1));
        tree.root_interval = {tree.root.value, tree.root.value};
        return tree;
    }

  private:
    std::uint32_t word(std::uint64_t unit) const {
        std::uint32_t word;
        std::memcpy(&word, code_.units + 4 * unit, sizeof word);
        return word;
    }
    float depth(std::uint32_t number) const {
        return code_.layout == TreeLayout::float_bits
                   ? std::bit_cast<float>(number)
                   : static_cast<float>(static_cast<double>(number) / 4294967296.0);
    }
    MultiresNode below(std::uint64_t node, int height, std::uint32_t inherited, MultiresTree& tree) const {
        const std::uint32_t header = word(node);
        std::uint64_t unit = node + std::uint64_t{header >> 8} * code_.offset_scale[height];
        MultiresNode group[4];
        int count = 0;
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t kind = header >> (2 * i) & 3u;
            if (kind == 0) continue;
            const bool inner = (kind & 2u) != 0, own = (kind & 1u) != 0;
            const std::uint32_t number = inherited + (own ? word(unit + (inner ? 1 : 0)) : 0);
            MultiresNode& child = group[count++];
            if (inner) child = below(unit, height - 1, number, tree);
            child.value = own ? depth(number) : 0;
            unit += inner && own ? 2 : 1;
        }
        const MultiresNode result(0, header & 0xffu, tree.nodes.size());
        tree.nodes.insert(tree.nodes.end(), group, group + count);
        return result;
    }

    const TreeCode& code_;
};

/// The tree that a graph's bytes stand for, read as its format says: nothing of the lookups is used.
class UnfoldingDag {
  public:
    explicit UnfoldingDag(const ShadowTree& encoded) : code_(encoded.code), units_(encoded.code.units) {
        const std::uint32_t form = word(4);
        levels_ = static_cast<int>(form & 15u);
        chunk_ = 1u << (form >> 4 & 15u);
        wide_ = (form >> 8 & 1u) != 0;
    }

    MultiresTree run() {
        MultiresTree tree;
        tree.levels = code_.levels;
        const float root = next();
        tree.root = node(5, tree);
        tree.root.value = root;
        tree.root_interval = {root, root};
        return tree;
    }

  private:
    std::uint32_t at_byte(std::uint64_t byte) const {
        std::uint32_t bits;
        std::memcpy(&bits, units_ + byte, sizeof bits);
        return bits;
    }
    std::uint32_t word(std::uint64_t at) const { return at_byte(4 * at); }

    /// The value whose turn it is: they are stored in the order of this walk.
    float next() {
        const std::uint32_t index = next_++, in = index % chunk_;
        const std::uint64_t record = 4 * std::uint64_t{word(1)} + index / chunk_ * (16 + chunk_ / 8);
        const auto has_factor = [&](std::uint32_t i) {
            return (units_[record + 16 + i / 8] >> (i % 8) & 1) != 0;
        };
        std::uint32_t number = at_byte(record);
        if (has_factor(in)) {
            const std::uint32_t head = at_byte(record + 12), bytes = head % 4 + 1;
            std::uint64_t at = 4 * std::uint64_t{word(2)} + head / 4;
            for (std::uint32_t i = 0; i < in; ++i)
                at += has_factor(i) ? bytes : 0;
            std::uint32_t factor = 0;
            for (std::uint32_t i = 0; i < bytes; ++i)
                factor |= std::uint32_t{units_[at + i]} << (8 * i);
            number = at_byte(record + 4) + at_byte(record + 8) * factor;
        }
        return code_.layout == TreeLayout::float_bits
                   ? std::bit_cast<float>(number)
                   : static_cast<float>(static_cast<double>(number) / 4294967296.0);
    }

    static MultiresNode group_of(const MultiresNode (&group)[4], const std::uint32_t (&kind)[4],
                                 MultiresTree& tree) {
        std::uint32_t kinds = 0;
        const std::uint64_t first = tree.nodes.size();
        for (std::uint32_t i = 0; i < 4; ++i) {
            kinds |= kind[i] << (2 * i);
            if (kind[i] != 0) tree.nodes.push_back(group[i]);
        }
        return {0, kinds, kinds == 0 ? 0 : first};
    }

    MultiresNode node(std::uint64_t at, MultiresTree& tree) {
        const std::uint32_t kinds = word(at) & 0xffu;
        at += wide_ ? 2 : 1;
        MultiresNode group[4];
        std::uint32_t kind[4] = {};
        for (int i = 0; i < 4; ++i) {
            kind[i] = kinds >> (2 * i) & 3u;
            if (kind[i] == 0) continue;
            const std::uint64_t below = word(at++);
            if (kind[i] == 1) {
                kind[i] = treelet(below, 0, levels_, group[i], tree);
            } else {
                const float own = kind[i] == 3 ? next() : 0;
                group[i] = node(below, tree);
                group[i].value = own;
            }
        }
        return group_of(group, kind, tree);
    }

    /// The node at this place of a full tree of so many levels; returns its kind.
    std::uint32_t treelet(std::uint64_t at, std::uint32_t place, int levels, MultiresNode& out,
                          MultiresTree& tree) {
        const bool own = (units_[4 * at + (9 + place) / 8] >> ((9 + place) % 8) & 1) != 0;
        const float value = own ? next() : 0;
        MultiresNode group[4];
        std::uint32_t kind[4] = {};
        if (levels > 1) {
            const std::uint32_t nodes = ((1u << (2 * levels - 2)) - 1) / 3;
            for (std::uint32_t i = 0; i < 4; ++i)
                kind[i] = treelet(at, place + 1 + i * nodes, levels - 1, group[i], tree);
        }
        out = group_of(group, kind, tree);
        out.value = value;
        return (own ? 1u : 0u) + (out.kinds != 0 ? 2u : 0u);
    }

    const TreeCode& code_;
    const std::uint8_t* units_;
    int levels_ = 0;
    std::uint32_t chunk_ = 0, next_ = 0;
    bool wide_ = false;
};

/// What lookups in `encoded`, made of `tree`, must find.
inline MultiresTree tree_behind(const ShadowTree& encoded, const MultiresTree& tree) {
    if (encoded.code.code == ShadowCode::mmh) return Unfolding(encoded).run();
    return encoded.code.code == ShadowCode::dag ? UnfoldingDag(encoded).run() : tree;
}

}  // namespace obscura
