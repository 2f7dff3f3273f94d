// Phasors and interval transforms: against libm in double, and ref = kernels bit for bit.

#include "optics/field/phasor.h"

#include <gtest/gtest.h>

#include <cstring>

#include "core/isa.h"
#include "tests/optics/far_field_reference.h"

namespace obscura {
namespace {

using far_field_reference::Complex;

std::vector<double> many_turns() {
    std::vector<double> turns{0,    0.125,  -0.125, 0.25,    0.375,  0.5,
                              -0.5, 1e-300, 1e-9,   12345.0, 0x1p30, -0x1p30};
    std::uint64_t state = 7;
    for (int i = 0; i < 20000; ++i) {
        state = state * 6364136223846793005u + 1442695040888963407u;
        const double unit = static_cast<double>(state >> 11) * 0x1p-53 - 0.5;
        turns.push_back(std::ldexp(unit, static_cast<int>(state % 45) - 13));
    }
    return turns;
}

TEST(Phasor, NearTheTrueValueUpToTwoToTheThirty) {
    const std::vector<double> turns = many_turns();
    const int count = static_cast<int>(turns.size());
    std::vector<float> re(turns.size()), im(turns.size());
    ref::phasors(turns.data(), count, re.data(), im.data());
    double worst = 0;
    for (std::size_t i = 0; i < turns.size(); ++i) {
        const Complex truth = far_field_reference::turn(turns[i]);
        worst = std::max(worst, std::abs(Complex(re[i], im[i]) - truth));
    }
    EXPECT_LT(worst, 1.5e-7);
    EXPECT_EQ(re[0], 1.0f);
    EXPECT_EQ(im[3], -1.0f);
    EXPECT_EQ(re[5], -1.0f);
}

TEST(Phasor, KernelsGiveTheBitsOfRef) {
    const std::vector<double> turns = many_turns();
    for (const int count : {0, 1, 15, 16, 17, static_cast<int>(turns.size())}) {
        const auto n = static_cast<std::size_t>(count);
        std::vector<float> re(n + 1, 7.0f), im(n + 1, 7.0f), row_re(n + 1, 7.0f), row_im(n + 1, 7.0f);
        const FrequencyRamp ramp{-0.37, 1.0 / 771, count};
        ref::phasors(turns.data(), count, re.data(), im.data());
        ref::phasor_row(ramp, 113.5, row_re.data(), row_im.data());
        for (const Isa isa : supported_isas()) {
            std::vector<float> a(n + 1, 7.0f), b(n + 1, 7.0f);
            OBSCURA_DISPATCH(isa, phasors, turns.data(), count, a.data(), b.data());
            ASSERT_EQ(0, std::memcmp(a.data(), re.data(), 4 * (n + 1))) << isa_name(isa);
            ASSERT_EQ(0, std::memcmp(b.data(), im.data(), 4 * (n + 1))) << isa_name(isa);
            OBSCURA_DISPATCH(isa, phasor_row, ramp, 113.5, a.data(), b.data());
            ASSERT_EQ(0, std::memcmp(a.data(), row_re.data(), 4 * (n + 1))) << isa_name(isa);
            ASSERT_EQ(0, std::memcmp(b.data(), row_im.data(), 4 * (n + 1))) << isa_name(isa);
        }
    }
}

/// Two terms: [-3, 2) and a pair of intervals.
struct Boxes {
    std::vector<std::int32_t> begin{0, 1, 3, 4};
    std::vector<double> x0{-3, 10.5, -400, 511.5}, x1{2, 11.5, -100, 512};
    std::vector<float> weight{1, -0.5f, 0.25f, 2};
    BoxTerms view() const { return {begin.data(), x0.data(), x1.data(), weight.data(), 3}; }
};

TEST(BoxPanel, IntegralsOverIntervalsHoweverSmallTheFrequency) {
    const Boxes boxes;
    for (const FrequencyRamp ramp :
         {FrequencyRamp{0, 1e-12, 16}, FrequencyRamp{-1.0 / 64, 1.0 / 512, 16}, FrequencyRamp{-8, 1, 16},
          FrequencyRamp{0.4, 1e-7, 16}, FrequencyRamp{3e5, 0.1, 16}, FrequencyRamp{0, 1e-310, 16}}) {
        float re[48], im[48];
        ref::box_panel(ramp, 0, boxes.view(), re, im);
        for (int l = 0; l < 16; ++l) {
            const double u = ramp.first + l * ramp.step;
            for (std::size_t k = 0; k < 3; ++k) {
                Complex truth = 0;
                double size = 0;
                for (auto r = static_cast<std::size_t>(boxes.begin[k]);
                     r < static_cast<std::size_t>(boxes.begin[k + 1]); ++r) {
                    const double width = boxes.x1[r] - boxes.x0[r],
                                 weight = static_cast<double>(boxes.weight[r]);
                    truth += weight * width * far_field_reference::sinc(u * width) *
                             far_field_reference::turn(u * (boxes.x0[r] + boxes.x1[r]) * 0.5);
                    size += std::fabs(weight) * width;
                }
                const std::size_t at = 16 * k + static_cast<std::size_t>(l);
                EXPECT_LT(std::abs(Complex(re[at], im[at]) - truth), 3e-7 * size)
                    << "u " << u << " term " << k;
            }
        }
    }
}

TEST(BoxPanel, ZeroFrequencyGivesTheExactWidth) {
    const Boxes boxes;
    float re[48], im[48];
    ref::box_panel({0, 1, 16}, 0, boxes.view(), re, im);
    EXPECT_EQ(re[0], 5.0f);
    EXPECT_EQ(re[16], 74.5f);
    EXPECT_EQ(re[32], 1.0f);
    EXPECT_EQ(im[0], 0.0f);
}

TEST(BoxPanel, KernelsGiveTheBitsOfRef) {
    const Boxes boxes;
    for (const FrequencyRamp ramp : {FrequencyRamp{0, 1.0 / 1024, 16}, FrequencyRamp{-70.25, 0.013, 16}}) {
        float re[48], im[48];
        ref::box_panel(ramp, 5, boxes.view(), re, im);
        for (const Isa isa : supported_isas()) {
            float a[48], b[48];
            OBSCURA_DISPATCH(isa, box_panel, ramp, 5, boxes.view(), a, b);
            EXPECT_EQ(0, std::memcmp(a, re, sizeof a)) << isa_name(isa);
            EXPECT_EQ(0, std::memcmp(b, im, sizeof b)) << isa_name(isa);
        }
    }
}

}  // namespace
}  // namespace obscura
