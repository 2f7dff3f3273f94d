// The row loops of the solvers: every instruction set gives the bits of ref; restriction is the transpose of
// interpolation.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "core/isa.h"
#include "stereo/solver/grid_plane.h"
#include "stereo/solver/grid_restrict.h"
#include "stereo/solver/grid_rows.h"
#include "stereo/thesis/half_rows.h"

namespace obscura {
namespace {

/// A plane of random numbers; a tenth of them are 0.
GridPlane random_plane(int width, int height, std::uint32_t seed, float low = -1, float high = 1) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(low, high);
    GridPlane plane(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            plane.row(y)[x] = random() % 10 == 0 ? 0.0f : value(random);
    }
    return plane;
}

std::vector<float> row_of(const float* row, int count) {
    return {row, row + count};
}

/// Everything that all loops write for one set of inputs.
std::vector<float> all_outputs(Isa isa, int width, bool uniform, bool scaled) {
    const int count = row_count(width);
    const GridPlane r = random_plane(width, 1, 1), q = random_plane(width, 1, 2);
    const GridPlane relax = random_plane(width, 1, 3, 0, 1), scale = random_plane(width, 1, 4, 0, 2);
    const GridPlane diagonal = random_plane(width, 1, 5, 4, 9), z = random_plane(width, 3, 6);
    const GridPlane right = random_plane(width, 1, 7, 0, 2), down = random_plane(width, 2, 8, 0, 2);
    RowEdges edges{2.0f, nullptr, nullptr, nullptr};
    if (!uniform) edges = {0.0f, right.row(0), down.row(0), down.row(1)};
    const RowTriple rows{z.row(0), z.row(1), z.row(2)};
    const float* factor = scaled ? scale.row(0) : nullptr;

    std::vector<float> out;
    const auto keep = [&](const float* row, int n) {
        const std::vector<float> values = row_of(row, n);
        out.insert(out.end(), values.begin(), values.end());
    };
    GridPlane a(width + 32, 1), b(width + 32, 1), x = random_plane(width, 1, 9);
    LaneSums sums;
    OBSCURA_DISPATCH(isa, update_row, r.row(0), q.row(0), 0.37f, relax.row(0), count, a.row(0), b.row(0));
    keep(a.row(0), count);
    keep(b.row(0), count);
    OBSCURA_DISPATCH(isa, relax_row, r.row(0), relax.row(0), count, a.row(0));
    keep(a.row(0), count);
    OBSCURA_DISPATCH(isa, residual_row, r.row(0), rows, edges, relax.row(0), factor, 0.2f, count, a.row(0));
    keep(a.row(0), count);
    OBSCURA_DISPATCH(isa, correct_row, r.row(0), q.row(0), relax.row(0), factor, count, a.row(0));
    keep(a.row(0), count);
    OBSCURA_DISPATCH(isa, smooth_row, r.row(0), rows, edges, relax.row(0), 0.2f, count, a.row(0), sums);
    keep(a.row(0), count);
    keep(sums.dot, 16);
    OBSCURA_DISPATCH(isa, direction_row, r.row(0), q.row(0), 0.7f, 1.3f, count, x.row(0), a.row(0));
    keep(a.row(0), count);
    keep(x.row(0), count);
    OBSCURA_DISPATCH(isa, apply_row, rows, edges, diagonal.row(0), relax.row(0), count, a.row(0), sums);
    keep(a.row(0), count);
    keep(sums.dot, 16);
    keep(sums.square, 16);
    keep(sums.largest, 16);
    std::vector<std::uint16_t> half(static_cast<std::size_t>(count));
    const GridPlane wide = random_plane(width, 1, 12, -70000, 70000),
                    small = random_plane(width, 1, 13, -1e-4f, 1e-4f);
    for (const float* row : {wide.row(0), small.row(0), r.row(0)}) {
        OBSCURA_DISPATCH(isa, half_row, row, count, half.data());
        OBSCURA_DISPATCH(isa, float_row, half.data(), count, a.row(0));
        keep(a.row(0), count);
    }
    const int coarse = (width + 1) / 2;
    const GridPlane fine = random_plane(width, 4, 10), other = random_plane(coarse, 2, 11);
    GridPlane scratch(width + 32, 1), result(width + 32, 1);
    const float* const sources[4] = {fine.row(0), fine.row(1), fine.row(2), fine.row(3)};
    OBSCURA_DISPATCH(isa, restrict_row, sources, width, coarse, scratch.row(0), result.row(0));
    keep(result.row(0), row_count(coarse));
    OBSCURA_DISPATCH(isa, prolong_row, other.row(0), other.row(1), width, coarse, scratch.row(0),
                     result.row(0));
    keep(result.row(0), 2 * row_count(coarse));
    return out;
}

TEST(GridRows, EveryInstructionSetGivesTheBitsOfRef) {
    for (const int width : {1, 2, 7, 15, 16, 17, 31, 32, 33, 100}) {
        for (const bool uniform : {false, true}) {
            for (const bool scaled : {false, true}) {
                const std::vector<float> expected = all_outputs(Isa::ref, width, uniform, scaled);
                for (const Isa isa : supported_isas()) {
                    const std::vector<float> actual = all_outputs(isa, width, uniform, scaled);
                    ASSERT_EQ(actual.size(), expected.size());
                    for (std::size_t i = 0; i < actual.size(); ++i) {
                        ASSERT_EQ(std::memcmp(&actual[i], &expected[i], sizeof(float)), 0)
                            << isa_name(isa) << ", width " << width << ", value " << i << ": " << actual[i]
                            << ", not " << expected[i];
                    }
                }
            }
        }
    }
}

TEST(GridRows, HalfFloatsAreTheNearest) {
    // Every finite half comes back as itself; what lies between two goes to the nearer, ties to the even one.
    std::vector<std::uint16_t> all(63488), again(63488);
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i] = static_cast<std::uint16_t>(i < 31744 ? i : 32768 + (i - 31744));
    std::vector<float> wide(all.size());
    ref::float_row(all.data(), static_cast<int>(all.size()), wide.data());
    ref::half_row(wide.data(), static_cast<int>(all.size()), again.data());
    EXPECT_EQ(all, again);
    EXPECT_EQ(wide[0x3c00], 1.0f);
    EXPECT_EQ(wide[0x5140], 42.0f);
    EXPECT_EQ(wide[1], 0x1p-24f);
    EXPECT_EQ(wide[0x7bff], 65504.0f);
    for (std::size_t i = 1; i + 1 < 31744; ++i) {
        const float middle = 0.5f * (wide[i] + wide[i + 1]);
        alignas(64) float in[16] = {middle, std::nextafter(middle, 0.0f), std::nextafter(middle, 1e9f)};
        alignas(64) std::uint16_t out[16];
        ref::half_row(in, 16, out);
        ASSERT_EQ(out[0], i % 2 == 0 ? i : i + 1) << i;
        // Below 2^-14 the product with 2^-112 has few bits itself: ties there may be taken for ties twice.
        if (i < 1024) continue;
        ASSERT_EQ(out[1], i);
        ASSERT_EQ(out[2], i + 1);
    }
}

