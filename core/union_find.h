#pragma once
// Disjoint sets. The root of a set is its smallest member, whatever the order of the unions.

#include <cstdint>
#include <numeric>
#include <vector>

namespace obscura {

struct UnionFind {
    explicit UnionFind(std::size_t count = 0) { reset(count); }

    /// Every member alone again.
    void reset(std::size_t count) {
        parent.resize(count);
        std::iota(parent.begin(), parent.end(), 0u);
    }

    std::uint32_t root(std::uint32_t i) {
        while (parent[i] != i)
            i = parent[i] = parent[parent[i]];
        return i;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        a = root(a);
        b = root(b);
        if (a < b) {
            parent[b] = a;
        } else {
            parent[a] = b;
        }
    }

    std::vector<std::uint32_t> parent;
};

}  // namespace obscura
