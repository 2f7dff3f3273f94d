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
inline constexpr CodeCase code_cases[] = {
    {"words24", ShadowCode::mh, TreeLayout::words24},
    {"words16", ShadowCode::mh, TreeLayout::words16},
    {"bytes16", ShadowCode::mh, TreeLayout::bytes16},
    {"fractions", ShadowCode::mmh, TreeLayout::fractions},
    {"float_bits", ShadowCode::mmh, TreeLayout::float_bits},
    {"dag", ShadowCode::dag, TreeLayout::fractions, {4, 5, false}},
    {"dag_bits", ShadowCode::dag, TreeLayout::float_bits, {4, 5, false}},
    {"dag_low", ShadowCode::dag, TreeLayout::fractions, {1, 4, false}},
    {"dag_two", ShadowCode::dag, TreeLayout::fractions, {2, 6, false}},
    {"dag_wide", ShadowCode::dag, TreeLayout::fractions, {3, 7, false, 0}},
    {"dag_tall", ShadowCode::dag, TreeLayout::float_bits, {5, 7, false}},
    {"packed", ShadowCode::dag, TreeLayout::fractions, {4, 6}},
    {"packed_bits", ShadowCode::dag, TreeLayout::float_bits, {3, 5}},
    {"packed_low", ShadowCode::dag, TreeLayout::fractions, {1, 4}},
    {"packed_tall", ShadowCode::dag, TreeLayout::fractions, {5, 7}},
    {"facet", ShadowCode::facet, TreeLayout::floats}};

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
        packed_ = (form >> 9 & 1u) != 0;
    }

    MultiresTree run() {
        MultiresTree tree;
        tree.levels = code_.levels;
        const float root = next();
        tree.root = node(20, tree);
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
        if (packed_)
            return depth(packed_number(4 * std::uint64_t{word(2)} + word(word(1) + index / chunk_), in));
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
        return depth(number);
    }
    float depth(std::uint32_t number) const {
        return code_.layout == TreeLayout::float_bits
                   ? std::bit_cast<float>(number)
                   : static_cast<float>(static_cast<double>(number) / 4294967296.0);
    }

    /// Bit by bit, from the chunk's first value on.
    std::uint32_t packed_number(std::uint64_t chunk, std::uint32_t in) const {
        const auto bit = [&](std::uint64_t from, std::uint64_t i) -> std::uint32_t {
            return units_[from + i / 8] >> (i % 8) & 1u;
        };
        const std::uint32_t head = at_byte(chunk), classes = head % 4 + 1;
        const std::uint64_t low = chunk + 4 + 5 * classes, high = low + (classes > 1 ? chunk_ / 8 : 0),
                            factors = high + (classes > 2 ? chunk_ / 8 : 0);
        std::uint64_t at = 0;
        for (std::uint32_t i = 0;; ++i) {
            const std::uint32_t c = (classes > 1 ? bit(low, i) : 0) + (classes > 2 ? 2 * bit(high, i) : 0);
            const std::uint32_t width = head >> (2 + 6 * c) & 63u;
            if (i < in) {
                at += width;
                continue;
            }
            std::uint32_t factor = 0;
            for (std::uint32_t b = 0; b < width; ++b)
                factor |= bit(factors, at + b) << b;
            return at_byte(chunk + 4 + 5 * c) + (factor << units_[chunk + 8 + 5 * c]);
        }
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

    /// At this byte.
    MultiresNode node(std::uint64_t first, MultiresTree& tree) {
        const std::uint32_t kinds = units_[first];
        std::uint64_t at = first + (wide_ ? 8 : 4);
        if (packed_) {
            // Behind the counts, which this walk has no use for.
            std::uint32_t children = 0;
            for (int i = 0; i < 4; ++i)
                children += (kinds >> (2 * i) & 3u) != 0;
            at = first + 2 + (children == 0 ? 0 : children - 1) * (units_[first + 1] / 4 % 4 + 1u);
        }
        MultiresNode group[4];
        std::uint32_t kind[4] = {};
        for (int i = 0; i < 4; ++i) {
            kind[i] = kinds >> (2 * i) & 3u;
            if (kind[i] == 0) continue;
            const std::uint64_t below = pointer(first, at, kind[i] == 1);
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

    /// The byte to which a node's pointer at byte `at` leads, which moves on.
    std::uint64_t pointer(std::uint64_t node, std::uint64_t& at, bool to_treelet) const {
        if (!packed_) {
            at += 4;
            return 4 * std::uint64_t{at_byte(at - 4)};
        }
        std::uint64_t place = 0;
        for (int i = 0; i <= units_[node + 1] % 4; ++i)
            place |= std::uint64_t{units_[at++]} << (8 * i);
        const std::uint64_t words = levels_ < 4 ? 1 : levels_ == 4 ? 3 : 11;
        return to_treelet ? 4 * (word(0) + words * place) : node + place;
    }

    /// The node at this place of a full tree of so many levels; returns its kind.
    std::uint32_t treelet(std::uint64_t at, std::uint32_t place, int levels, MultiresNode& out,
                          MultiresTree& tree) {
        const bool own = (units_[at + (9 + place) / 8] >> ((9 + place) % 8) & 1) != 0;
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
    bool wide_ = false, packed_ = false;
};

/// What lookups in `encoded`, made of `tree`, must find.
inline MultiresTree tree_behind(const ShadowTree& encoded, const MultiresTree& tree) {
    if (encoded.code.code == ShadowCode::mmh) return Unfolding(encoded).run();
    return encoded.code.code == ShadowCode::dag ? UnfoldingDag(encoded).run() : tree;
}

}  // namespace obscura
