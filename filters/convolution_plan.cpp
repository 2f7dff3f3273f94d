// What convolution costs, and the cheapest tiles. Constants in nanoseconds of one thread of an AVX-512
// machine (3 GHz, 2 MB of second cache); only their ratios decide.

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "filters/convolution.h"

namespace obscura {
namespace {

constexpr double add_row_ns = 4.0;      // one row of the kernel, whatever its length
constexpr double add_pixel_ns = 0.065;  // one pixel of it
constexpr double scan_pixel_ns = 1.1;   // finding the sources
constexpr double carry_pixel_ns = 2.0;  // of a pair of tiles: load, transpose twice, multiply, store
constexpr double touch_pixel_ns = 5.0;  // of a tile's memory, once, beyond what allocators keep at hand
constexpr double kept_pixels = 1 << 20;

/// Per pixel of a sixteen-fold transform of length 2^bits: passes, which become dearer as caches overflow.
double fft_pixel_ns(int bits) {
    return bits * (0.4 + 0.05 * bits) / 16;
}

/// One axis of the result: transforms of length 2^bits, and how many tiles that makes.
struct Axis {
    int bits, tiles;
};
bool axis_of(int bits, int size, int kernel_size, Axis& axis) {
    const std::int64_t length = std::int64_t{1} << bits, result = std::int64_t{size} + kernel_size - 1;
    if (length >= result) {
        axis = {bits, 1};
        return true;
    }
    const std::int64_t valid = length - kernel_size + 1;
    if (valid < 1) return false;
    axis = {bits, static_cast<int>((result + valid - 1) / valid)};
    return true;
}

/// The kernel goes forward; two tiles go forward and back together.
double fft_ns(const Axis& x, const Axis& y) {
    const double pixels = static_cast<double>(std::int64_t{1} << (x.bits + y.bits));
    const double transform = fft_pixel_ns(x.bits) + fft_pixel_ns(y.bits);
    const double touch = pixels > kept_pixels ? touch_pixel_ns : 0;
    const std::int64_t pair_count = (std::int64_t{x.tiles} * y.tiles + 1) / 2;
    const auto pairs = static_cast<double>(pair_count);
    return pixels * (touch + transform + carry_pixel_ns / 2 + pairs * (2 * transform + carry_pixel_ns));
}

}  // namespace

ConvolutionPlan plan_convolution(std::int64_t sources, int width, int height, int kernel_width,
                                 int kernel_height) {
    CHECK(sources >= 0 && width >= 1 && height >= 1 && kernel_width >= 1 && kernel_height >= 1);
    constexpr int most_bits = 16;
    if (kernel_width > 1 << most_bits || kernel_height > 1 << most_bits) {
        throw LimitError(fmt::format("a kernel of {} x {} pixels is larger than the {} that transforms reach",
                                     kernel_width, kernel_height, 1 << most_bits));
    }
    ConvolutionPlan plan;
    double least = std::numeric_limits<double>::infinity();
    for (int by = 4; by <= most_bits; ++by) {
        for (int bx = 4; bx <= most_bits; ++bx) {
            Axis x, y;
            if (!axis_of(bx, width, kernel_width, x) || !axis_of(by, height, kernel_height, y)) continue;
            const double ns = fft_ns(x, y);
            if (ns >= least) continue;
            least = ns;
            plan.log2_x = bx;
            plan.log2_y = by;
            plan.tiles_x = x.tiles;
            plan.tiles_y = y.tiles;
        }
    }
    const double pixels = static_cast<double>(width) * height;
    plan.fft_ms = least * 1e-6;
    plan.splat_ms = (pixels * scan_pixel_ns + static_cast<double>(sources) * kernel_height *
                                                  (add_row_ns + kernel_width * add_pixel_ns)) *
                    1e-6;
    plan.fft = plan.fft_ms < plan.splat_ms;
    // The kernel's transform, one pair of tiles, the result.
    plan.fft_bytes =
        (std::int64_t{16} << (plan.log2_x + plan.log2_y)) +
        4 * (std::int64_t{width} + kernel_width - 1) * (std::int64_t{height} + kernel_height - 1);
    return plan;
}

}  // namespace obscura
