// The solver against properties of the system: what needs no other solver to be known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "stereo/solver/conjugate_gradients.h"
#include "stereo/solver/full_multigrid.h"
#include "stereo/solver/solver.h"
#include "stereo/thesis/cascade.h"
#include "stereo/thesis/methods.h"

namespace obscura {
namespace {

/// A slope with two discs before it, a hole in the middle of one; anchors on one disc, a set that follows a
/// pixel of the slope on the other.
DisparitySystem test_system(int width, int height, bool masked, int sets) {
    DisparityMap d(width, height);
    Image<std::uint8_t> valid(width, height, 1);
    Image<int> id(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            d(x, y) = -6.0f + 0.05f * static_cast<float>(y);
            for (int k = 0; k < 2; ++k) {
                const double dx = x - width * (0.3 + 0.4 * k), dy = y - height * 0.5;
                const double t = 1 - (dx * dx + dy * dy) / (0.03 * width * width);
                if (t <= 0) continue;
                d(x, y) = static_cast<float>(2 + 5 * k + 4 * std::sqrt(t));
                id(x, y) = k + 1;
                if (masked && t > 0.95) valid(x, y) = 0;
            }
            if (masked && y < height / 6) valid(x, y) = 0;
        }
    }
    DisparitySystem s = unedited_system(d, valid);
    MatchingSet set{"follow", width / 2, height - 2, 1.0f, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (id(x, y) == 1) {
                s.anchor_weight(x, y) = 1;
                s.start(x, y) = s.anchor_value(x, y) = d(x, y) + 5;
            }
            if (id(x, y) == 2) set.members.push_back({x, y, d(x, y) - 7});
        }
    }
    for (int k = 0; k < sets; ++k) {
        MatchingSet copy = set;
        copy.source_x = (k * 37 + width / 2) % width;
        copy.source_y = height - 2 - k % 5;
        s.sets.push_back(copy);
    }
    return s;
}

double max_difference(const DisparityMap& a, const DisparityMap& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        most = std::max(most, std::abs(static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i])));
    return most;
}

SolverParams tight() {
    SolverParams p;
    p.tolerance_max_px = 1e-4;
    p.tolerance_rms_px = 1e-4;
    return p;
}

GridVector random_vector(const GridHierarchy& h, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-1, 1);
    GridVector v = grid_vector(h);
    for (int y = 0; y < v.cells.height(); ++y) {
        for (int x = 0; x < v.cells.width(); ++x)
            v.cells.row(y)[x] = h.levels[0].diagonal.row(y)[x] > 0 ? value(random) : 0.0f;
    }
    for (double& hub : v.hubs)
        hub = static_cast<double>(value(random));
    return v;
}

double dot(const GridVector& a, const GridVector& b) {
    double sum = 0;
    for (int y = 0; y < a.cells.height(); ++y) {
        for (int x = 0; x < a.cells.width(); ++x)
            sum += static_cast<double>(a.cells.row(y)[x]) * static_cast<double>(b.cells.row(y)[x]);
    }
    for (std::size_t k = 0; k < a.hubs.size(); ++k)
        sum += a.hubs[k] * b.hubs[k];
    return sum;
}

/// V v, one V-cycle.
GridVector cycled(GridHierarchy& h, const GridVector& v, double* product = nullptr) {
    GridVector r = grid_vector(h), z = grid_vector(h);
    r.hubs = v.hubs;
    const GridPlane zero(h.levels[0].width, h.levels[0].height);
    LevelSeconds none;
    const double d = v_cycle(h, v, zero, 0.0f, r, z, {}, none);
    if (product != nullptr) *product = d;
    return z;
}

TEST(VCycle, IsSymmetricAndPositive) {
    for (const bool masked : {false, true}) {
        for (const int sets : {0, 1, 5}) {
            const DisparitySystem s = test_system(75, 46, masked, sets);
            GridHierarchy h = grid_hierarchy(s, {});
            const GridVector a = random_vector(h, 1), b = random_vector(h, 2);
            double aa = 0;
            const GridVector va = cycled(h, a, &aa), vb = cycled(h, b);
            const double scale = std::sqrt(dot(a, va) * dot(b, vb));
            EXPECT_NEAR(dot(a, vb), dot(b, va), 1e-5 * scale) << "masked " << masked << ", sets " << sets;
            EXPECT_GT(dot(a, va), 0);
            EXPECT_NEAR(aa, dot(a, va), 1e-5 * aa) << "the dot product of the same pass";
        }
    }
}

