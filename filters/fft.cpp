#include "filters/fft.h"

#include "core/error.h"
#include "core/num.h"

namespace obscura {
namespace {

/// e^(-2 pi i (j k) / n) for j = 1, 2, 3 and every k below n / 4: what one radix-4 pass of length n reads.
/// In degrees the angle is exact, so quarter turns are exact too.
void append_pass(int n, std::vector<float>& re, std::vector<float>& im) {
    for (int k = 0; k < n / 4; ++k) {
        for (int j = 1; j < 4; ++j) {
            const double degrees = 360.0 * (j * k) / n;
            re.push_back(static_cast<float>(num::cos_deg(degrees)));
            im.push_back(static_cast<float>(-num::sin_deg(degrees)));
        }
    }
}

/// A pass of radix r leaves the coefficients j, j + r, j + 2 r, ... in block j.
std::vector<std::uint32_t> positions(int log2_length) {
    const std::uint32_t length = 1u << log2_length;
    std::vector<std::uint32_t> position(length);
    for (std::uint32_t k = 0; k < length; ++k) {
        std::uint32_t at = 0, rest = k, block = length;
        while (block > 1) {
            const std::uint32_t radix = block >= 4 ? 4 : 2;
            block /= radix;
            at += (rest % radix) * block;
            rest /= radix;
        }
        position[k] = at;
    }
    return position;
}

void check_arrays(const FftPlan& plan, const float* re, const float* im) {
    CHECK(plan.position.size() == static_cast<std::size_t>(plan.length()));
    CHECK(reinterpret_cast<std::uintptr_t>(re) % 64 == 0 && reinterpret_cast<std::uintptr_t>(im) % 64 == 0);
}

}  // namespace

FftPlan fft_plan(int log2_length) {
    CHECK(log2_length >= 0 && log2_length <= 16);
    FftPlan plan;
    plan.log2_length = log2_length;
    plan.position = positions(log2_length);
    plan.re.reserve(plan.position.size());
    plan.im.reserve(plan.position.size());
    // Shortest pass first, so that every length finds its twiddles at fft_pass_offset().
    for (int n = log2_length % 2 == 0 ? 4 : 8; n <= plan.length(); n *= 4) {
        plan.re.resize(static_cast<std::size_t>(fft_pass_offset(n)));
        plan.im.resize(plan.re.size());
        append_pass(n, plan.re, plan.im);
    }
    return plan;
}

void fft16_forward(const FftPlan& plan, float* re, float* im, Isa isa) {
    check_arrays(plan, re, im);
    OBSCURA_DISPATCH(isa, fft16_forward, plan.table(), re, im);
}

void fft16_backward(const FftPlan& plan, float* re, float* im, Isa isa) {
    check_arrays(plan, re, im);
    OBSCURA_DISPATCH(isa, fft16_backward, plan.table(), re, im);
}

}  // namespace obscura
