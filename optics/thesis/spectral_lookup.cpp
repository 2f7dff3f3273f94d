// Scaled lookups of a power image (thesis 3.15 to 3.17), and four at a time (thesis 3.4.3, "batch scaling").

#include "optics/thesis/spectral_lookup.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace obscura {

namespace {

constexpr int rows_per_item = 8;

/// Four neighbouring samples and their weights; linear uses the inner two.
struct Taps {
    int at[4];
    float weight[4];
};

Taps taps_at(double place, int size, PowerInterpolation interpolation) {
    const double whole = std::floor(place);
    const double t = place - whole;
    Taps taps{};
    for (int i = 0; i < 4; ++i)
        taps.at[i] = static_cast<int>(std::clamp(whole + (i - 1), 0.0, static_cast<double>(size - 1)));
    if (interpolation == PowerInterpolation::linear) {
        taps.weight[1] = static_cast<float>(1 - t);
        taps.weight[2] = static_cast<float>(t);
    } else {
        taps.weight[0] = static_cast<float>(0.5 * t * (t * (2 - t) - 1));
        taps.weight[1] = static_cast<float>(0.5 * (t * t * (3 * t - 5) + 2));
        taps.weight[2] = static_cast<float>(0.5 * t * (t * (4 - 3 * t) + 1));
        taps.weight[3] = static_cast<float>(0.5 * t * t * (t - 1));
    }
    return taps;
}

/// Taps of every column (or row) of `grid`, scaled, in `from`.
std::vector<Taps> taps_along(double first, double step, int count, double scale, double from_first,
                             double from_step, int from_size, PowerInterpolation interpolation) {
    std::vector<Taps> taps;
    taps.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        taps.push_back(
            taps_at(((first + i * step) * scale - from_first) / from_step, from_size, interpolation));
    return taps;
}

float interpolate(const Image<float>& image, const Taps& x, const Taps& y, PowerInterpolation interpolation) {
    const int begin = interpolation == PowerInterpolation::linear ? 1 : 0, end = 4 - begin;
    float sum = 0;
    for (int j = begin; j < end; ++j) {
        const float* row = image.row(y.at[j]);
        float across = 0;
        for (int i = begin; i < end; ++i)
            across += x.weight[i] * row[x.at[i]];
        sum += y.weight[j] * across;
    }
    return sum;
}

/// Calls visit(x, y, taps of x, taps of y) for every pixel of `grid`, scaled into `from`.
template <class Visit>
void for_scaled_pixels(const FrequencyGrid& grid, double scale, const FrequencyGrid& from,
                       PowerInterpolation interpolation, const Exec& exec, Visit&& visit) {
    const std::vector<Taps> columns = taps_along(grid.first_u, grid.step_u, grid.width, scale, from.first_u,
                                                 from.step_u, from.width, interpolation);
    const std::vector<Taps> rows = taps_along(grid.first_v, grid.step_v, grid.height, scale, from.first_v,
                                              from.step_v, from.height, interpolation);
    parallel_blocks(static_cast<std::size_t>(grid.height), rows_per_item, exec,
                    [&](std::size_t begin, std::size_t end) {
                        for (std::size_t y = begin; y < end; ++y) {
                            for (int x = 0; x < grid.width; ++x)
                                visit(x, static_cast<int>(y), columns[static_cast<std::size_t>(x)], rows[y]);
                        }
                    });
}

/// One axis of scaled_cover().
struct Span {
    double first = 0;
    int count = 0;
};
Span cover(double first, double step, int count, double least_scale, double largest_scale, double to_step) {
    const double last = first + (count - 1) * step;
    const double low = std::min(first * least_scale, first * largest_scale);
    const double high = std::max(last * least_scale, last * largest_scale);
    const double begin = std::floor(low / to_step) - 1, end = std::ceil(high / to_step) + 2;
    if (!(end - begin < 1 << 28)) throw LimitError("a coloured pattern needs a power image past 2^28 pixels");
    return {begin * to_step, static_cast<int>(end - begin) + 1};
}

}  // namespace

FrequencyGrid scaled_cover(const FrequencyGrid& grid, double least_scale, double largest_scale, double step) {
    CHECK(least_scale > 0 && largest_scale >= least_scale && step > 0);
    const Span u = cover(grid.first_u, grid.step_u, grid.width, least_scale, largest_scale, step);
    const Span v = cover(grid.first_v, grid.step_v, grid.height, least_scale, largest_scale, step);
    if (std::int64_t{u.count} * v.count > std::int64_t{1} << 28)
        throw LimitError("a coloured pattern needs a power image past 2^28 pixels");
    return {u.count, v.count, u.first, v.first, step, step};
}

void add_scaled_power(const PowerImage& from, const FrequencyGrid& grid, double scale, Vec3d weight,
                      PowerInterpolation interpolation, Image<Vec3f>& sum, const Exec& exec) {
    const Vec3f colour = to_float(weight);
    for_scaled_pixels(grid, scale, from.grid, interpolation, exec,
                      [&](int x, int y, const Taps& column, const Taps& row) {
                          const float power = interpolate(from.power, column, row, interpolation);
                          sum(x, y) = sum(x, y) + colour * power;
                      });
}

PowerBatch gather_batch(const PowerImage& from, const FrequencyGrid& grid, const double (&ladder)[4],
                        PowerInterpolation interpolation, const Exec& exec) {
    PowerBatch batch;
    batch.grid = grid;
    for (int c = 0; c < 4; ++c) {
        batch.power[c] = Image<float>(grid.width, grid.height);
        for_scaled_pixels(grid, ladder[c], from.grid, interpolation, exec,
                          [&](int x, int y, const Taps& column, const Taps& row) {
                              batch.power[c](x, y) = interpolate(from.power, column, row, interpolation);
                          });
    }
    return batch;
}

void add_scaled_batch(const PowerBatch& from, const FrequencyGrid& grid, double scale,
                      const Vec3d (&weight)[4], PowerInterpolation interpolation, Image<Vec3f>& sum,
                      const Exec& exec) {
    Vec3f colour[4];
    for (int c = 0; c < 4; ++c)
        colour[c] = to_float(weight[c]);
    for_scaled_pixels(grid, scale, from.grid, interpolation, exec,
                      [&](int x, int y, const Taps& column, const Taps& row) {
                          Vec3f added;
                          for (int c = 0; c < 4; ++c) {
                              const float power = interpolate(from.power[c], column, row, interpolation);
                              added = added + colour[c] * power;
                          }
                          sum(x, y) = sum(x, y) + added;
                      });
}

}  // namespace obscura
