#pragma once
// One texel of a dense map.

#include <cstdint>

#include "filters/pcf.h"

namespace obscura::ref {

/// Twin of StoredDepths::at(). x, y inside the map.
inline float stored_texel(const PcfView& view, std::int64_t x, std::int64_t y) {
    const std::int64_t size = view.size;
    return view.stored[((y / 4) * (size / 4) + x / 4) * 16 + (y % 4) * 4 + x % 4];
}

}  // namespace obscura::ref
