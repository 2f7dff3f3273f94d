// J. W. Cooley, J. W. Tukey, as in filters/fft.h: radix 2, decimation in time. Scalar and in double on
// purpose: two transforms of a thousand.

#include "optics/low_columns.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "core/num.h"

namespace obscura {
namespace {

struct Complex {
    double re = 0, im = 0;
};

Complex operator+(Complex a, Complex b) {
    return {a.re + b.re, a.im + b.im};
}
Complex operator-(Complex a, Complex b) {
    return {a.re - b.re, a.im - b.im};
}
Complex operator*(Complex a, Complex b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

std::size_t first_run(const RowRuns& runs, std::size_t row) {
    return static_cast<std::size_t>(runs.first[row]);
}

/// The light that row y lets through.
double row_sum(const RowRuns& runs, std::size_t y) {
    double sum = 0;
    for (std::size_t r = first_run(runs, y); r < first_run(runs, y + 1); ++r)
        sum += static_cast<double>(runs.weight[r]) * (runs.end[r] - runs.begin[r]);
    return sum;
}

/// e^(-2 pi i u (a - origin)) - e^(-2 pi i u (b - origin)) of the row's runs [a, b), u = 1 / period.
Complex edge_sum(const RowRuns& runs, std::size_t y, const ExactRoots& roots, int origin) {
    const auto root = [&](std::int32_t x) {
        const auto at = static_cast<std::size_t>(x - origin) & (roots.re.size() - 1);
        return Complex{roots.re[at], roots.im[at]};
    };
    Complex sum;
    for (std::size_t r = first_run(runs, y); r < first_run(runs, y + 1); ++r)
        sum =
            sum + (root(runs.begin[r]) - root(runs.end[r])) * Complex{static_cast<double>(runs.weight[r]), 0};
    return sum;
}

/// Sums of x_k e^(-2 pi i j k / n) in place of x_j; `roots` are those of n, a power of two.
void transform(const ExactRoots& roots, std::vector<Complex>& x) {
    const std::size_t n = x.size();
    for (std::size_t k = 1, reversed = 0; k < n; ++k) {
        std::size_t bit = n >> 1;
        for (; (reversed & bit) != 0; bit >>= 1)
            reversed ^= bit;
        reversed |= bit;
        if (k < reversed) std::swap(x[k], x[reversed]);
    }
    // The first two passes turn by quarters: no products.
    for (std::size_t begin = 0; begin + 1 < n; begin += 2) {
        const Complex a = x[begin], b = x[begin + 1];
        x[begin] = a + b;
        x[begin + 1] = a - b;
    }
    for (std::size_t begin = 0; begin + 3 < n; begin += 4) {
        const Complex a = x[begin], b = x[begin + 2], c = x[begin + 1],
                      d{x[begin + 3].im, 0 - x[begin + 3].re};
        x[begin] = a + b;
        x[begin + 2] = a - b;
        x[begin + 1] = c + d;
        x[begin + 3] = c - d;
    }
    for (std::size_t half = 4; half < n; half *= 2) {
        const std::size_t step = n / (2 * half);
        for (std::size_t begin = 0; begin < n; begin += 2 * half) {
            for (std::size_t k = 0; k < half; ++k) {
                Complex &a = x[begin + k], &b = x[begin + k + half];
                const Complex turned = b * Complex{roots.re[k * step], roots.im[k * step]};
                b = a - turned;
                a = a + turned;
            }
        }
    }
}

Complex factor_of(const AxisFactors& factors, std::int64_t k) {
    const auto at = static_cast<std::size_t>(k);
    return {static_cast<double>(factors.re[at]), static_cast<double>(factors.im[at])};
}

/// Column `index` steps from u = 0, if the grid has it, of the spectrum of what all rows add to it; `across`:
/// its factor.
void write_column(const NaturalTransform& t, std::int64_t index, Complex across,
                  const std::vector<Complex>& spectrum, const FieldTarget& target) {
    const std::int64_t column = index - t.grid.u.first, period = t.grid.v.period();
    if (column < 0 || column >= t.grid.u.count) return;
    for (int r = 0; r < t.grid.v.count; ++r) {
        // Masks are real: what belongs to -u is the conjugate at -v of what belongs to u.
        const std::int64_t k = t.grid.v.first + r, own = (index < 0 ? -k : k) & (period - 1);
        Complex sum = spectrum[static_cast<std::size_t>(own)];
        if (index < 0) sum.im = 0 - sum.im;
        const Complex value = sum * across * factor_of(t.v_texel, r);
        const std::ptrdiff_t to = r * target.stride + column;
        if (target.power != nullptr)
            target.power[to] = static_cast<float>(value.re * value.re + value.im * value.im);
        if (target.re != nullptr) {
            target.re[to] = static_cast<float>(value.re);
            target.im[to] = static_cast<float>(value.im);
        }
    }
}

/// Spectra of the columns u = 0 and u = 1 / period.
struct LowSpectra {
    std::vector<Complex> zero, one;
};

LowSpectra low_spectra(const RowRuns& runs, const NaturalTransform& t) {
    const auto rows = runs.first.size() - 1, length = static_cast<std::size_t>(t.grid.v.period());
    LowSpectra s{std::vector<Complex>(length), std::vector<Complex>(length)};
    for (std::size_t y = 0; y < rows; ++y) {
        s.zero[y] = {row_sum(runs, y), 0};
        s.one[y] = edge_sum(runs, y, t.u_roots, 0);
    }
    transform(t.v_roots, s.zero);
    transform(t.v_roots, s.one);
    return s;
}

/// The same of masks that are the same left and right: sums about the middle are real but for a factor of i,
/// so both columns share one transform.
LowSpectra mirrored_spectra(const RowRuns& runs, const NaturalTransform& t) {
    const auto rows = runs.first.size() - 1, length = static_cast<std::size_t>(t.grid.v.period());
    std::vector<Complex> both(length);
    for (std::size_t y = 0; y < rows; ++y)
        both[y] = {row_sum(runs, y), edge_sum(runs, y, t.u_roots, t.width / 2).im};
    transform(t.v_roots, both);
    LowSpectra s{std::vector<Complex>(length), std::vector<Complex>(length)};
    for (std::size_t k = 0; k < length; ++k) {
        // X = A + i B, A and B with conjugate symmetry: X(k) and X(-k) tell them apart.
        const Complex x = both[k], y = both[(length - k) & (length - 1)];
        s.zero[k] = {0.5 * (x.re + y.re), 0.5 * (x.im - y.im)};
        s.one[k] = {0.5 * (x.im + y.im), 0.5 * (y.re - x.re)};
    }
    return s;
}

}  // namespace

void write_low_columns(const RowRuns& runs, bool mirrored, const NaturalTransform& t,
                       const FieldTarget& target) {
    const std::int64_t period = t.grid.u.period();
    if (t.grid.u.first > 1 || t.grid.u.first + t.grid.u.count <= -1) return;
    const LowSpectra spectra = mirrored ? mirrored_spectra(runs, t) : low_spectra(runs, t);
    write_column(t, 0, {1, 0}, spectra.zero, target);
    // With a period of 2 or less, the next column is that of half a cycle per texel, or 0 again.
    if (period <= 2) return;
    for (const std::int64_t index : {1, -1}) {
        const std::int64_t column = index - t.grid.u.first;
        if (column < 0 || column >= t.grid.u.count) continue;
        const Complex across =
            mirrored ? Complex{static_cast<double>(period) / (2 * num::pi), 0} : factor_of(t.u_edge, column);
        write_column(t, index, across, spectra.one, target);
    }
}

}  // namespace obscura
