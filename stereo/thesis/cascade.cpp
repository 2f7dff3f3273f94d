#include "stereo/thesis/cascade.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/stopwatch.h"
#include "stereo/grid_tasks.h"
#include "stereo/solver/grid_plane.h"
#include "stereo/solver/grid_rows.h"

namespace obscura {
namespace {

constexpr int coarsest_side = 8;

/// What sets add to a sweep: members follow their source, the source its members.
void add_sets(const DisparitySystem& s, const JacobiForm& form, const GridPlane& before, GridPlane& after) {
    for (const MatchingSet& set : s.sets) {
        if (s.valid(set.source_x, set.source_y) == 0) continue;
        const float source = before.row(set.source_y)[set.source_x];
        double pull = 0;
        for (const MatchedPixel& p : set.members) {
            if (s.valid(p.x, p.y) == 0 || (p.x == set.source_x && p.y == set.source_y)) continue;
            after.row(p.y)[p.x] += form.relax.row(p.y)[p.x] * (set.weight * source);
            pull += static_cast<double>(before.row(p.y)[p.x]);
        }
        after.row(set.source_y)[set.source_x] += form.relax.row(set.source_y)[set.source_x] *
                                                 static_cast<float>(static_cast<double>(set.weight) * pull);
    }
}

/// A cascade ends after its sweeps, wherever that is. How far from the minimiser it is says a solver that
/// gets there.
void measure_errors(const DisparitySystem& s, const Exec& exec, Solution& solution) {
    SolverParams params;
    params.verify = false;
    const DisparityMap minimiser = solve(s, params, exec, solution.disparity).disparity;
    double sum = 0, largest = 0, count = 0;
    for (std::size_t i = 0; i < minimiser.pixels.size(); ++i) {
        if (s.valid.pixels[i] == 0) continue;
        const double miss =
            static_cast<double>(solution.disparity.pixels[i]) - static_cast<double>(minimiser.pixels[i]);
        largest = std::max(largest, std::abs(miss));
        sum += miss * miss;
        count += 1;
    }
    solution.report.error_max_px = largest;
    solution.report.error_rms_px = count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace

JacobiForm jacobi_form(const DisparitySystem& s, const Exec& exec) {
    const int width = s.width(), height = s.height();
    JacobiForm form{GridPlane(width, height), GridPlane(width, height)};
    Image<double> diagonal(width, height), b(width, height);
    const double edge = 2.0 * static_cast<double>(s.gradient_weight);
    const DisparityMap zero(width, height);
    for_rows(height, exec, [&](int y) {
        residual_row(s, zero, y, b.row(y));
        for (int x = 0; x < width; ++x) {
            if (s.valid(x, y) == 0) continue;
            const int count = (x > 0 ? s.valid(x - 1, y) : 0) + (x + 1 < width ? s.valid(x + 1, y) : 0) +
                              (y > 0 ? s.valid(x, y - 1) : 0) + (y + 1 < height ? s.valid(x, y + 1) : 0);
            diagonal(x, y) =
                edge * count + static_cast<double>(s.epsilon) + static_cast<double>(s.anchor_weight(x, y));
        }
    });
    set_residuals(s, zero, [&](int x, int y, double value) { b(x, y) += value; });
    for (const MatchingSet& set : s.sets) {
        if (s.valid(set.source_x, set.source_y) == 0) continue;
        for (const MatchedPixel& p : set.members) {
            if (s.valid(p.x, p.y) == 0 || (p.x == set.source_x && p.y == set.source_y)) continue;
            diagonal(p.x, p.y) += static_cast<double>(set.weight);
            diagonal(set.source_x, set.source_y) += static_cast<double>(set.weight);
        }
    }
    for_rows(height, exec, [&](int y) {
        for (int x = 0; x < width; ++x) {
            if (s.valid(x, y) == 0) continue;
            form.b.row(y)[x] = static_cast<float>(b(x, y));
            form.relax.row(y)[x] = static_cast<float>(1.0 / diagonal(x, y));
        }
    });
    return form;
}

DisparitySystem halved(const DisparitySystem& fine) {
    const int width = (fine.width() + 1) / 2, height = (fine.height() + 1) / 2;
    DisparitySystem s;
    s.gradient_weight = fine.gradient_weight;
    s.epsilon = fine.epsilon;
    s.original = s.start = s.gradient_x = s.gradient_y = s.anchor_weight = s.anchor_value =
        Image<float>(width, height);
    s.valid = Image<std::uint8_t>(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int i = 2 * x, j = 2 * y;
            s.original(x, y) = fine.original(i, j);
            s.start(x, y) = fine.start(i, j);
            s.anchor_weight(x, y) = fine.anchor_weight(i, j);
            s.anchor_value(x, y) = fine.anchor_value(i, j);
            s.valid(x, y) = fine.valid(i, j);
            if (x + 1 < width) s.gradient_x(x, y) = fine.gradient_x(i, j) + fine.gradient_x(i + 1, j);
            if (y + 1 < height) s.gradient_y(x, y) = fine.gradient_y(i, j) + fine.gradient_y(i, j + 1);
        }
    }
    for (const MatchingSet& set : fine.sets) {
        MatchingSet half{set.name, set.source_x / 2, set.source_y / 2, set.weight, {}};
        for (const MatchedPixel& p : set.members) {
            if (p.x % 2 == 0 && p.y % 2 == 0) half.members.push_back({p.x / 2, p.y / 2, p.target});
        }
        s.sets.push_back(std::move(half));
    }
    return s;
}

DisparityMap upsampled(const DisparitySystem& fine, const DisparitySystem& coarse, const DisparityMap& x,
                       bool printed_sign) {
    DisparityMap out(fine.width(), fine.height());
    const float sign = printed_sign ? -1.0f : 1.0f;
    for (int j = 0; j < fine.height(); ++j) {
        for (int i = 0; i < fine.width(); ++i) {
            const float here = fine.start(i, j), sampled = coarse.start(i / 2, j / 2);
            const bool known = coarse.valid(i / 2, j / 2) != 0 && fine.valid(i, j) != 0;
            out(i, j) = known ? x(i / 2, j / 2) + sign * (here - sampled) : here;
        }
    }
    return out;
}

DisparityMap jacobi_sweeps(const DisparitySystem& s, DisparityMap x, int sweeps, const Exec& exec) {
    const JacobiForm form = jacobi_form(s, exec);
    GridPlane planes[2] = {GridPlane(s.width(), s.height()), GridPlane(s.width(), s.height())};
    for_rows(s.height(), exec, [&](int y) {
        for (int i = 0; i < s.width(); ++i)
            planes[0].row(y)[i] = s.valid(i, y) != 0 ? x(i, y) : 0.0f;
    });
    const RowEdges edges{2 * s.gradient_weight, nullptr, nullptr, nullptr};
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        const GridPlane& before = planes[sweep % 2];
        GridPlane& after = planes[1 - sweep % 2];
        for_rows(s.height(), exec, [&](int y) {
            LaneSums sums;
            const RowTriple rows{before.row(y - 1), before.row(y), before.row(y + 1)};
            OBSCURA_DISPATCH(exec.isa, smooth_row, form.b.row(y), rows, edges, form.relax.row(y), 0.0f,
                             form.relax.count(), after.row(y), sums);
        });
        add_sets(s, form, before, after);
    }
    const GridPlane& last = planes[sweeps % 2];
    for_rows(s.height(), exec, [&](int y) {
        for (int i = 0; i < s.width(); ++i)
            x(i, y) = s.valid(i, y) != 0 ? last.row(y)[i] : s.start(i, y);
    });
    return x;
}

Solution solve_cascade(const DisparitySystem& system, const SolverParams& params, const Exec& exec) {
    CHECK(system.gradient_weight > 0 && system.epsilon > 0);
    const Stopwatch clock;
    std::vector<DisparitySystem> pyramid;  // without the finest
    const auto finest = [&]() -> const DisparitySystem& { return pyramid.empty() ? system : pyramid.back(); };
    while (std::max(finest().width(), finest().height()) > coarsest_side)
        pyramid.push_back(halved(finest()));
    Solution solution;
    SolveReport& report = solution.report;
    report.setup_s = clock.seconds();
    DisparityMap x = finest().start;
    for (std::size_t l = pyramid.size() + 1; l-- > 0;) {
        const double before = clock.seconds();
        const DisparitySystem& level = l == 0 ? system : pyramid[l - 1];
        if (l < pyramid.size()) x = upsampled(level, pyramid[l], x, params.printed_sign);
        x = params.half_storage ? jacobi_sweeps_half(level, std::move(x), params.sweeps, exec)
                                : jacobi_sweeps(level, std::move(x), params.sweeps, exec);
        report.levels.insert(report.levels.begin(),
                             {level.width(), level.height(), clock.seconds() - before});
        report.steps.push_back({0, 0, 0, clock.seconds()});
        report.iterations += params.sweeps;
    }
    report.solve_s = clock.seconds() - report.setup_s;
    solution.disparity = std::move(x);
    if (params.verify) {
        judge(system, exec, solution);
        measure_errors(system, exec, solution);
    }
    return solution;
}

}  // namespace obscura
