#include "filters/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/num.h"
#include "core/parallel.h"

namespace obscura {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

void check_same_shape(const Planes& a, const Planes& b) {
    CHECK(!a.empty() && a.size() == b.size());
    for (std::size_t c = 0; c < a.size(); ++c) {
        CHECK(a[c].width == a[0].width && a[c].height == a[0].height);
        CHECK(b[c].width == a[0].width && b[c].height == a[0].height && !a[c].pixels.empty());
    }
}

bool both_finite(float a, float b) {
    return std::isfinite(a) && std::isfinite(b);
}

double difference(float a, float b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
    const double d = std::fabs(static_cast<double>(a) - static_cast<double>(b));
    return std::isnan(d) ? inf : d;
}

/// Largest difference among the channels of a pixel.
double pixel_difference(const Planes& a, const Planes& b, int x, int y) {
    double largest = 0;
    for (std::size_t c = 0; c < a.size(); ++c)
        largest = std::max(largest, difference(a[c](x, y), b[c](x, y)));
    return largest;
}

/// What one row adds.
struct RowSums {
    double largest = 0, sum = 0, squares = 0;
    int largest_x = 0, first_x = -1;
    std::int64_t over = 0, not_finite = 0;
};

RowSums compare_row(const Planes& a, const Planes& b, int y, double threshold) {
    RowSums row;
    for (int x = 0; x < a[0].width; ++x) {
        double largest = 0;
        for (std::size_t c = 0; c < a.size(); ++c) {
            const double d = difference(a[c](x, y), b[c](x, y));
            largest = std::max(largest, d);
            if (!both_finite(a[c](x, y), b[c](x, y))) {
                ++row.not_finite;
                continue;
            }
            row.sum += d;
            row.squares += d * d;
        }
        if (largest > row.largest) {
            row.largest = largest;
            row.largest_x = x;
        }
        if (largest > threshold) {
            ++row.over;
            if (row.first_x < 0) row.first_x = x;
        }
    }
    return row;
}

// --- SSIM --------------------------------------------------------------------------------------------

/// Gaussian weights of an odd window, sigma 1.5, sum 1.
std::vector<double> window_weights(int size) {
    std::vector<double> w;
    const int centre = size / 2;
    double sum = 0;
    for (int i = 0; i < size; ++i) {
        const double d = (i - centre) / 1.5;
        w.push_back(num::exp(-0.5 * d * d));
        sum += w.back();
    }
    for (double& v : w)
        v /= sum;
    return w;
}

int window_size(int side) {
    return std::min(11, side % 2 ? side : side - 1);
}

/// Weighted sums over a window: a, b, a^2, b^2, ab.
using Moments = std::array<double, 5>;

/// Sums along row y for every window that fits.
void horizontal_moments(const float* a, const float* b, const std::vector<double>& w,
                        std::vector<Moments>& out) {
    for (std::size_t x = 0; x < out.size(); ++x) {
        Moments m{};
        for (std::size_t i = 0; i < w.size(); ++i) {
            const double p = static_cast<double>(a[x + i]), q = static_cast<double>(b[x + i]);
            m[0] += w[i] * p;
            m[1] += w[i] * q;
            m[2] += w[i] * (p * p);
            m[3] += w[i] * (q * q);
            m[4] += w[i] * (p * q);
        }
        out[x] = m;
    }
}

bool equal_values(const Image<float>& a, const Image<float>& b) {
    return std::equal(a.pixels.begin(), a.pixels.end(), b.pixels.begin(),
                      [](float p, float q) { return difference(p, q) == 0; });
}

bool is_finite(const Moments& m) {
    return std::all_of(m.begin(), m.end(), [](double v) { return std::isfinite(v); });
}

/// Equation 13 of the paper.
double ssim_index(const Moments& m, double peak) {
    const double c1 = (0.01 * peak) * (0.01 * peak), c2 = (0.03 * peak) * (0.03 * peak);
    const double variance_a = m[2] - m[0] * m[0], variance_b = m[3] - m[1] * m[1],
                 covariance = m[4] - m[0] * m[1];
    return ((2 * m[0] * m[1] + c1) * (2 * covariance + c2)) /
           ((m[0] * m[0] + m[1] * m[1] + c1) * (variance_a + variance_b + c2));
}

/// Colours of difference_picture() at 0, 1/4, ... 1.
constexpr std::array<std::array<double, 3>, 5> heat{
    {{0, 0, 0}, {40, 30, 150}, {215, 40, 60}, {250, 200, 40}, {255, 255, 255}}};

template <class Pixel>
Planes split_codes(ImageView<const Pixel> image, bool with_alpha) {
    Planes planes(with_alpha ? 4 : 3, Image<float>(image.width, image.height));
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const Pixel p = image(x, y);
            planes[0](x, y) = p.r;
            planes[1](x, y) = p.g;
            planes[2](x, y) = p.b;
            if (with_alpha) planes[3](x, y) = p.a;
        }
    }
    return planes;
}

}  // namespace

Planes split_channels(ImageView<const Rgba8> image, bool with_alpha) {
    return split_codes(image, with_alpha);
}

Planes split_channels(ImageView<const Rgba16> image, bool with_alpha) {
    return split_codes(image, with_alpha);
}