double dot(const GridPlane& a, const GridPlane& b) {
    double sum = 0;
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x)
            sum += static_cast<double>(a.row(y)[x]) * static_cast<double>(b.row(y)[x]);
    }
    return sum;
}

GridPlane restricted(const GridPlane& fine) {
    GridPlane coarse((fine.width() + 1) / 2, (fine.height() + 1) / 2), scratch(fine.width() + 32, 1);
    const GridPlane zeros(fine.width(), 1);
    for (int Y = 0; Y < coarse.height(); ++Y) {
        const float* sources[4];
        restrict_sources(
            Y, fine.height(), zeros.row(0), [&](int y) { return fine.row(y); }, sources);
        ref::restrict_row(sources, fine.width(), coarse.width(), scratch.row(0), coarse.row(Y));
    }
    return coarse;
}

GridPlane prolonged(const GridPlane& coarse, int width, int height) {
    GridPlane fine(width, height), row(width + 32, 1), scratch(coarse.width() + 32, 1);
    for (int y = 0; y < height; ++y) {
        ref::prolong_row(coarse.row(y / 2), coarse.row(other_coarse_row(y, coarse.height())), width,
                         coarse.width(), scratch.row(0), row.row(0));
        std::copy_n(row.row(0), width, fine.row(y));
    }
    return fine;
}

TEST(GridRows, RestrictionIsTheTransposeOfInterpolation) {
    const int sizes[][2] = {{1, 1}, {2, 1}, {3, 5}, {16, 9}, {17, 16}, {33, 12}, {40, 31}, {63, 64}};
    for (const auto& [width, height] : sizes) {
        const GridPlane fine = random_plane(width, height, 21);
        const GridPlane coarse = random_plane((width + 1) / 2, (height + 1) / 2, 22);
        const double expected = dot(fine, prolonged(coarse, width, height));
        EXPECT_NEAR(dot(restricted(fine), coarse), expected, 1e-5 * (1 + std::abs(expected)))
            << width << " x " << height;
    }
}

TEST(GridRows, InterpolationKeepsConstantsAndLines) {
    const int width = 41, height = 30;
    GridPlane coarse((width + 1) / 2, (height + 1) / 2);
    for (int y = 0; y < coarse.height(); ++y) {
        for (int x = 0; x < coarse.width(); ++x)
            coarse.row(y)[x] = 1.0f + 0.5f * static_cast<float>(x) - 0.25f * static_cast<float>(y);
    }
    const GridPlane fine = prolonged(coarse, width, height);
    // Coarse cell X has its centre at fine position 2 X + 1/2. Borders repeat, so only the inside is a line.
    for (int y = 1; y + 2 < height; ++y) {
        for (int x = 1; x + 2 < width; ++x) {
            const double u = (x - 0.5) / 2, v = (y - 0.5) / 2;
            EXPECT_NEAR(static_cast<double>(fine.row(y)[x]), 1.0 + 0.5 * u - 0.25 * v, 1e-5);
        }
    }
    GridPlane ones((width + 1) / 2, (height + 1) / 2);
    for (int y = 0; y < ones.height(); ++y)
        std::fill_n(ones.row(y), ones.width(), 1.0f);
    const GridPlane kept = prolonged(ones, width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            EXPECT_EQ(kept.row(y)[x], 1.0f);
    }
}

}  // namespace
}  // namespace obscura
