// Layouts of a pair: sizes, places, light.
#include <gtest/gtest.h>

#include <cmath>

#include "stereo/layout.h"

namespace obscura {
namespace {

using Picture = Image<Vec3f>;

/// Every pixel and channel differs.
Picture ramp(int width, int height, float from) {
    Picture p(width, height);
    float value = from;
    for (Vec3f& c : p.pixels) {
        c = {value, value + 0.003f, value + 0.006f};
        value += 0.01f;
    }
    return p;
}

Vec3d mean(const Picture& p) {
    Vec3d sum;
    for (const Vec3f& c : p.pixels)
        sum = sum + to_double(c);
    return sum * (1.0 / static_cast<double>(p.pixels.size()));
}

TEST(StereoLayout, NamesGoBothWays) {
    EXPECT_EQ(layout_names().size(), 12u);
    for (const std::string_view name : layout_names()) {
        const auto layout = parse_layout(name);
        ASSERT_TRUE(layout) << name;
        EXPECT_EQ(layout_name(*layout), name);
    }
    EXPECT_EQ(parse_layout("half-side-by-side"), StereoLayout::half_side_by_side);
    EXPECT_EQ(parse_layout("anaglyph-dubois"), StereoLayout::anaglyph_dubois);
    EXPECT_FALSE(parse_layout("Anaglyph"));
    EXPECT_FALSE(parse_layout(""));
}

TEST(StereoLayout, FullLayoutsKeepEveryPixel) {
    const Picture l = ramp(5, 3, 0), r = ramp(5, 3, 0.5f);
    const Picture side = lay_out(l, r, StereoLayout::side_by_side);
    const Picture cross = lay_out(l, r, StereoLayout::cross_eye);
    const Picture over = lay_out(l, r, StereoLayout::over_under);
    ASSERT_EQ(side.width, 10);
    ASSERT_EQ(side.height, 3);
    ASSERT_EQ(over.width, 5);
    ASSERT_EQ(over.height, 6);
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 5; ++x) {
            EXPECT_EQ(side(x, y), l(x, y));
            EXPECT_EQ(side(5 + x, y), r(x, y));
            EXPECT_EQ(cross(x, y), r(x, y));
            EXPECT_EQ(cross(5 + x, y), l(x, y));
            EXPECT_EQ(over(x, y), l(x, y));
            EXPECT_EQ(over(x, 3 + y), r(x, y));
        }
    }
    EXPECT_EQ(lay_out(l, r, StereoLayout::left), l);
    EXPECT_EQ(lay_out(l, r, StereoLayout::right), r);
}

TEST(StereoLayout, InterlacedRows) {
    const Picture l = ramp(4, 5, 0), r = ramp(4, 5, 0.5f);
    const Picture p = lay_out(l, r, StereoLayout::interlaced);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 4; ++x)
            EXPECT_EQ(p(x, y), y % 2 == 0 ? l(x, y) : r(x, y));
}

TEST(StereoLayout, HalvesAverageLight) {
    const Picture l = ramp(4, 4, 0), r = ramp(4, 4, 0.5f);
    const Picture side = lay_out(l, r, StereoLayout::half_side_by_side);
    const Picture over = lay_out(l, r, StereoLayout::half_over_under);
    ASSERT_EQ(side.width, 4);
    ASSERT_EQ(side.height, 4);
    ASSERT_EQ(over.width, 4);
    ASSERT_EQ(over.height, 4);
    EXPECT_NEAR(side(1, 2).y, (l(2, 2).y + l(3, 2).y) / 2, 1e-7f);
    EXPECT_NEAR(side(2, 0).z, (r(0, 0).z + r(1, 0).z) / 2, 1e-7f);
    EXPECT_NEAR(over(3, 1).x, (l(3, 2).x + l(3, 3).x) / 2, 1e-7f);
    EXPECT_NEAR(over(0, 2).x, (r(0, 0).x + r(0, 1).x) / 2, 1e-7f);
}

