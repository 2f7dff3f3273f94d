// filters/fft: against the definition in double, by the theorems a Fourier transform obeys, and ref ==
// kernels.

#include "filters/fft.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstring>
#include <numbers>
#include <random>

#include "core/buffer.h"

namespace obscura {
namespace {

using Complex = std::complex<double>;
constexpr double tau = 2 * std::numbers::pi;

/// Sixteen sequences, aligned.
struct Batch {
    int length;
    Buffer<float> re, im;
    explicit Batch(int length_)
        : length(length_),
          re(16 * static_cast<std::size_t>(length_)),
          im(16 * static_cast<std::size_t>(length_)) {
        std::fill(re.begin(), re.end(), 0.0f);
        std::fill(im.begin(), im.end(), 0.0f);
    }
    static std::size_t at(int k, int lane) { return static_cast<std::size_t>(16 * k + lane); }
    Complex get(int k, int lane) const { return {re[at(k, lane)], im[at(k, lane)]}; }
    void set(int k, int lane, Complex z) {
        re[at(k, lane)] = static_cast<float>(z.real());
        im[at(k, lane)] = static_cast<float>(z.imag());
    }
    Batch copy() const {
        Batch b(length);
        std::copy(re.begin(), re.end(), b.re.begin());
        std::copy(im.begin(), im.end(), b.im.begin());
        return b;
    }
    bool same_bits(const Batch& other) const {
        return std::memcmp(re.data(), other.re.data(), re.size() * sizeof(float)) == 0 &&
               std::memcmp(im.data(), other.im.data(), im.size() * sizeof(float)) == 0;
    }
};

Batch noise(int length, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-1.0f, 1.0f);
    Batch b(length);
    for (std::size_t i = 0; i < b.re.size(); ++i) {
        b.re[i] = value(random);
        b.im[i] = value(random);
    }
    return b;
}

Batch transformed(const FftPlan& plan, const Batch& x, Isa isa) {
    Batch b = x.copy();
    fft16_forward(plan, b.re.data(), b.im.data(), isa);
    return b;
}
Batch transformed_back(const FftPlan& plan, const Batch& x, Isa isa) {
    Batch b = x.copy();
    fft16_backward(plan, b.re.data(), b.im.data(), isa);
    return b;
}

/// The definition, sign -1 forward and +1 backward; powers of the root by table, since j k mod length is
/// exact.
Complex coefficient(const Batch& x, int lane, int j, int sign, const std::vector<Complex>& root) {
    Complex sum = 0;
    for (int k = 0; k < x.length; ++k) {
        const auto turn = static_cast<std::size_t>(std::int64_t{j} * k % x.length);
        sum += x.get(k, lane) * (sign > 0 ? root[turn] : std::conj(root[turn]));
    }
    return sum;
}
std::vector<Complex> roots(int length) {
    std::vector<Complex> root;
    for (int k = 0; k < length; ++k)
        root.push_back(std::polar(1.0, tau * k / length));
    return root;
}

/// All coefficients of short transforms; some of long ones, first and last among them.
std::vector<int> sampled(int length) {
    std::vector<int> at;
    const int count = std::min(length, 64);
    for (int i = 0; i < count; ++i)
        at.push_back(length <= 64 ? i : static_cast<int>(std::int64_t{length - 1} * i / (count - 1)));
    return at;
}

/// Root of the mean square error, relative to that of the coefficients: sqrt(length) * that of the input.
double tolerance(int log2_length) {
    return 3e-7 * std::sqrt(std::max(1.0, static_cast<double>(log2_length)));
}

TEST(Fft, ForwardIsTheDefinition) {
    for (int bits = 0; bits <= 16; ++bits) {
        const FftPlan plan = fft_plan(bits);
        const Batch x = noise(plan.length(), 1), X = transformed(plan, x, best_isa());
        const std::vector<Complex> root = roots(plan.length());
        double error = 0, power = 0;
        for (const int lane : {0, 5, 15}) {
            for (const int j : sampled(plan.length())) {
                const Complex expected = coefficient(x, lane, j, -1, root);
                error += std::norm(X.get(static_cast<int>(plan.position[static_cast<std::size_t>(j)]), lane) -
                                   expected);
                power += std::norm(expected);
            }
        }
        EXPECT_LE(std::sqrt(error / power), tolerance(bits)) << "2^" << bits;
    }
}

TEST(Fft, BackwardIsTheDefinition) {
    for (int bits = 0; bits <= 16; ++bits) {
        const FftPlan plan = fft_plan(bits);
        const Batch X = noise(plan.length(), 2);
        Batch placed(plan.length());
        for (int j = 0; j < plan.length(); ++j) {
            for (int lane = 0; lane < 16; ++lane)
                placed.set(static_cast<int>(plan.position[static_cast<std::size_t>(j)]), lane,
                           X.get(j, lane));
        }
        const Batch x = transformed_back(plan, placed, best_isa());
        const std::vector<Complex> root = roots(plan.length());
        double error = 0, power = 0;
        for (const int lane : {0, 9, 15}) {
            for (const int k : sampled(plan.length())) {
                const Complex expected = coefficient(X, lane, k, +1, root);
                error += std::norm(x.get(k, lane) - expected);
                power += std::norm(expected);
            }
        }
        EXPECT_LE(std::sqrt(error / power), tolerance(bits)) << "2^" << bits;
    }
}

TEST(Fft, PositionsAreAPermutation) {
    for (int bits = 0; bits <= 16; ++bits) {
        std::vector<std::uint32_t> position = fft_plan(bits).position;
        std::sort(position.begin(), position.end());
        ASSERT_EQ(position.size(), std::size_t{1} << bits);
        for (std::size_t i = 0; i < position.size(); ++i)
            ASSERT_EQ(position[i], i) << "2^" << bits;
    }
}

TEST(Fft, BackwardUndoesForward) {
    for (int bits = 0; bits <= 16; ++bits) {
        const FftPlan plan = fft_plan(bits);
        const Batch x = noise(plan.length(), 3),
                    y = transformed_back(plan, transformed(plan, x, best_isa()), best_isa());
        double error = 0, power = 0;
        for (int k = 0; k < plan.length(); ++k) {
            for (int lane = 0; lane < 16; ++lane) {
                error += std::norm(y.get(k, lane) / static_cast<double>(plan.length()) - x.get(k, lane));
                power += std::norm(x.get(k, lane));
            }
        }
        EXPECT_LE(std::sqrt(error / power), 2 * tolerance(bits)) << "2^" << bits;
    }
}

TEST(Fft, IsLinear) {
    for (const int bits : {1, 5, 10}) {
        const FftPlan plan = fft_plan(bits);
        const Batch x = noise(plan.length(), 4), y = noise(plan.length(), 5);
        const Complex a(0.75, -0.5);
        Batch sum(plan.length());
        for (int k = 0; k < plan.length(); ++k) {
            for (int lane = 0; lane < 16; ++lane)
                sum.set(k, lane, a * x.get(k, lane) + y.get(k, lane));
        }
        const Batch X = transformed(plan, x, best_isa()), Y = transformed(plan, y, best_isa()),
                    S = transformed(plan, sum, best_isa());
        const double unit = std::sqrt(plan.length());
        for (int k = 0; k < plan.length(); ++k) {
            for (int lane = 0; lane < 16; ++lane)
                ASSERT_LE(std::abs(S.get(k, lane) - a * X.get(k, lane) - Y.get(k, lane)), 3e-6 * unit);
        }
    }
}

TEST(Fft, ShiftTurnsPhases) {
    for (const int bits : {2, 3, 7, 11}) {
        const FftPlan plan = fft_plan(bits);
        const int shift = std::max(1, plan.length() / 3);
        const Batch x = noise(plan.length(), 6);
        Batch moved(plan.length());
        for (int k = 0; k < plan.length(); ++k) {
            for (int lane = 0; lane < 16; ++lane)
                moved.set((k + shift) % plan.length(), lane, x.get(k, lane));
        }
        const Batch X = transformed(plan, x, best_isa()), M = transformed(plan, moved, best_isa());
        for (int j = 0; j < plan.length(); ++j) {
            const int at = static_cast<int>(plan.position[static_cast<std::size_t>(j)]);
            const int steps = static_cast<int>(std::int64_t{j} * shift % plan.length());
            const Complex turn = std::polar(1.0, -tau * steps / plan.length());
            for (int lane = 0; lane < 16; ++lane)
                ASSERT_LE(std::abs(M.get(at, lane) - turn * X.get(at, lane)),
                          3e-6 * std::sqrt(plan.length()));
        }
    }
}

TEST(Fft, KeepsPower) {
    for (int bits = 0; bits <= 16; ++bits) {
        const FftPlan plan = fft_plan(bits);
        const Batch x = noise(plan.length(), 7), X = transformed(plan, x, best_isa());
        for (const int lane : {0, 7, 15}) {
            double before = 0, after = 0;
            for (int k = 0; k < plan.length(); ++k) {
                before += std::norm(x.get(k, lane));
                after += std::norm(X.get(k, lane));
            }
            EXPECT_NEAR(after / plan.length() / before, 1.0, 1e-6) << "2^" << bits;
        }
    }
}

TEST(Fft, SimpleSequencesAreExact) {
    for (int bits = 0; bits <= 16; ++bits) {
        const FftPlan plan = fft_plan(bits);
        Batch x(plan.length());
        for (int k = 0; k < plan.length(); ++k)
            x.set(k, 3, 1.0);
        x.set(0, 4, {0, 2});
        const Batch X = transformed(plan, x, best_isa());
        for (int j = 0; j < plan.length(); ++j) {
            ASSERT_EQ(X.get(j, 3), Complex(j == 0 ? plan.length() : 0)) << "2^" << bits << " at " << j;
            ASSERT_EQ(X.get(j, 4), Complex(0, 2)) << "2^" << bits << " at " << j;
        }
    }
}

TEST(Fft, LanesAreIndependent) {
    const FftPlan plan = fft_plan(9);
    const Batch x = noise(plan.length(), 8), X = transformed(plan, x, best_isa());
    Batch turned(plan.length());
    for (int k = 0; k < plan.length(); ++k) {
        for (int lane = 0; lane < 16; ++lane)
            turned.set(k, (lane + 1) % 16, x.get(k, lane));
    }
    const Batch T = transformed(plan, turned, best_isa());
    for (int k = 0; k < plan.length(); ++k) {
        for (int lane = 0; lane < 16; ++lane)
            ASSERT_EQ(T.get(k, (lane + 1) % 16), X.get(k, lane));
    }
}

/// Few values, so that sums cancel, and four sequences of zeros of either sign: zeros have a sign in their
/// bits.
Batch coarse_noise(int length, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> value(-2, 2);
    Batch b(length);
    for (std::size_t i = 0; i < b.re.size(); ++i) {
        const float scale = i % 16 < 4 ? 0.0f : 1.0f;
        b.re[i] = scale * static_cast<float>(value(random));
        b.im[i] = scale * static_cast<float>(value(random));
    }
    return b;
}

TEST(Fft, EveryInstructionSetGivesTheBitsOfRef) {
    for (int bits = 0; bits <= 16; ++bits) {
        const FftPlan plan = fft_plan(bits);
        for (const bool coarse : {false, true}) {
            const Batch x = coarse ? coarse_noise(plan.length(), 11) : noise(plan.length(), 9);
            const Batch forward = transformed(plan, x, Isa::ref),
                        backward = transformed_back(plan, x, Isa::ref);
            for (const Isa isa : supported_isas()) {
                EXPECT_TRUE(transformed(plan, x, isa).same_bits(forward)) << isa_name(isa) << " 2^" << bits;
                EXPECT_TRUE(transformed_back(plan, x, isa).same_bits(backward))
                    << isa_name(isa) << " 2^" << bits;
            }
        }
    }
}

TEST(Fft, WorksAtAnyAddressThatIsAligned) {
    const FftPlan plan = fft_plan(6);
    const Batch x = noise(plan.length(), 10), X = transformed(plan, x, best_isa());
    Buffer<float> room(4 * 16 * 64);
    for (const std::size_t shift : {0u, 16u, 48u, 1008u}) {
        float *re = room.data() + shift, *im = room.data() + shift + 1024 + 16;
        std::copy(x.re.begin(), x.re.end(), re);
        std::copy(x.im.begin(), x.im.end(), im);
        fft16_forward(plan, re, im, best_isa());
        EXPECT_TRUE(std::equal(X.re.begin(), X.re.end(), re)) << shift;
        EXPECT_TRUE(std::equal(X.im.begin(), X.im.end(), im)) << shift;
    }
    EXPECT_DEATH(fft16_forward(plan, room.data() + 1, room.data() + 2048, best_isa()), "precondition");
}

}  // namespace
}  // namespace obscura
