#pragma once
// What may be asked of the machine.

#include <cstdint>

namespace obscura {

/// Bounds that are checked before anything is allocated.
struct Limits {
    std::int64_t memory_mib = 4096;
    std::int64_t triangles = 50'000'000;
    std::int64_t texture_px = 16384;  ///< longest side
    std::int64_t texture_mib = 1024;  ///< all decoded textures together
    std::int64_t frames = 65536;
    std::int64_t image_px = 16384;  ///< longest side of a frame
    friend bool operator==(const Limits&, const Limits&) = default;
};

}  // namespace obscura
