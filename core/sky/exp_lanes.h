#pragma once
// exp for many numbers at once, where a few digits less than num::exp's do.

#include <bit>
#include <cstdint>

namespace obscura {

/// e^x for x in [-700, 0], relative error below 1e-13. One multiplication, addition or bit operation after
/// another, no branch: the same bits everywhere, and compilers put it into lanes. Taylor series on |r| <= ln
/// 2 / 2 after x = k ln 2 + r (Muller 2016, ch. 11).
inline double exp_of_depth(double x) {
    // Adding 1.5 * 2^52 rounds to an integer, which then stands in the last bits.
    const double rounder = 0x1.8p52;
    const double shifted = x * 1.4426950408889634 + rounder;
    const double k = shifted - rounder;
    const double r = (x - k * 0x1.62e42feep-1) - k * 0x1.a39ef35793c76p-33;
    double sum = 1.0 / 39916800;
    sum = sum * r + 1.0 / 3628800;
    sum = sum * r + 1.0 / 362880;
    sum = sum * r + 1.0 / 40320;
    sum = sum * r + 1.0 / 5040;
    sum = sum * r + 1.0 / 720;
    sum = sum * r + 1.0 / 120;
    sum = sum * r + 1.0 / 24;
    sum = sum * r + 1.0 / 6;
    sum = sum * r + 0.5;
    sum = sum * r + 1;
    sum = sum * r + 1;
    // Times 2^k: into the exponent.
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(sum) +
                                 (std::bit_cast<std::uint64_t>(shifted) << 52));
}

}  // namespace obscura
