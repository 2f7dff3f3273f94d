// Systems whose pixels do not all hang together, against conjugate gradients on the whole of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "stereo/solver/solver.h"
#include "stereo/solver/system_parts.h"
#include "stereo/solver/thin_trees.h"
#include "stereo/thesis/cascade.h"
#include "tests/stereo/small_solver.h"

namespace obscura {
namespace {

/// Islands of one pixel to several hundred, each with a gradient of its own; some anchored.
DisparitySystem islands() {
    const int width = 90, height = 40;
    DisparityMap d(width, height);
    Image<std::uint8_t> valid(width, height, 0);
    const auto paint = [&](int x0, int y0, int x1, int y1) {
        for (int y = y0; y < y1; ++y) {
            for (int x = x0; x < x1; ++x) {
                valid(x, y) = 1;
                d(x, y) = 0.3f * static_cast<float>(x) - 0.2f * static_cast<float>(y);
            }
        }
    };
    paint(2, 2, 40, 30);
    paint(50, 3, 65, 20);
    paint(70, 5, 76, 10);
    paint(80, 8, 81, 9);
    paint(84, 30, 86, 31);
    paint(41, 30, 42, 31);  // at a corner of the first: no edge between them
    DisparitySystem s = unedited_system(d, valid);
    s.epsilon = 1e-3f;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            s.gradient_x(x, y) *= 1.5f;
            if (x > 60 && y < 8 && valid(x, y) != 0) {
                s.anchor_weight(x, y) = 0.5f;
                s.anchor_value(x, y) = d(x, y) - 4;
            }
        }
    }
    return s;
}

MatchingSet pixels_follow(int source_x, int source_y, std::vector<MatchedPixel> members) {
    return {"follow", source_x, source_y, 2.0f, std::move(members)};
}

double worst(const DisparitySystem& s, const DisparityMap& x) {
    const Image<double> exact = small_minimiser(s);
    double most = 0;
    for (std::size_t i = 0; i < x.pixels.size(); ++i)
        most = std::max(most, std::abs(static_cast<double>(x.pixels[i]) - exact.pixels[i]));
    return most;
}

SolverParams tight() {
    SolverParams p;
    p.tolerance_max_px = p.tolerance_rms_px = 1e-4;
    return p;
}

TEST(SystemParts, AreIslandsAndWhatSetsTieTogether) {
    DisparitySystem s = islands();
    SystemParts parts = system_parts(s);
    ASSERT_EQ(parts.parts.size(), 6u);
    EXPECT_EQ(parts.parts[0].pixels, 38 * 28);
    EXPECT_EQ(parts.parts[5].pixels, 1);
    s.sets = {pixels_follow(80, 8, {{84, 30, 1}, {70, 5, 2}})};
    parts = system_parts(s);
    EXPECT_EQ(parts.parts.size(), 4u);
}

TEST(SystemParts, AreSolvedEachByItself) {
    DisparitySystem s = islands();
    EXPECT_LT(worst(s, solve(s, tight(), {}).disparity), 1e-3);
    // Three small islands as one: a source far from its members, and one that is a member, too.
    s.sets = {pixels_follow(80, 8, {{70, 5, 2}, {84, 30, 1}}), pixels_follow(84, 30, {{71, 6, 3}})};
    const Solution solution = solve(s, tight(), {});
    EXPECT_TRUE(solution.report.converged);
    EXPECT_LT(worst(s, solution.disparity), 1e-3);
    const SystemParts parts = system_parts(s);
    DisparityMap x = s.start;
    for (const SystemPart& part : parts.parts) {
        if (part.pixels <= small_part) minimise_part(s, parts, part, x);
    }
    for (const SystemPart& part : parts.parts) {
        if (part.pixels > small_part) continue;
        for (std::size_t i = 0; i < x.pixels.size(); ++i) {
            if (parts.label.pixels[i] != part.label || s.valid.pixels[i] == 0) continue;
            EXPECT_EQ(x.pixels[i], solution.disparity.pixels[i]);
        }
    }
}

TEST(SystemParts, SameBitsForAnyThreads) {
    DisparitySystem s = islands();
    s.sets = {pixels_follow(80, 8, {{84, 30, 1}, {70, 5, 2}})};
    const DisparityMap one = solve(s, {}, {Isa::ref, 1}).disparity;
    for (const Isa isa : supported_isas())
        EXPECT_EQ(solve(s, {}, {isa, 3}).disparity, one);
}

