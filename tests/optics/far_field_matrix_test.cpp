// The far field by sums and matrix products: every strategy against the double-precision texel sum.

#include <gtest/gtest.h>

#include <cstring>

#include "optics/far_field_methods.h"
#include "optics/field/natural_grid.h"
#include "optics/field/separable_terms.h"
#include "optics/thesis/far_field.h"
#include "tests/optics/far_field_reference.h"

namespace obscura {
namespace {

using namespace far_field_reference;

constexpr double tolerance = 1e-6;

/// `run(mask, grid, target, exec)` over shapes, odd masks and grids.
template <class Run>
void expect_exact(Run&& run) {
    std::vector<NamedMask> masks = odd_masks();
    for (NamedMask& shape : four_shapes(64))
        masks.push_back(std::move(shape));
    for (const NamedMask& m : masks) {
        for (const FrequencyGrid& grid : all_grids(m.mask.width)) {
            Field field = field_for(grid);
            run(m.mask.view(), grid, target_of(field), Exec{best_isa(), 2});
            EXPECT_LT(worst_error(field, m.mask.view(), grid, open_area(m.mask.view())), tolerance)
                << m.name << ", " << grid.width << " x " << grid.height << " from " << grid.first_u;
        }
    }
}

/// The same bits from every instruction set and number of threads.
template <class Run>
void expect_same_bits(Run&& run) {
    const Image<float> mask = four_shapes(60)[3].mask;
    for (const FrequencyGrid& grid : all_grids(60)) {
        Field first = field_for(grid);
        run(mask.view(), grid, target_of(first), Exec{Isa::ref, 1});
        for (const Isa isa : supported_isas()) {
            for (const int threads : {1, 2, 5}) {
                Field other = field_for(grid);
                run(mask.view(), grid, target_of(other), Exec{isa, threads});
                EXPECT_EQ(0, std::memcmp(first.re.pixels.data(), other.re.pixels.data(),
                                         first.re.pixels.size() * sizeof(float)))
                    << isa_name(isa) << ", " << threads << " threads";
                EXPECT_EQ(0, std::memcmp(first.im.pixels.data(), other.im.pixels.data(),
                                         first.im.pixels.size() * sizeof(float)))
                    << isa_name(isa) << ", " << threads << " threads";
            }
        }
    }
}

void direct(ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target,
            const Exec& exec) {
    far_field_direct(texel_quads(mask), grid, target, exec);
}

TEST(FarFieldDirect, IsExact) {
    expect_exact(direct);
}
TEST(FarFieldDirect, SameBitsEverywhere) {
    expect_same_bits(direct);
}

void gemm(ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target,
          const Exec& exec) {
    far_field_gemm(texel_quads(mask), grid, target, exec);
}
void edges(ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target,
           const Exec& exec) {
    far_field_edges(mask, grid, 0, target, exec, nullptr);
}

void shift(ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target,
           const Exec& exec) {
    far_field_shift(tree_quads(mask), grid, target, exec);
}
void levels(ImageView<const float> mask, const FrequencyGrid& grid, const FieldTarget& target,
            const Exec& exec) {
    if (natural_grid(mask.width, mask.height, grid)) {
        far_field_levels(tree_quads(mask), grid, target, exec);
    } else {
        EXPECT_THROW(far_field_levels(tree_quads(mask), grid, target, exec), InputError);
        far_field_gemm(tree_quads(mask), grid, target, exec);
    }
}

TEST(FarFieldShift, IsExact) {
    expect_exact(shift);
}
TEST(FarFieldShift, SameBitsEverywhere) {
    expect_same_bits(shift);
}
TEST(FarFieldLevels, IsExact) {
    expect_exact(levels);
}
TEST(FarFieldLevels, SameBitsEverywhere) {
    expect_same_bits(levels);
}

/// Windows of a natural grid: many periods away, odd sizes, other periods in v than in u.
TEST(FarFieldLevels, WindowsAnywhereOnTheGrid) {
    std::vector<NamedMask> masks = odd_masks();
    for (NamedMask& shape : four_shapes(64))
        masks.push_back(std::move(shape));
    for (const NamedMask& m : masks) {
        for (const FrequencyGrid& grid : {FrequencyGrid{70, 31, -200.0 / 64, 77.0 / 128, 1.0 / 64, 1.0 / 128},
                                          FrequencyGrid{1, 300, 5, -150.0 / 64, 1.0 / 64, 1.0 / 64}}) {
            ASSERT_TRUE(natural_grid(m.mask.width, m.mask.height, grid)) << m.name;
            Field field = field_for(grid);
            far_field_levels(tree_quads(m.mask.view()), grid, target_of(field), Exec{});
            EXPECT_LT(worst_error(field, m.mask.view(), grid, open_area(m.mask.view())), tolerance) << m.name;
        }
    }
}

TEST(FarFieldGemm, IsExact) {
    expect_exact(gemm);
}
TEST(FarFieldGemm, SameBitsEverywhere) {
    expect_same_bits(gemm);
}
TEST(FarFieldEdges, IsExact) {
    expect_exact(edges);
}
TEST(FarFieldEdges, SameBitsEverywhere) {
    expect_same_bits(edges);
}

TEST(SeparableTerms, GiveTheMaskBack) {
    std::vector<NamedMask> masks = odd_masks();
    for (NamedMask& shape : four_shapes(64))
        masks.push_back(std::move(shape));
    for (const NamedMask& m : masks) {
        for (const SeparableTerms& terms : {distinct_columns(m.mask.view()), distinct_rows(m.mask.view())}) {
            Image<float> sum(m.mask.width, m.mask.height);
            for (std::size_t k = 0; k < static_cast<std::size_t>(terms.count()); ++k) {
                for (auto j = static_cast<std::size_t>(terms.y.begin[k]);
                     j < static_cast<std::size_t>(terms.y.begin[k + 1]); ++j) {
                    for (auto i = static_cast<std::size_t>(terms.x.begin[k]);
                         i < static_cast<std::size_t>(terms.x.begin[k + 1]); ++i) {
                        const double cx = sum.width * 0.5, cy = sum.height * 0.5;
                        for (int y = static_cast<int>(terms.y.x0[j] + cy);
                             y < static_cast<int>(terms.y.x1[j] + cy); ++y) {
                            for (int x = static_cast<int>(terms.x.x0[i] + cx);
                                 x < static_cast<int>(terms.x.x1[i] + cx); ++x)
                                sum(x, y) += terms.x.weight[i] * terms.y.weight[j];
                        }
                    }
                }
            }
            EXPECT_EQ(sum, m.mask) << m.name;
        }
    }
}

TEST(SeparableTerms, RepeatedColumnsCountOnce) {
    const std::vector<NamedMask> shapes = four_shapes(64);
    EXPECT_EQ(separable_terms(shapes[0].mask.view()).count(), 1);
    const Image<float> grating = mask_where(
        90, 30, [](double x, double y) { return std::fmod(x + 100, 10) < 5 && std::fabs(y) < 11; });
    EXPECT_EQ(separable_terms(grating.view()).count(), 1);
    // A disc's columns come in pairs.
    EXPECT_LE(separable_terms(shapes[1].mask.view()).count(), 26);
    EXPECT_EQ(separable_terms(Image<float>(9, 9).view()).count(), 0);
}

}  // namespace
}  // namespace obscura