TEST(VCycle, NearlySolvesWhatHasNoAnchors) {
    const DisparitySystem s = unedited_system(DisparityMap(96, 80), {});
    GridHierarchy h = grid_hierarchy(s, {});
    // A right side for the solution 1: epsilon everywhere.
    GridVector r = grid_vector(h);
    for (int y = 0; y < 80; ++y)
        std::fill_n(r.cells.row(y), 96, s.epsilon);
    const GridVector z = cycled(h, r);
    for (int y = 0; y < 80; ++y) {
        for (int x = 0; x < 96; ++x)
            EXPECT_NEAR(static_cast<double>(z.cells.row(y)[x]), 1.0, 0.02);
    }
}

TEST(Solver, ZeroEditsIsTheIdentity) {
    for (const bool masked : {false, true}) {
        DisparitySystem s = test_system(90, 50, masked, 0);
        s = unedited_system(s.original, s.valid);
        const Solution solution = solve(s, {}, {});
        EXPECT_TRUE(solution.report.converged);
        EXPECT_LT(max_difference(solution.disparity, s.original), 1e-6);
        for (std::size_t i = 0; i < s.valid.pixels.size(); ++i) {
            if (s.valid.pixels[i] == 0) {
                EXPECT_EQ(solution.disparity.pixels[i], s.original.pixels[i]);
            }
        }
    }
}

TEST(Solver, AConstantOffsetOfEverythingIsExact) {
    DisparitySystem s = unedited_system(test_system(120, 67, false, 0).original, {});
    for (std::size_t i = 0; i < s.original.pixels.size(); ++i) {
        s.anchor_weight.pixels[i] = 1;
        s.anchor_value.pixels[i] = s.original.pixels[i] + 8;
    }
    s.epsilon = 1e-6f;
    const Solution solution = solve(s, tight(), {});
    for (std::size_t i = 0; i < s.original.pixels.size(); ++i) {
        // epsilon pulls back by a millionth of 8 pixels.
        EXPECT_NEAR(static_cast<double>(solution.disparity.pixels[i]),
                    static_cast<double>(s.original.pixels[i]) + 8, 3e-5);
    }
}

/// Right sides are made so that a known map is the minimiser; every method that converges must find it.
TEST(Solver, FindsManufacturedSolutions) {
    for (const bool masked : {false, true}) {
        for (const int sets : {0, 1, 4}) {
            DisparitySystem s = test_system(131, 77, masked, sets);
            DisparityMap known = s.original;
            for (int y = 0; y < known.height; ++y) {
                for (int x = 0; x < known.width; ++x)
                    known(x, y) += 6.0f * static_cast<float>(std::sin(0.05 * x) * std::cos(0.07 * y));
            }
            for (int y = 0; y < s.height(); ++y) {
                for (int x = 0; x < s.width(); ++x) {
                    if (x + 1 < s.width()) s.gradient_x(x, y) = known(x + 1, y) - known(x, y);
                    if (y + 1 < s.height()) s.gradient_y(x, y) = known(x, y + 1) - known(x, y);
                    s.anchor_value(x, y) = known(x, y);
                    s.original(x, y) = known(x, y);
                    if (s.valid(x, y) == 0) s.start(x, y) = known(x, y);
                }
            }
            for (MatchingSet& set : s.sets) {
                for (MatchedPixel& p : set.members)
                    p.target = known(p.x, p.y) - known(set.source_x, set.source_y);
            }
            for (const SolverMethod method : {SolverMethod::multigrid, SolverMethod::fmg}) {
                if (method == SolverMethod::fmg && sets > 1) continue;
                SolverParams p = tight();
                p.method = method;
                p.max_iterations = 100;
                const Solution solution = solve(s, p, {});
                EXPECT_LT(max_difference(solution.disparity, known), 2e-3)
                    << "masked " << masked << ", sets " << sets << ", method " << static_cast<int>(method)
                    << ", iterations " << solution.report.iterations;
            }
        }
    }
}

TEST(Solver, LeavesNoGradientOfTheEnergy) {
    const DisparitySystem s = test_system(140, 90, true, 2);
    const Solution solution = solve(s, tight(), {});
    EXPECT_TRUE(solution.report.converged);
    const Image<double> r = residual(s, solution.disparity);
    double most = 0;
    for (const double value : r.pixels)
        most = std::max(most, std::abs(value));
    EXPECT_LT(most, 5e-3);  // a source pixel has the pulls of all its members
    EXPECT_LT(solution.report.residual, 1e-4);
    // A minimum: steps to any side cost energy.
    const double least = energy(s, solution.disparity);
    std::mt19937 random(5);
    for (int trial = 0; trial < 8; ++trial) {
        DisparityMap other = solution.disparity;
        for (std::size_t i = 0; i < other.pixels.size(); ++i) {
            if (s.valid.pixels[i] != 0) other.pixels[i] += (random() & 1) != 0 ? 0.05f : -0.05f;
        }
        EXPECT_GT(energy(s, other), least);
    }
}

