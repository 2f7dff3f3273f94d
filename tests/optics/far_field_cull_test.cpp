// Culling: nothing bright is missed, what is kept is bit for bit what it was, and values alone would not do.

#include "optics/far_field_cull.h"

#include <gtest/gtest.h>

#include <cstring>

#include "optics/far_field_methods.h"
#include "tests/optics/far_field_reference.h"

namespace obscura {
namespace {

using namespace far_field_reference;

/// Largest |F| of every block.
std::vector<float> block_peaks(const Field& field) {
    const int columns = (field.re.width + 7) / 8, rows = (field.re.height + 7) / 8;
    std::vector<float> peaks(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (int y = 0; y < field.re.height; ++y) {
        for (int x = 0; x < field.re.width; ++x) {
            const float magnitude = std::hypot(field.re(x, y), field.im(x, y));
            float& peak = peaks[static_cast<std::size_t>(y / 8 * columns + x / 8)];
            peak = std::max(peak, magnitude);
        }
    }
    return peaks;
}

struct Missed {
    int bright = 0, missed = 0;
};
Missed count_missed(const std::vector<float>& peaks, const BlockSet& blocks, double amplitude) {
    Missed count;
    for (std::size_t b = 0; b < peaks.size(); ++b) {
        if (static_cast<double>(peaks[b]) <= amplitude) continue;
        ++count.bright;
        count.missed += blocks.active[b] == 0 ? 1 : 0;
    }
    return count;
}

TEST(FarFieldCull, MissesNoBrightBlockWhereValuesAloneMissMany) {
    for (const int size : {512, 1024}) {
        for (const NamedMask& shape : four_shapes(size / 2)) {
            const FrequencyGrid grid = half_grid(size, size, 1.0 / size);
            const SeparableTerms terms = separable_terms(shape.mask.view());
            Field field = field_for(grid);
            separable_field(terms, grid, {}, target_of(field), Exec{});
            const std::vector<float> peaks = block_peaks(field);
            for (const double cull : {1e-4, 1e-6}) {
                const double amplitude = std::sqrt(cull) * open_area(shape.mask.view());
                const Missed both = count_missed(
                    peaks, bright_blocks(terms, grid, amplitude, CullTest::with_neighbours, Exec{}),
                    amplitude);
                EXPECT_EQ(both.missed, 0)
                    << shape.name << " " << size << " " << cull << " of " << both.bright;
                const Missed value = count_missed(
                    peaks, bright_blocks(terms, grid, amplitude, CullTest::value, Exec{}), amplitude);
                EXPECT_GE(value.missed * 3, value.bright) << shape.name << " " << size << " " << cull;
            }
        }
    }
}

TEST(FarFieldCull, KeepsBrightBlocksBitForBitAndClearsTheRest) {
    const Image<float> mask = four_shapes(100)[3].mask;
    for (const FrequencyGrid& grid :
         {half_grid(203, 161, 1.0 / 200), centred_grid(90, 77, 1.0 / 333, 0.02, -0.03)}) {
        Field full = field_for(grid);
        far_field_edges(mask.view(), grid, 0, target_of(full), Exec{}, nullptr);
        const BlockSet blocks =
            bright_blocks(separable_terms(mask.view()), grid, 0.1 * open_area(mask.view()),
                          CullTest::with_neighbours, Exec{});
        for (const Isa isa : supported_isas()) {
            Field culled{Image<float>(grid.width, grid.height, 7.0f),
                         Image<float>(grid.width, grid.height, 7.0f)};
            Image<float> power(grid.width, grid.height, 7.0f);
            FieldTarget target = target_of(culled);
            target.power = power.pixels.data();
            FarFieldReport report;
            far_field_edges(mask.view(), grid, 0.01, target, {isa, 2}, &report);
            EXPECT_EQ(report.blocks, static_cast<std::int64_t>(blocks.active.size()));
            EXPECT_EQ(report.active_blocks, active_count(blocks));
            EXPECT_GT(report.active_blocks, 0);
            EXPECT_LT(report.active_blocks, report.blocks);
            for (int y = 0; y < grid.height; ++y) {
                for (int x = 0; x < grid.width; ++x) {
                    const bool kept =
                        blocks.active[static_cast<std::size_t>(y / 8 * blocks.columns + x / 8)] != 0;
                    ASSERT_EQ(culled.re(x, y), kept ? full.re(x, y) : 0.0f) << x << ", " << y;
                    ASSERT_EQ(culled.im(x, y), kept ? full.im(x, y) : 0.0f) << x << ", " << y;
                    const float p = culled.re(x, y) * culled.re(x, y) + culled.im(x, y) * culled.im(x, y);
                    ASSERT_EQ(power(x, y), p);
                }
            }
        }
    }
}

TEST(FarFieldCull, SlopesAreTheDerivatives) {
    const Image<float> mask = four_shapes(64)[2].mask;
    const SeparableTerms terms = separable_terms(mask.view());
    const double area = open_area(mask.view());
    for (const FrequencyGrid& grid : all_grids(64)) {
        const double h = 1e-7;
        std::vector<double> u, v, more_u, more_v;
        for (int x = 0; x < grid.width; ++x) {
            u.push_back(grid.first_u + x * grid.step_u);
            more_u.push_back(u.back() + h);
        }
        for (int y = 0; y < grid.height; ++y) {
            v.push_back(grid.first_v + y * grid.step_v);
            more_v.push_back(v.back() + h);
        }
        const std::vector<Complex> at = far_field_at(mask.view(), u, v);
        for (const Slope slope : {Slope::u, Slope::v}) {
            const bool by_u = slope == Slope::u;
            const std::vector<Complex> next =
                by_u ? far_field_at(mask.view(), more_u, v) : far_field_at(mask.view(), u, more_v);
            Field ours = field_for(grid);
            SeparableParams params;
            params.slope = slope;
            separable_field(terms, grid, params, target_of(ours), Exec{});
            const double step = by_u ? grid.step_u : grid.step_v;
            for (std::size_t i = 0; i < at.size(); ++i) {
                const Complex truth = (next[i] - at[i]) * (step / h);
                const Complex got(static_cast<double>(ours.re.pixels[i]),
                                  static_cast<double>(ours.im.pixels[i]));
                // 2 pi times the mask's half width is the largest slope there can be.
                ASSERT_LT(std::abs(got - truth), 1e-4 * 2 * M_PI * 32 * step * area) << i;
            }
            for (const Isa isa : supported_isas()) {
                Field other = field_for(grid);
                separable_field(terms, grid, params, target_of(other), {isa, 2});
                ASSERT_EQ(0, std::memcmp(other.re.pixels.data(), ours.re.pixels.data(), 4 * at.size()));
                ASSERT_EQ(0, std::memcmp(other.im.pixels.data(), ours.im.pixels.data(), 4 * at.size()));
            }
        }
    }
}

}  // namespace
}  // namespace obscura
