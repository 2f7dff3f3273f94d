#include "core/color.h"

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/num.h"

namespace obscura {

double srgb_decode(double v) {
    return v <= 0.04045 ? v / 12.92 : num::pow((v + 0.055) / 1.055, 2.4);
}

double srgb_encode(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * num::pow(linear, 1.0 / 2.4) - 0.055;
}

float srgb8_to_linear(std::uint8_t code) {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> t{};
        for (std::size_t c = 0; c < 256; ++c)
            t[c] = static_cast<float>(srgb_decode(static_cast<double>(c) / 255.0));
        return t;
    }();
    return table[code];
}

Vec3f srgb8_to_linear(Rgb8 code) {
    return {srgb8_to_linear(code.r), srgb8_to_linear(code.g), srgb8_to_linear(code.b)};
}

float round_up_to_float(double x) {
    const float nearest = static_cast<float>(x);
    return static_cast<double>(nearest) < x ? std::nextafter(nearest, std::numeric_limits<float>::infinity())
                                            : nearest;
}

CodeTable::CodeTable(const std::array<float, 256>& thresholds) {
    // As few mantissa bits as keep thresholds apart: a small table stays in the first cache.
    int mantissa_bits = 5;
    while (!fill(thresholds, mantissa_bits)) {
        ++mantissa_bits;
        CHECK(mantissa_bits <= 10, "thresholds too close together");
    }
}

bool CodeTable::fill(const std::array<float, 256>& thresholds, int mantissa_bits) {
    shift = 23 - mantissa_bits;
    first = std::bit_cast<std::uint32_t>(thresholds[1]) >> shift;
    const std::uint32_t last = std::bit_cast<std::uint32_t>(thresholds[255]) >> shift;
    const auto lower_end = [&](std::uint32_t cell) { return std::bit_cast<float>((first + cell) << shift); };
    const std::uint32_t cells = last - first + 1;
    low = lower_end(0);
    high = std::nextafter(lower_end(cells), 0.0f);
    threshold.assign(cells, std::numeric_limits<float>::infinity());
    code.assign(cells, 0);

    std::size_t c = 0;  // the code at the lower end of the cell
    for (std::uint32_t cell = 0; cell < cells; ++cell) {
        while (c < 255 && thresholds[c + 1] <= lower_end(cell))
            ++c;
        code[cell] = static_cast<std::uint8_t>(c);
        if (c < 255 && thresholds[c + 1] < lower_end(cell + 1)) threshold[cell] = thresholds[c + 1];
        if (c < 254 && thresholds[c + 2] < lower_end(cell + 1)) return false;
    }
    return true;
}

const CodeTable& linear_to_srgb8_table() {
    static const CodeTable table = [] {
        std::array<float, 256> thresholds{};
        for (std::size_t c = 1; c < 256; ++c) {
            thresholds[c] = round_up_to_float(srgb_decode((static_cast<double>(c) - 0.5) / 255.0));
        }
        return CodeTable(thresholds);
    }();
    return table;
}

std::uint8_t linear_to_srgb8(float x) {
    return linear_to_srgb8_table()(x);
}

Rgb8 linear_to_srgb8(Vec3f linear) {
    const CodeTable& code = linear_to_srgb8_table();
    return {code(linear.x), code(linear.y), code(linear.z)};
}

}  // namespace obscura