TEST(Solver, ResidualIsHalfTheEnergysSlope) {
    const DisparitySystem s = test_system(24, 17, true, 2);
    const Image<double> r = residual(s, s.start);
    for (const int at : {0, 30, 200, 210, 333, 17 * 24 - 1}) {
        const auto i = static_cast<std::size_t>(at);
        if (s.valid.pixels[i] == 0) continue;
        DisparityMap up = s.start, down = s.start;
        up.pixels[i] += 0.25f;
        down.pixels[i] -= 0.25f;
        const double step = static_cast<double>(up.pixels[i]) - static_cast<double>(down.pixels[i]);
        EXPECT_NEAR(r.pixels[i], -0.5 * (energy(s, up) - energy(s, down)) / step,
                    1e-3 * (1 + std::abs(r.pixels[i])));
    }
}

TEST(Solver, SameBitsForAnyThreadsAndInstructionSet) {
    const DisparitySystem s = test_system(150, 99, true, 3);
    for (const SolverMethod method :
         {SolverMethod::multigrid, SolverMethod::fmg, SolverMethod::vcycle, SolverMethod::cascade}) {
        SolverParams p;
        p.method = method;
        p.max_iterations = 6;
        const Solution expected = solve_by_method(s, p, {Isa::ref, 1});
        for (const Isa isa : supported_isas()) {
            for (const int threads : {1, 2, 5}) {
                const Solution actual = solve_by_method(s, p, {isa, threads});
                EXPECT_EQ(actual.disparity, expected.disparity)
                    << isa_name(isa) << ", " << threads << " threads, method " << static_cast<int>(method);
                EXPECT_EQ(actual.report.error_max_px, expected.report.error_max_px);
            }
        }
    }
}

TEST(Solver, KeepsLevelsAndStartsWarm) {
    DisparitySystem s = test_system(200, 120, false, 1);
    SolverCache cache;
    const Solution first = solve(s, {}, {}, {}, &cache);
    // The artist moves the anchored disc a little: same matrix, near solution.
    for (std::size_t i = 0; i < s.anchor_value.pixels.size(); ++i)
        s.anchor_value.pixels[i] += 0.2f;
    const Solution cold = solve(s, {}, {});
    const Solution warm = solve(s, {}, {}, first.disparity, &cache);
    EXPECT_LT(warm.report.iterations, cold.report.iterations);
    EXPECT_LT(max_difference(warm.disparity, cold.disparity), 0.1);
    EXPECT_EQ(solve(s, {}, {}, first.disparity).disparity, warm.disparity) << "a cache changes no bit";
    // Another weight is another matrix.
    s.anchor_weight.pixels[60 * 200 + 60] += 3;
    EXPECT_EQ(solve(s, {}, {}, first.disparity, &cache).disparity,
              solve(s, {}, {}, first.disparity).disparity);
    EXPECT_EQ(solve(s, {}, {}, solve(s, tight(), {}).disparity).report.iterations, 1);
}

TEST(Solver, NamesWhatContradicts) {
    DisparitySystem s = test_system(100, 60, false, 0);
    AnchorArea near{"bring near", 1, {}}, far{"push away", 1, {}};
    for (int y = 0; y < 60; ++y) {
        for (int x = 0; x < 100; ++x) {
            if (s.anchor_weight(x, y) == 0) continue;
            near.pixels.push_back({x, y, s.original(x, y) + 20});
            far.pixels.push_back({x, y, s.original(x, y) - 20});
            s.anchor_weight(x, y) = 2;
            s.anchor_value(x, y) = s.original(x, y);
        }
    }
    s.anchors = {near, far};
    const Solution solution = solve(s, {}, {});
    EXPECT_TRUE(solution.report.converged);
    ASSERT_GE(solution.report.unsatisfied.size(), 2u);
    EXPECT_NEAR(solution.report.unsatisfied[0].worst_px, 20, 1);
    for (std::size_t i = 0; i < 2; ++i) {
        const Unsatisfied& u = solution.report.unsatisfied[i];
        EXPECT_EQ(u.against, u.name == "bring near" ? "push away" : "bring near");
    }
}