TEST(StereoLayout, HalvesOfOddSidesAreExactBoxes) {
    const Picture l = ramp(5, 3, 0), r = ramp(5, 3, 0.5f);
    const Picture side = lay_out(l, r, StereoLayout::half_side_by_side);
    ASSERT_EQ(side.width, 5);  // three columns left, two right
    // 5 / 3 samples each: 1 + 2/3, 1/3 + 1 + 1/3, 2/3 + 1.
    EXPECT_NEAR(side(0, 1).x, (l(0, 1).x * 3 + l(1, 1).x * 2) / 5, 1e-6f);
    EXPECT_NEAR(side(1, 1).x, (l(1, 1).x + l(2, 1).x * 3 + l(3, 1).x) / 5, 1e-6f);
    EXPECT_NEAR(side(4, 1).x, (r(2, 1).x * 1 + r(3, 1).x * 2 + r(4, 1).x * 2) / 5, 1e-6f);
    const Picture over = lay_out(l, r, StereoLayout::half_over_under);
    ASSERT_EQ(over.height, 3);
    EXPECT_NEAR(over(2, 0).y, (l(2, 0).y * 2 + l(2, 1).y) / 3, 1e-6f);
    EXPECT_NEAR(over(2, 2).y, (r(2, 0).y + r(2, 1).y + r(2, 2).y) / 3, 1e-6f);
}

TEST(StereoLayout, HalvesKeepEnergy) {
    for (const int size : {1, 2, 3, 7, 64, 101}) {
        const Picture p = ramp(size, 3, 0.1f), q = ramp(3, size, 0.1f);
        // The same picture for both eyes: the mean of even sides stays; each odd half has its own mean.
        const Picture side = lay_out(p, p, StereoLayout::half_side_by_side);
        const Picture over = lay_out(q, q, StereoLayout::half_over_under);
        EXPECT_EQ(side.width, size);
        EXPECT_EQ(over.height, size);
        EXPECT_NEAR(mean(side).x, mean(p).x, 1e-6) << size;
        EXPECT_NEAR(mean(over).z, mean(q).z, 1e-6) << size;
    }
}

TEST(Anaglyph, TakesRedFromLeftAndTheRestFromRight) {
    const Picture l(3, 2, {0.9f, 0.2f, 0.1f}), r(3, 2, {0.3f, 0.5f, 0.7f});
    EXPECT_EQ(lay_out(l, r, StereoLayout::anaglyph)(1, 1), (Vec3f{0.9f, 0.5f, 0.7f}));
    const Vec3f half = lay_out(l, r, StereoLayout::anaglyph_half)(1, 1);
    EXPECT_NEAR(half.x, 0.2126 * 0.9 + 0.7152 * 0.2 + 0.0722 * 0.1, 1e-6);
    EXPECT_EQ(half.y, 0.5f);
    EXPECT_EQ(half.z, 0.7f);
}

TEST(Anaglyph, EqualGreysStayGrey) {
    for (const float g : {0.0f, 0.18f, 0.5f, 1.0f}) {
        const Picture p(2, 2, {g, g, g});
        EXPECT_EQ(lay_out(p, p, StereoLayout::anaglyph)(0, 1), (Vec3f{g, g, g}));
        for (const StereoLayout layout : {StereoLayout::anaglyph_half, StereoLayout::anaglyph_dubois}) {
            const Vec3f c = lay_out(p, p, layout)(1, 0);
            EXPECT_NEAR(c.x, g, 2e-6f);
            EXPECT_NEAR(c.y, g, 2e-6f);
            EXPECT_NEAR(c.z, g, 2e-6f);
        }
    }
}

TEST(Anaglyph, EqualPicturesKeepTheirColourInTheColourLayout) {
    const Picture p = ramp(6, 4, 0.1f);
    EXPECT_EQ(lay_out(p, p, StereoLayout::anaglyph), p);
}