Planes split_channels(const FloatImage& image) {
    if (const auto* grey = std::get_if<Image<float>>(&image)) return {*grey};
    const auto& colour = std::get<Image<Vec3f>>(image);
    Planes planes(3, Image<float>(colour.width, colour.height));
    for (std::size_t i = 0; i < colour.pixels.size(); ++i) {
        planes[0].pixels[i] = colour.pixels[i].x;
        planes[1].pixels[i] = colour.pixels[i].y;
        planes[2].pixels[i] = colour.pixels[i].z;
    }
    return planes;
}

double value_range(const Planes& planes) {
    double low = inf, high = -inf;
    for (const Image<float>& plane : planes) {
        for (const float v : plane.pixels) {
            if (!std::isfinite(v)) continue;
            low = std::min(low, static_cast<double>(v));
            high = std::max(high, static_cast<double>(v));
        }
    }
    return std::max(1e-30, high - low);
}

ImageDifference compare_images(const Planes& a, const Planes& b, const CompareParams& params,
                               const Exec& exec) {
    check_same_shape(a, b);
    const int height = a[0].height;
    std::vector<RowSums> rows(static_cast<std::size_t>(height));
    parallel_blocks(rows.size(), 32, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y)
            rows[y] = compare_row(a, b, static_cast<int>(y), params.threshold);
    });

    // Rows in order, so that the sums do not depend on threads.
    ImageDifference result;
    double sum = 0, squares = 0;
    for (int y = 0; y < height; ++y) {
        const RowSums& row = rows[static_cast<std::size_t>(y)];
        sum += row.sum;
        squares += row.squares;
        result.pixels_over += row.over;
        result.not_finite += row.not_finite;
        if (row.largest > result.max_error) {
            result.max_error = row.largest;
            result.max_x = row.largest_x;
            result.max_y = y;
        }
        if (row.first_x >= 0 && result.first_x < 0) {
            result.first_x = row.first_x;
            result.first_y = y;
        }
    }
    const auto values = static_cast<std::int64_t>(a.size() * a[0].pixels.size());
    const auto finite = static_cast<double>(std::max<std::int64_t>(values - result.not_finite, 1));
    result.mean_error = sum / finite;
    const double mean_square = squares / finite;
    result.psnr_db = mean_square > 0 ? (num::log2(params.peak * params.peak) - num::log2(mean_square)) *
                                           (10.0 / num::log2(10.0))
                                     : inf;
    result.ssim = 0;
    for (std::size_t c = 0; c < a.size(); ++c)
        result.ssim += structural_similarity(a[c], b[c], params.peak, exec);
    result.ssim /= static_cast<double>(a.size());
    return result;
}

double structural_similarity(const Image<float>& a, const Image<float>& b, double peak, const Exec& exec) {
    CHECK(a.width == b.width && a.height == b.height && !a.pixels.empty());
    const std::vector<double> across = window_weights(window_size(a.width));
    const std::vector<double> down = window_weights(window_size(a.height));
    const std::size_t columns = static_cast<std::size_t>(a.width) - across.size() + 1;
    const std::size_t rows = static_cast<std::size_t>(a.height) - down.size() + 1;

    // The window is separable: blocks of rows keep the sums along them, then add downwards.
    std::vector<double> row_sum(rows, 0.0);
    std::vector<std::int64_t> row_windows(rows, 0);
    parallel_blocks(rows, 32, exec, [&](std::size_t begin, std::size_t end) {
        std::vector<std::vector<Moments>> along(end - begin + down.size() - 1, std::vector<Moments>(columns));
        for (std::size_t i = 0; i < along.size(); ++i) {
            const int y = static_cast<int>(begin + i);
            horizontal_moments(a.row(y), b.row(y), across, along[i]);
        }
        for (std::size_t y = begin; y < end; ++y) {
            for (std::size_t x = 0; x < columns; ++x) {
                Moments m{};
                for (std::size_t i = 0; i < down.size(); ++i) {
                    for (std::size_t k = 0; k < m.size(); ++k)
                        m[k] += down[i] * along[y - begin + i][x][k];
                }
                // Every weight is positive: one infinity or NaN in the window shows in a moment.
                if (!is_finite(m)) continue;
                row_sum[y] += ssim_index(m, peak);
                ++row_windows[y];
            }
        }
    });
    double sum = 0;
    std::int64_t windows = 0;
    for (std::size_t y = 0; y < rows; ++y) {
        sum += row_sum[y];
        windows += row_windows[y];
    }
    if (windows == 0) return equal_values(a, b) ? 1 : 0;
    return sum / static_cast<double>(windows);
}

Image<Rgb8> difference_picture(const Planes& a, const Planes& b, double full_scale) {
    check_same_shape(a, b);
    CHECK(full_scale > 0);
    Image<Rgb8> picture(a[0].width, a[0].height);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const double at = 4 * std::min(1.0, pixel_difference(a, b, x, y) / full_scale);
            const auto i = std::min<std::size_t>(3, static_cast<std::size_t>(at));
            const double t = at - static_cast<double>(i);
            const auto mix = [&](std::size_t c) {
                return static_cast<std::uint8_t>(
                    std::floor(heat[i][c] + t * (heat[i + 1][c] - heat[i][c]) + 0.5));
            };
            picture(x, y) = {mix(0), mix(1), mix(2)};
        }
    }
    return picture;
}

}  // namespace obscura
