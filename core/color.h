#pragma once
// Between linear light and 8-bit sRGB (IEC 61966-2-1:1999), exact in both directions.

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/pixel.h"
#include "core/vec.h"

namespace obscura {

/// The decoding function of sRGB: v in [0, 1] to linear light in [0, 1].
double srgb_decode(double v);
/// Its inverse: linear light in [0, 1] to the encoded value in [0, 1].
double srgb_encode(double linear);

/// srgb_decode(code / 255), rounded to float; from a table.
float srgb8_to_linear(std::uint8_t code);
Vec3f srgb8_to_linear(Rgb8 code);

/// A rising step function from floats to codes 0..255 in constant time: one table cell, one comparison.
///
/// Codes are decided by thresholds alone: code(x) is the number of thresholds 1..255 that are <= x. So it is
/// monotone by construction, and as exact as the thresholds. The table is indexed by exponent and leading
/// mantissa bits of x; a cell holds the code at its lower end and the one threshold inside it, if any.
/// (F. Giesen's float_to_srgb8, 2012, indexes the same way and interpolates to +-0.6 codes; here it is
/// exact.)
class CodeTable {
  public:
    /// thresholds[c] is the least float with code c; [0] is not used, [1..255] are positive, finite and rise
    /// by at least a relative 2^-9.
    explicit CodeTable(const std::array<float, 256>& thresholds);

    /// Negative, tiny and NaN give 0; large gives 255.
    std::uint8_t operator()(float x) const {
        x = x > low ? x : low;  // NaN goes low
        x = x < high ? x : high;
        const std::size_t cell = (std::bit_cast<std::uint32_t>(x) >> shift) - first;
        return static_cast<std::uint8_t>(code[cell] + (x >= threshold[cell] ? 1 : 0));
    }

  private:
    bool fill(const std::array<float, 256>& thresholds, int mantissa_bits);

    float low = 0, high = 0;
    int shift = 0;
    std::uint32_t first = 0;
    std::vector<float> threshold;
    std::vector<std::uint8_t> code;
};

/// Linear light to the code nearest to 255 * srgb_encode(x): code c from srgb_decode((c - 0.5) / 255) on.
const CodeTable& linear_to_srgb8_table();
/// The same for one value; hold the table in loops.
std::uint8_t linear_to_srgb8(float x);
Rgb8 linear_to_srgb8(Vec3f linear);

/// The least float that is >= x.
float round_up_to_float(double x);

}  // namespace obscura