TEST(Anaglyph, DuboisClipsAndKeepsEyesApart) {
    const Picture red(1, 1, {1, 0, 0}), black(1, 1), white(1, 1, {1, 1, 1});
    const Vec3f left_only = lay_out(white, black, StereoLayout::anaglyph_dubois)(0, 0);
    EXPECT_EQ(left_only.x, 1.0f);  // 1.13, clipped
    EXPECT_EQ(left_only.y, 0.0f);
    EXPECT_EQ(left_only.z, 0.0f);
    const Vec3f right_only = lay_out(black, white, StereoLayout::anaglyph_dubois)(0, 0);
    EXPECT_EQ(right_only.x, 0.0f);
    EXPECT_GT(right_only.y, 0.99f);
    EXPECT_EQ(right_only.z, 1.0f);
    EXPECT_NEAR(lay_out(red, black, StereoLayout::anaglyph_dubois)(0, 0).x, 0.4561f, 1e-6f);
}

/// Gauss, with the largest pivot first.
template <std::size_t N>
std::array<double, N> solve(std::array<std::array<double, N>, N> a, std::array<double, N> b) {
    for (std::size_t i = 0; i < N; ++i) {
        std::size_t best = i;
        for (std::size_t r = i + 1; r < N; ++r)
            if (std::abs(a[r][i]) > std::abs(a[best][i])) best = r;
        std::swap(a[i], a[best]);
        std::swap(b[i], b[best]);
        for (std::size_t r = i + 1; r < N; ++r) {
            const double f = a[r][i] / a[i][i];
            for (std::size_t c = i; c < N; ++c)
                a[r][c] -= f * a[i][c];
            b[r] -= f * b[i];
        }
    }
    for (std::size_t i = N; i-- > 0;) {
        for (std::size_t c = i + 1; c < N; ++c)
            b[i] -= a[i][c] * b[c];
        b[i] /= a[i][i];
    }
    return b;
}

// The matrix out of what it is made of: the XYZ of a CRT's phosphors, bare and through the two filters
// (Dubois 2001; Sanders and McAllister 2003), least squares, rows scaled to white.
TEST(Anaglyph, DuboisMatrixIsTheLeastSquaresSolution) {
    const double through[6][3] = {{5.42327, .807004, .047325},          {2.70972, .50201, .0250529},
                                  {.0000550941, .000411221, .00240686}, {.180431, 1.6395, 2.00309},
                                  {.448214, 6.31551, 1.35757},          {.289201, 2.3925, 11.062}};
    const double bare[3][3] = {
        {11.6638, 8.3959, 4.65843}, {7.10807, 16.6845, 2.45008}, {.527874, 3.79124, 24.0604}};
    std::array<std::array<double, 3>, 3> normal{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (const auto& row : through)
                normal[i][j] += row[i] * row[j];
    double matrix[3][6];
    for (std::size_t column = 0; column < 6; ++column) {
        // The wanted XYZ of both eyes when one channel of one picture is on.
        std::array<double, 3> right{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k)
                right[i] += through[(column < 3 ? 0 : 3) + k][i] * bare[k][column % 3];
        const std::array<double, 3> answer = solve(normal, right);
        for (std::size_t i = 0; i < 3; ++i)
            matrix[i][column] = answer[i];
    }
    for (std::size_t i = 0; i < 3; ++i) {
        double sum = 0, ours = 0;
        for (std::size_t c = 0; c < 6; ++c)
            sum += matrix[i][c];
        for (std::size_t c = 0; c < 6; ++c) {
            EXPECT_NEAR(dubois_matrix[i][c], matrix[i][c] / sum, 1e-7) << i << ' ' << c;
            ours += dubois_matrix[i][c];
        }
        EXPECT_NEAR(ours, 1, 1e-7);
    }
}

TEST(StereoLayout, RefusesWhatIsNoPicture) {
    const Picture a(2, 2), b(3, 2);
    EXPECT_DEATH(lay_out(a, b, StereoLayout::anaglyph), "");
    EXPECT_DEATH(lay_out(a, a, StereoLayout::separate), "two files");
}

}  // namespace
}  // namespace obscura
