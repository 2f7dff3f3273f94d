#include "bench/diffraction/truth.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/parallel.h"
#include "optics/field/fresnel.h"

namespace obscura {
namespace {

using Complex = std::complex<double>;
/// factor(i, texel) of the i-th sample of an axis.
using Factors = std::vector<std::vector<Complex>>;

Factors far_factors(const SampledAxis& samples, double first, double step, int texels, const Exec& exec) {
    Factors factors(samples.size());
    parallel_for(samples.size(), exec, [&](std::size_t i) {
        const double frequency = first + samples.indices[i] * step, angle = M_PI * frequency;
        const double sinc = frequency == 0 ? 1 : std::sin(angle) / angle;
        for (int x = 0; x < texels; ++x) {
            const double turns = frequency * (x + 0.5 - 0.5 * texels);
            factors[i].push_back(sinc * std::polar(1.0, -2 * M_PI * (turns - std::round(turns))));
        }
    });
    return factors;
}

/// Shares of the unobstructed wave that reach each sample through each texel: differences of Fresnel
/// integrals.
Factors near_factors(const SampledAxis& samples, double first, double step, int texels, double turns,
                     const Exec& exec) {
    Factors factors(samples.size());
    parallel_for(samples.size(), exec, [&](std::size_t i) {
        const double at = first + samples.indices[i] * step + 0.5 * texels, scale = 2 * std::sqrt(turns);
        FresnelValue before = fresnel_integral(scale * -at);
        for (int x = 0; x < texels; ++x) {
            const FresnelValue here = fresnel_integral(scale * (x + 1 - at));
            factors[i].push_back(Complex(here.c - before.c, here.s - before.s) / Complex(1, 1));
            before = here;
        }
    });
    return factors;
}

/// Sum over texels of mask(x, y) * u(i, x) * v(j, y), rows of the mask first.
std::vector<Complex> separable_sum(ImageView<const float> mask, const Factors& u, const Factors& v,
                                   const Exec& exec) {
    const std::size_t columns = u.size(), height = static_cast<std::size_t>(mask.height);
    std::vector<Complex> rows(columns * height), values(columns * v.size());
    parallel_for(height, exec, [&](std::size_t y) {
        const float* texels = mask.row(static_cast<int>(y));
        for (std::size_t i = 0; i < columns; ++i) {
            double re = 0, im = 0;
            for (std::size_t x = 0; x < static_cast<std::size_t>(mask.width); ++x) {
                re += static_cast<double>(texels[x]) * u[i][x].real();
                im += static_cast<double>(texels[x]) * u[i][x].imag();
            }
            rows[y * columns + i] = {re, im};
        }
    });
    parallel_for(v.size(), exec, [&](std::size_t j) {
        std::vector<double> re(columns), im(columns);
        for (std::size_t y = 0; y < height; ++y) {
            const double v_re = v[j][y].real(), v_im = v[j][y].imag();
            for (std::size_t i = 0; i < columns; ++i) {
                const Complex row = rows[y * columns + i];
                re[i] += row.real() * v_re - row.imag() * v_im;
                im[i] += row.real() * v_im + row.imag() * v_re;
            }
        }
        for (std::size_t i = 0; i < columns; ++i)
            values[j * columns + i] = {re[i], im[i]};
    });
    return values;
}

/// Largest and logarithmic errors over the samples: `difference` in amplitude and `power`, both of a pixel.
FieldError error_over(const TrueField& truth,
                      const std::function<double(int x, int y, Complex exact)>& difference,
                      const std::function<double(int x, int y)>& power) {
    const double floor = 1e-10, unit2 = truth.unit * truth.unit;
    double worst = 0, squares = 0, weights = 0;
    for (std::size_t j = 0; j < truth.rows.size(); ++j) {
        for (std::size_t i = 0; i < truth.columns.size(); ++i) {
            const Complex exact = truth.values[j * truth.columns.size() + i];
            const int x = truth.columns.indices[i], y = truth.rows.indices[j];
            const double error = difference(x, y, exact);
            if (!(error <= worst)) worst = std::isfinite(error) ? error : INFINITY;
            const double shown = std::max(power(x, y) / unit2, floor);
            const double decades = std::log10(shown / std::max(std::norm(exact) / unit2, floor));
            const double weight = truth.columns.weights[i] * truth.rows.weights[j];
            squares += weight * decades * decades;
            weights += weight;
        }
    }
    const double rms = std::sqrt(squares / weights);
    return {worst / truth.unit, rms > 0 ? 20 * std::log10(10 / rms) : INFINITY};
}

Complex value_at(const Field& field, int x, int y) {
    return {static_cast<double>(field.re(x, y)), static_cast<double>(field.im(x, y))};
}

}  // namespace

SampledAxis sampled_axis(int count, int middle, int most) {
    const int step = count <= most ? 1 : (2 * count / most) | 1;
    SampledAxis axis;
    for (int i = 0; i < count; ++i) {
        const bool near_middle = std::abs(i - middle) <= most / 4;
        if (!near_middle && i % step != 0) continue;
        axis.indices.push_back(i);
        axis.weights.push_back(near_middle ? 1 : step);
    }
    return axis;
}

TrueField true_far_field(ImageView<const float> mask, const FrequencyGrid& grid, int most_columns,
                         int most_rows, const Exec& exec) {
    TrueField truth;
    truth.columns = sampled_axis(grid.width, static_cast<int>(-grid.first_u / grid.step_u), most_columns);
    truth.rows = sampled_axis(grid.height, static_cast<int>(-grid.first_v / grid.step_v), most_rows);
    truth.values =
        separable_sum(mask, far_factors(truth.columns, grid.first_u, grid.step_u, mask.width, exec),
                      far_factors(truth.rows, grid.first_v, grid.step_v, mask.height, exec), exec);
    truth.unit = 0;
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x)
            truth.unit += static_cast<double>(mask(x, y));
    }
    return truth;
}

TrueField true_near_field(ImageView<const float> mask, const PlaneGrid& grid, double turns, int most,
                          const Exec& exec) {
    TrueField truth;
    truth.columns = sampled_axis(grid.width, grid.width / 2, most);
    truth.rows = sampled_axis(grid.height, grid.height / 2, most);
    truth.values =
        separable_sum(mask, near_factors(truth.columns, grid.first_x, grid.step, mask.width, turns, exec),
                      near_factors(truth.rows, grid.first_y, grid.step, mask.height, turns, exec), exec);
    return truth;
}

FieldError error_of(const Field& field, const TrueField& truth) {
    return error_over(
        truth, [&](int x, int y, Complex exact) { return std::abs(value_at(field, x, y) - exact); },
        [&](int x, int y) { return std::norm(value_at(field, x, y)); });
}

FieldError error_of(const Image<float>& power, const TrueField& truth) {
    return error_over(
        truth,
        [&](int x, int y, Complex exact) {
            return std::fabs(std::sqrt(static_cast<double>(power(x, y))) - std::abs(exact));
        },
        [&](int x, int y) { return static_cast<double>(power(x, y)); });
}

}  // namespace obscura