TEST(Methods, EachIsReachedByItsName) {
    const DisparitySystem s = test_system(60, 40, true, 1);
    SolverParams p;
    p.method = SolverMethod::cascade;
    const Solution paper = solve_by_method(s, p, {});
    EXPECT_EQ(paper.disparity, solve_cascade(s, p, {}).disparity);
    EXPECT_GT(paper.report.error_max_px, 0);
    EXPECT_GT(paper.report.residual, 0);
    EXPECT_FALSE(paper.report.converged);
    for (const SolverMethod method : {SolverMethod::vcycle, SolverMethod::fmg, SolverMethod::multigrid}) {
        p.method = method;
        EXPECT_EQ(solve_by_method(s, p, {}).disparity, solve(s, p, {}).disparity);
        EXPECT_NE(solve_by_method(s, p, {}).disparity, paper.disparity);
    }
}

TEST(Cascade, NeedsTheCorrectedSign) {
    const DisparitySystem s = test_system(240, 135, false, 0);
    SolverParams p = tight();
    const DisparityMap truth = solve(s, p, {}).disparity;
    const double corrected = max_difference(solve_cascade(s, p, {}).disparity, truth);
    p.printed_sign = true;
    const double printed = max_difference(solve_cascade(s, p, {}).disparity, truth);
    EXPECT_LT(corrected, 6);
    EXPECT_GT(printed, 2 * corrected);
}

TEST(Cascade, HalfFloatsCostAFewHundredthsOfAPixel) {
    const DisparitySystem s = test_system(240, 135, true, 1);
    SolverParams p;
    const DisparityMap single = solve_cascade(s, p, {}).disparity;
    p.half_storage = true;
    const DisparityMap half = solve_cascade(s, p, {}).disparity;
    // Disparities of 8 to 16 pixels are kept to 1/256; roundings of sweeps and levels add up to a few of
    // them.
    EXPECT_LT(max_difference(half, single), 0.05);
    EXPECT_GT(max_difference(half, single), 1.0 / 256);
    EXPECT_EQ(solve_cascade(s, p, {Isa::ref, 1}).disparity, solve_cascade(s, p, {best_isa(), 3}).disparity);
}

TEST(Cascade, JacobiSweepsGoToTheMinimiser) {
    const DisparitySystem s = test_system(24, 16, true, 1);
    const DisparityMap truth = solve(s, tight(), {}).disparity;
    double before = max_difference(s.start, truth);
    for (const int sweeps : {50, 500, 5000}) {
        const double error = max_difference(jacobi_sweeps(s, s.start, sweeps, {}), truth);
        EXPECT_LT(error, before) << sweeps;
        before = error;
    }
    EXPECT_LT(before, 0.05);
}

/// Interpolation shares out what missing cells would have given; without that these take eleven.
TEST(Solver, MasksCostNoIterations) {
    for (const bool masked : {false, true}) {
        DisparitySystem s = test_system(140, 90, masked, 0);
        s = unedited_system(s.original, s.valid);
        s.epsilon = 1e-5f;
        for (int x = 0; x < s.width(); ++x) {
            s.anchor_weight(x, 89) = 1;
            s.anchor_value(x, 89) = s.original(x, 89) + 9;
        }
        EXPECT_LE(solve(s, tight(), {}).report.iterations, 9) << "masked " << masked;
    }
}

TEST(Solver, OneIterationNeverStandsForConvergence) {
    SolverParams p;
    p.max_iterations = 1;
    const Solution solution = solve(test_system(200, 120, false, 1), p, {});
    EXPECT_FALSE(solution.report.converged);
    EXPECT_EQ(solution.report.iterations, 1);
    EXPECT_EQ(solution.report.steps.size(), 1u);
}

TEST(Solver, TakesAnySize) {
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 9}, {8, 8}, {9, 8}, {17, 3}, {64, 1}}) {
        DisparityMap d(width, height);
        for (std::size_t i = 0; i < d.pixels.size(); ++i)
            d.pixels[i] = static_cast<float>(i % 7);
        DisparitySystem s = unedited_system(d, {});
        s.anchor_weight(0, 0) = 1;
        s.anchor_value(0, 0) = d(0, 0) + 3;
        const Solution solution = solve(s, tight(), {});
        const Image<double> r = residual(s, solution.disparity);
        for (const double value : r.pixels)
            EXPECT_NEAR(value, 0, 1e-3) << width << " x " << height;
    }
}

}  // namespace
}  // namespace obscura