TEST(SystemParts, EstimatesCountPixelsOfTheSystemAlone) {
    // An L of few pixels in a large window: what is not valid there must not make its error look smaller.
    DisparitySystem s = islands();
    std::fill(s.valid.pixels.begin(), s.valid.pixels.end(), std::uint8_t{0});
    std::fill_n(s.valid.row(38), 90, std::uint8_t{1});
    std::fill_n(s.valid.row(39), 90, std::uint8_t{1});
    for (int y = 0; y < 40; ++y)
        std::fill_n(s.valid.row(y), 3, std::uint8_t{1});
    SolverParams p;
    p.max_iterations = 1;
    const Solution step = solve(s, p, {});
    double sum = 0, largest = 0, count = 0;
    for (std::size_t i = 0; i < s.valid.pixels.size(); ++i) {
        if (s.valid.pixels[i] == 0) continue;
        const double way = static_cast<double>(step.disparity.pixels[i] - s.start.pixels[i]);
        sum += way * way;
        largest = std::max(largest, std::abs(way));
        count += 1;
    }
    EXPECT_GT(largest, 0.1);
    EXPECT_NEAR(step.report.error_rms_px / step.report.error_max_px, std::sqrt(sum / count) / largest, 1e-3);
}

TEST(DisparityEnergy, LeavesOutSetsOfPixelsThatAreNotValid) {
    DisparitySystem s = islands();
    s.sets = {pixels_follow(80, 8, {{70, 5, 2}})};
    const double whole = energy(s, s.start);
    s.sets[0].members.push_back({0, 0, 50});              // nothing is seen there
    s.sets.push_back(pixels_follow(0, 1, {{3, 3, 90}}));  // nor at this source
    EXPECT_EQ(energy(s, s.start), whole);
}

TEST(Cascade, TellsHowFarItIsFromTheMinimiser) {
    const DisparitySystem s = islands();
    const Solution solution = solve_cascade(s, {}, {});
    EXPECT_FALSE(solution.report.converged);
    const double error = worst(s, solution.disparity);
    EXPECT_GT(error, 0.2);
    EXPECT_NEAR(solution.report.error_max_px, error, 0.1);
    EXPECT_GT(solution.report.error_rms_px, 0);
    EXPECT_LT(solution.report.error_rms_px, solution.report.error_max_px);
}

/// A block with random twigs of one pixel, some anchored, some in a matching set.
DisparitySystem twigs(unsigned seed) {
    std::mt19937 random(seed);
    const int width = 60, height = 50;
    DisparityMap d(width, height);
    Image<std::uint8_t> valid(width, height, 0);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            d(x, y) = 0.2f * static_cast<float>(x) + 0.1f * static_cast<float>(y);
            valid(x, y) = y >= 40 ? 1 : 0;
        }
    }
    for (int twig = 0; twig < 9; ++twig) {
        int x = 3 + 6 * twig;
        for (int y = 39; y > 2; --y) {
            valid(x, y) = 1;
            if (random() % 6 != 0) continue;
            x = std::clamp(x + (random() % 2 == 0 ? 1 : -1), 1, width - 2);
            valid(x, y) = 1;
        }
    }
    DisparitySystem s = unedited_system(d, valid);
    s.epsilon = 1e-3f;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            s.gradient_x(x, y) *= 1.5f;
            if (valid(x, y) == 0 || random() % 5 != 0) continue;
            s.anchor_weight(x, y) = 0.3f;
            s.anchor_value(x, y) = d(x, y) + static_cast<float>(random() % 8);
        }
    }
    return s;
}

TEST(ThinTrees, AreTakenOutAndPutBackExactly) {
    std::size_t taken = 0;
    for (unsigned seed = 0; seed < 6; ++seed) {
        DisparitySystem s = twigs(seed);
        if (seed % 2 == 1) {
            // The middle of a twig stays, and what lies between it and the block.
            for (int x = 0; x < s.width(); ++x) {
                if (s.valid(x, 20) != 0) s.sets.push_back(pixels_follow(x, 20, {{30, 45, 1.5f}}));
            }
        }
        const std::optional<WithoutTrees> thin = without_trees(s);
        ASSERT_TRUE(thin);
        taken += thin->pixels.size();
        for (const TreePixel& p : thin->pixels) {
            EXPECT_EQ(thin->rest.valid(p.x, p.y), 0);
            EXPECT_LT(p.y, seed % 2 == 1 ? 20 : 40);
        }
        EXPECT_LT(worst(s, solve(s, tight(), {}).disparity), 1e-3) << seed;
    }
    EXPECT_GT(taken, 500u);
}

TEST(ThinTrees, OfAFewPixelsStay) {
    EXPECT_FALSE(without_trees(islands()));
    DisparitySystem s = islands();
    for (int y = 30; y < 36; ++y)
        s.valid(20, y) = 1;
    EXPECT_FALSE(without_trees(s));
    for (int y = 36; y < 38; ++y)
        s.valid(20, y) = 1;
    EXPECT_EQ(without_trees(s)->pixels.size(), 8u);
}

}  // namespace
}  // namespace obscura
