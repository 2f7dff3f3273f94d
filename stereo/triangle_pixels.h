#pragma once
// The pixels of the map that each triangle shows.

#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"

namespace obscura {

/// Pixels (row * width + column) sorted by triangle, ascending within each.
struct TrianglePixels {
    std::vector<std::uint32_t> first;  ///< triangles + 1 offsets into `pixels`
    std::vector<std::uint32_t> pixels;
    std::span<const std::uint32_t> of(std::size_t triangle) const {
        return {pixels.data() + first[triangle], first[triangle + 1] - first[triangle]};
    }
};

/// `triangle`: per pixel an index below `triangles`, or nothing_seen.
TrianglePixels triangle_pixels(const Image<std::uint32_t>& triangle, std::size_t triangles);

}  // namespace obscura
