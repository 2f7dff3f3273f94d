#pragma once
// Pixels of image files: 8 bits per channel, sRGB encoded (IEC 61966-2-1); alpha is linear coverage. Of 16
// bits per channel, codes as they are.

#include <cstdint>

namespace obscura {

struct Rgb8 {
    std::uint8_t r = 0, g = 0, b = 0;
    friend bool operator==(const Rgb8&, const Rgb8&) = default;
};

struct Rgba8 {
    std::uint8_t r = 0, g = 0, b = 0, a = 255;
    friend bool operator==(const Rgba8&, const Rgba8&) = default;
};

struct Rgba16 {
    std::uint16_t r = 0, g = 0, b = 0, a = 65535;
    friend bool operator==(const Rgba16&, const Rgba16&) = default;
};

}  // namespace obscura
