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
};
inline constexpr CodeCase code_cases[] = {{"words24", ShadowCode::mh, TreeLayout::words24},
                                          {"words16", ShadowCode::mh, TreeLayout::words16},
                                          {"bytes16", ShadowCode::mh, TreeLayout::bytes16},
                                          {"fractions", ShadowCode::mmh, TreeLayout::fractions},
                                          {"float_bits", ShadowCode::mmh, TreeLayout::float_bits}};

inline EncodeParams params_of(const CodeCase& c, int top_levels = 0, int offset_bits = 0,
                              double bearable_padding = 1e9) {
    EncodeParams params{c.layout, top_levels, offset_bits, bearable_padding};
    params.code = c.code;
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

/// What lookups in `encoded`, made of `tree`, must find.
inline MultiresTree tree_behind(const ShadowTree& encoded, const MultiresTree& tree) {
    return encoded.code.code == ShadowCode::mmh ? Unfolding(encoded).run() : tree;
}

}  // namespace obscura
