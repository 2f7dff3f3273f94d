#include "bench/diffraction/peers.h"

#include <algorithm>
#include <cmath>

#include "bench/diffraction/peer_pixels.h"
#include "core/parallel.h"
#include "optics/field/fresnel.h"

namespace obscura {
namespace {

/// Rows worth a thread's while: small grids are one item.
std::size_t rows_at_once(int columns) {
    return static_cast<std::size_t>(std::max(16, (1 << 16) / columns));
}

int modulo(std::int64_t a, int n) {
    return static_cast<int>((a % n + n) % n);
}

float sinc_squared(double frequency) {
    const double angle = M_PI * frequency;
    const double sinc = frequency == 0 ? 1 : std::sin(angle) / angle;
    return static_cast<float>(sinc * sinc);
}

}  // namespace

void ImagePeer::load(ImageView<const float> image) {
    for (int y = 0; y < image.height; ++y)
        std::copy_n(image.row(y), image.width, fft_.samples() + std::ptrdiff_t{y} * fft_.size());
}

void ImagePeer::run(float* power) {
    fft_.run();
    const int size = fft_.size(), columns = size / 2 + 1;
    parallel_blocks(static_cast<std::size_t>(size), rows_at_once(columns), exec_,
                    [&](std::size_t begin, std::size_t end) {
                        for (std::size_t y = begin; y < end; ++y) {
                            const std::ptrdiff_t from = modulo(static_cast<std::int64_t>(y) - size / 2, size);
                            OBSCURA_DISPATCH(exec_.isa, power_of, fft_.spectrum() + 2 * from * columns,
                                             columns, power + static_cast<std::ptrdiff_t>(y) * columns);
                        }
                    });
}

TexelPeer::TexelPeer(int period, const FrequencyGrid& grid, int threads)
    : fft_(period, threads), grid_(grid), exec_{best_isa(), threads} {
    const int half = period / 2;
    const auto index_of = [&](double first, int i) { return std::llround(first * period) + i; };
    rows_of_.resize(static_cast<std::size_t>(period));
    for (int y = 0; y < grid.height; ++y) {
        spectrum_row_.push_back(modulo(index_of(grid.first_v, y), period));
        rows_of_[static_cast<std::size_t>(spectrum_row_.back())].push_back(y);
        v_texel_.push_back(sinc_squared(grid.first_v + y * grid.step_v));
    }
    least_ = half;
    for (int x = 0; x < grid.width; ++x) {
        u_texel_.push_back(sinc_squared(grid.first_u + x * grid.step_u));
        const int at = modulo(index_of(grid.first_u, x), period);
        const bool mirrored = at > half;
        const int from = mirrored ? period - at : at;
        least_ = std::min(least_, from), end_ = std::max(end_, from + 1);
        if (segments_.empty() || segments_.back().mirrored != mirrored || at == 0)
            segments_.push_back({x, 0, from, mirrored});
        ++segments_.back().count;
    }
}

void TexelPeer::load(ImageView<const float> mask) {
    for (int y = 0; y < mask.height; ++y)
        std::copy_n(mask.row(y), mask.width, fft_.samples() + std::ptrdiff_t{y} * fft_.size());
}

void TexelPeer::power_row(int row, std::vector<float>& power) const {
    const std::ptrdiff_t columns = fft_.size() / 2 + 1;
    OBSCURA_DISPATCH(exec_.isa, power_of, fft_.spectrum() + 2 * (row * columns + least_), end_ - least_,
                     power.data() + least_);
}

void TexelPeer::place_row(const std::vector<float>& own, const std::vector<float>& opposite, int row,
                          float* out) const {
    const float v = v_texel_[static_cast<std::size_t>(row)];
    for (const Segment& s : segments_) {
        const float* u = u_texel_.data() + s.column;
        if (s.mirrored)
            OBSCURA_DISPATCH(exec_.isa, scale_reversed, opposite.data() + s.from, u, v, s.count,
                             out + s.column);
        else
            OBSCURA_DISPATCH(exec_.isa, scale_row, own.data() + s.from, u, v, s.count, out + s.column);
    }
}

void TexelPeer::run(float* power) {
    fft_.run();
    const int period = fft_.size();
    // Rows k and -k of the spectrum serve each other's mirrored columns: their powers are computed once.
    const auto pairs = static_cast<std::size_t>(period / 2 + 1);
    parallel_blocks(pairs, rows_at_once(grid_.width) / 2, exec_, [&](std::size_t begin, std::size_t end) {
        std::vector<float> own(pairs), opposite(pairs);
        for (std::size_t k = begin; k < end; ++k) {
            const int row = static_cast<int>(k), other = modulo(-row, period);
            const auto &shown = rows_of_[k], &shown_opposite = rows_of_[static_cast<std::size_t>(other)];
            if (shown.empty() && shown_opposite.empty()) continue;
            power_row(row, own);
            power_row(other, opposite);
            for (const int y : shown)
                place_row(own, opposite, y, power + std::ptrdiff_t{y} * grid_.width);
            if (other == row) continue;
            for (const int y : shown_opposite)
                place_row(opposite, own, y, power + std::ptrdiff_t{y} * grid_.width);
        }
    });
}

namespace {

using Complex = std::complex<double>;

/// Share of the unobstructed wave that a texel `distance` texels away sends along one axis.
Complex kernel_at(double distance, double turns, ChirpKernel kernel) {
    if (kernel == ChirpKernel::sampled) {
        const double phase = turns * distance * distance;
        return std::polar(std::sqrt(2 * turns), 2 * M_PI * (phase - std::floor(phase)) - M_PI / 4);
    }
    const double scale = 2 * std::sqrt(turns);
    const FresnelValue a = fresnel_integral(scale * (distance - 0.5)),
                       b = fresnel_integral(scale * (distance + 0.5));
    return Complex(b.c - a.c, b.s - a.s) / Complex(1, 1);
}

}  // namespace

FresnelPeer::FresnelPeer(int size, int padding, int threads)
    : size_(size), fft_(padding * size, threads), exec_{best_isa(), threads} {}

void FresnelPeer::set_kernel(double turns, ChirpKernel kernel) {
    const int length = fft_.size();
    std::vector<Complex> roots, samples;
    for (int k = 0; k < length; ++k)
        roots.push_back(std::polar(1.0, -2 * M_PI * k / length));
    for (int k = 0; k < size_; ++k)
        samples.push_back(kernel_at(k, turns, kernel));
    kernel_.clear();
    // The kernel is even and reaches size - 1 texels to either side.
    for (int k = 0; k < length; ++k) {
        Complex sum = samples[0];
        for (int d = 1; d < size_; ++d)
            sum += 2.0 * samples[static_cast<std::size_t>(d)] *
                   roots[static_cast<std::size_t>(std::int64_t{k} * d % length)].real();
        sum /= length;
        kernel_.push_back(static_cast<float>(sum.real()));
        kernel_.push_back(static_cast<float>(sum.imag()));
    }
}

void FresnelPeer::load(ImageView<const float> mask) {
    const int length = fft_.size();
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x)
            fft_.samples()[2 * (std::ptrdiff_t{y} * length + x)] = mask(x, y);
    }
}

void FresnelPeer::run(float* re, float* im) {
    fft_.forward();
    const std::ptrdiff_t length = fft_.size();
    float* spectrum = fft_.spectrum();
    parallel_blocks(static_cast<std::size_t>(length), rows_at_once(fft_.size()), exec_,
                    [&](std::size_t begin, std::size_t end) {
                        for (std::size_t y = begin; y < end; ++y) {
                            OBSCURA_DISPATCH(exec_.isa, multiply_row,
                                             spectrum + 2 * static_cast<std::ptrdiff_t>(y) * length,
                                             kernel_.data(), kernel_[2 * y], kernel_[2 * y + 1],
                                             static_cast<std::int32_t>(length));
                        }
                    });
    fft_.backward();
    parallel_blocks(static_cast<std::size_t>(size_), rows_at_once(size_), exec_,
                    [&](std::size_t begin, std::size_t end) {
                        for (std::size_t y = begin; y < end; ++y) {
                            const auto row = static_cast<std::ptrdiff_t>(y);
                            OBSCURA_DISPATCH(exec_.isa, split_row, spectrum + 2 * row * length, size_,
                                             re + row * size_, im + row * size_);
                        }
                    });
}

}  // namespace obscura
