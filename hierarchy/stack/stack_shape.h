#pragma once
// How a stack of maps is divided: which of its three axes halve at which height. POD: kernels include this.
//
// Scandolo, Bauszat, Eisemann 2016, section 4, divides a cube of N maps of N x N texels, and fills cubes of
// fewer maps with placeholders of interval [0, 1]. Here a node of side s spans s >> a maps, a the anisotropy
// (s << -a where a is negative), never less than one map nor more than all; where one axis has come to its
// end, the others are divided alone. That equals the placeholders, node for node
// (StackShape.PlaceholdersAreAxesThatAreNotDivided).

#include <cstdint>

namespace obscura {

/// 2^slice_levels maps of 2^map_levels texels a side. Nodes of height h have children of height h - 1, child
/// x + 2 y + 4 k; those along an axis that is not divided do not exist. Texels have height 0, the root
/// levels().
struct StackShape {
    std::int32_t map_levels = 0;
    std::int32_t slice_levels = 0;
    std::int32_t anisotropy = 0;  ///< in [-slice_levels, map_levels]

    /// Below these heights nodes are one texel wide, or one map thick.
    constexpr std::int32_t map_start() const { return anisotropy < 0 ? -anisotropy : 0; }
    constexpr std::int32_t slice_start() const { return anisotropy > 0 ? anisotropy : 0; }
    constexpr std::int32_t levels() const {
        const std::int32_t by_map = map_levels + map_start(), by_slice = slice_levels + slice_start();
        return by_map > by_slice ? by_map : by_slice;
    }
    /// log2 of the texels a side, and of the maps, that a node of this height spans.
    constexpr std::int32_t side_exponent(std::int32_t height) const {
        return clamped(height - map_start(), map_levels);
    }
    constexpr std::int32_t slices_exponent(std::int32_t height) const {
        return clamped(height - slice_start(), slice_levels);
    }
    /// Whether nodes of this height (>= 1) are divided along an axis.
    constexpr bool divides_map(std::int32_t height) const {
        return side_exponent(height) != side_exponent(height - 1);
    }
    constexpr bool divides_slices(std::int32_t height) const {
        return slices_exponent(height) != slices_exponent(height - 1);
    }
    /// log2 of the side of squares below which only what has no depth in common matters, in any map.
    constexpr std::int32_t detail_height() const { return slice_start(); }
    friend bool operator==(const StackShape&, const StackShape&) = default;

  private:
    static constexpr std::int32_t clamped(std::int32_t v, std::int32_t most) {
        return v < 0 ? 0 : (v > most ? most : v);
    }
};

}  // namespace obscura
