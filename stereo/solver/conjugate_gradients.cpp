#include "stereo/solver/conjugate_gradients.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/stopwatch.h"

namespace obscura {
namespace {

constexpr int rows_per_task = 32;

std::size_t tasks_of(int height) {
    return static_cast<std::size_t>((height + rows_per_task - 1) / rows_per_task);
}

/// What one pass over the direction gives.
struct DirectionSums {
    double curvature = 0;  ///< p . A p
    double square = 0;     ///< p . p
    double largest = 0;    ///< max |p|
};

void add_lanes(const LaneSums& lanes, DirectionSums& sums) {
    for (int i = 0; i < 16; ++i) {
        sums.curvature += static_cast<double>(lanes.dot[i]);
        sums.square += static_cast<double>(lanes.square[i]);
        sums.largest = std::max(sums.largest, static_cast<double>(lanes.largest[i]));
    }
}

/// Rows [y0, y1) of x += alpha p_old, p = z + beta p_old, q = A p. Rows of p on either side are made too, but
/// not kept: they belong to others.
DirectionSums direction_rows(const GridLevel& level, IterationVectors& w, float beta, float alpha, int y0,
                             int y1, const Exec& exec, std::vector<double>& hub_sums) {
    const GridVector& old = w.p[1 - w.newest_p];
    GridVector& p = w.p[w.newest_p];
    const int count = level.relax.count();
    RowRing outside(level.width, 3);
    const auto make = [&](int y) {
        const bool owned = y0 <= y && y < y1;
        float* out = owned ? p.cells.row(y) : outside.row(y < y0 ? 0 : 1);
        OBSCURA_DISPATCH(exec.isa, direction_row, w.z.cells.row(y), old.cells.row(y), beta, alpha, count,
                         owned ? w.x.cells.row(y) : nullptr, out);
    };
    const auto row = [&](int y) -> const float* {
        if (y < y0) return outside.row(0);
        return y < y1 ? p.cells.row(y) : outside.row(1);
    };
    DirectionSums sums;
    int next = std::max(y0 - 1, 0);
    for (int y = y0; y < y1; ++y) {
        for (; next <= std::min(y + 1, level.height - 1); ++next)
            make(next);
        LaneSums lanes;
        float* q = w.q.cells.row(y);
        OBSCURA_DISPATCH(exec.isa, apply_row, RowTriple{row(y - 1), row(y), row(y + 1)}, row_edges(level, y),
                         level.diagonal.row(y), level.relax.row(y), count, q, lanes);
        add_lanes(lanes, sums);
        for_couplings(level, y, [&](const Coupling& c) {
            const float pull = c.weight * static_cast<float>(p.hubs[c.hub]), here = row(y)[c.x];
            q[c.x] -= pull;
            sums.curvature -= static_cast<double>(pull) * static_cast<double>(here);
            hub_sums[c.hub] += static_cast<double>(c.weight) * static_cast<double>(here);
        });
    }
    return sums;
}

/// The pass over the new direction: returns its sums, hubs included.
DirectionSums new_direction(const GridHierarchy& h, IterationVectors& w, double beta, double alpha,
                            const Exec& exec) {
    const GridLevel& level = h.levels[0];
    const std::size_t hubs = h.hubs.size(), tasks = tasks_of(level.height);
    w.newest_p = 1 - w.newest_p;
    const GridVector& old = w.p[1 - w.newest_p];
    GridVector& p = w.p[w.newest_p];
    for (std::size_t k = 0; k < hubs; ++k) {
        w.x.hubs[k] += alpha * old.hubs[k];
        p.hubs[k] = w.z.hubs[k] + beta * old.hubs[k];
    }
    std::vector<DirectionSums> part(tasks);
    std::vector<std::vector<double>> hub_part(tasks, std::vector<double>(hubs, 0.0));
    parallel_for(tasks, exec, [&](std::size_t task) {
        const int y0 = static_cast<int>(task) * rows_per_task;
        part[task] = direction_rows(level, w, static_cast<float>(beta), static_cast<float>(alpha), y0,
                                    std::min(y0 + rows_per_task, level.height), exec, hub_part[task]);
    });
    DirectionSums sums;
    for (const DirectionSums& s : part) {
        sums.curvature += s.curvature;
        sums.square += s.square;
        sums.largest = std::max(sums.largest, s.largest);
    }
    for (std::size_t k = 0; k < hubs; ++k) {
        double q = 0;
        for (std::size_t j = 0; j < hubs; ++j)
            q += level.hub_matrix[k * hubs + j] * p.hubs[j];
        for (const auto& s : hub_part)
            q -= s[k];
        w.q.hubs[k] = q;
        sums.curvature += p.hubs[k] * q;
        sums.square += p.hubs[k] * p.hubs[k];
        sums.largest = std::max(sums.largest, std::abs(p.hubs[k]));
    }
    return sums;
}

/// x of the system plus the solution so far.
void add_solution(const GridHierarchy& h, const IterationVectors& w, const Exec& exec, DisparityMap& x) {
    parallel_blocks(static_cast<std::size_t>(x.height), rows_per_task, exec,
                    [&](std::size_t begin, std::size_t end) {
                        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                            for (int i = 0; i < x.width; ++i)
                                x(i, y) += w.x.cells.row(y)[i];
                        }
                    });
    for (std::size_t k = 0; k < h.hubs.size(); ++k)
        x(h.hubs[k].x, h.hubs[k].y) += static_cast<float>(w.x.hubs[k]);
}

/// What is left after a step: the tail of a geometric series that shrinks as steps have, at the slower of
/// their last two rates, and no faster than `fastest`. Hubs, masks and thin things are eigenvalues apart from
/// the others, on which steps may pause and grow again; so half of the step before counts too, and no step is
/// trusted to be nearly the last. Where things that nothing joins share coarse cells, the pauses are longer:
/// there the worst of the last three counts.
class ErrorEstimate {
  public:
    ErrorEstimate(double fastest, bool long_pauses) : fastest_(fastest), long_pauses_(long_pauses) {}
    double after(double step) {
        const double now = tail_after(step);
        const double worst = std::max({now, last_[0], last_[1]});
        last_[1] = last_[0];
        last_[0] = now;
        return long_pauses_ ? worst : now;
    }

  private:
    double tail_after(double step) {
        constexpr double slowest = 0.9;
        double ratio = slowest;
        if (before_ > 0) ratio = step / before_;
        if (earlier_ > 0) ratio = std::max(ratio, std::sqrt(step / earlier_));
        ratio = std::clamp(ratio, fastest_, slowest);
        const double bound = std::max(step, 0.5 * before_);
        earlier_ = before_;
        before_ = step;
        return bound * ratio / (1 - ratio);
    }

    double fastest_;
    bool long_pauses_;
    double before_ = 0, earlier_ = 0;
    double last_[2] = {0, 0};
};

/// A few such cells are in every outline before a sky, and do no harm.
constexpr std::int64_t few_shared_cells = 64;

}  // namespace

IterationVectors::IterationVectors(const GridHierarchy& h)
    : x(grid_vector(h)),
      z(framed_vector(h)),
      r{framed_vector(h), framed_vector(h)},
      p{grid_vector(h), grid_vector(h)},
      q(grid_vector(h)) {}

void IterationVectors::reset(const GridHierarchy& h) {
    newest_r = newest_p = 0;
    for (GridVector* v : {&x, &p[0], &p[1], &q}) {
        for (int y = 0; y < v->cells.height(); ++y)
            std::fill_n(v->cells.row(y), v->cells.count(), 0.0f);
    }
    for (GridVector* v : {&x, &z, &r[0], &r[1], &p[0], &p[1], &q})
        v->hubs.assign(h.hubs.size(), 0.0);
}

double residual_norm(const DisparitySystem& s, const DisparityMap& x, const Exec& exec) {
    Image<double> of_sets;
    if (!s.sets.empty()) {
        of_sets = Image<double>(s.width(), s.height());
        set_residuals(s, x, [&](int i, int j, double value) { of_sets(i, j) += value; });
    }
    std::vector<double> part(tasks_of(s.height()), 0.0);
    parallel_for(part.size(), exec, [&](std::size_t task) {
        const int y0 = static_cast<int>(task) * rows_per_task;
        std::vector<double> row(static_cast<std::size_t>(s.width()));
        for (int y = y0; y < std::min(y0 + rows_per_task, s.height()); ++y) {
            residual_row(s, x, y, row.data());
            double sum = 0;
            for (int i = 0; i < s.width(); ++i) {
                double& r = row[static_cast<std::size_t>(i)];
                if (!s.sets.empty()) r += of_sets(i, y);
                sum += r * r;
            }
            part[task] += sum;
        }
    });
    double sum = 0;
    for (const double value : part)
        sum += value;
    return std::sqrt(sum);
}

void start_residual(const DisparitySystem& s, const GridHierarchy& h, const DisparityMap& x, const Exec& exec,
                    GridVector& r) {
    parallel_blocks(static_cast<std::size_t>(s.height()), rows_per_task, exec,
                    [&](std::size_t begin, std::size_t end) {
                        std::vector<double> row(static_cast<std::size_t>(s.width()));
                        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                            residual_row(s, x, y, row.data());
                            for (int i = 0; i < s.width(); ++i)
                                r.cells.row(y)[i] = static_cast<float>(row[static_cast<std::size_t>(i)]);
                        }
                    });
    std::vector<double> row(static_cast<std::size_t>(s.width()));
    for (std::size_t k = 0; k < h.hubs.size(); ++k) {
        residual_row(s, x, h.hubs[k].y, row.data());
        r.hubs[k] = row[static_cast<std::size_t>(h.hubs[k].x)];
        r.cells.row(h.hubs[k].y)[h.hubs[k].x] = 0;
    }
    if (h.hubs.empty()) return;
    set_residuals(s, x, [&](int i, int j, double value) {
        const bool cell = h.levels[0].diagonal.row(j)[i] > 0;
        if (cell) {
            float& out = r.cells.row(j)[i];
            out = static_cast<float>(static_cast<double>(out) + value);
        } else {
            r.hubs[static_cast<std::size_t>(hub_at(h, i, j))] += value;
        }
    });
}

void iterate(const DisparitySystem& s, GridHierarchy& h, const SolverParams& params, const Exec& exec,
             IterationVectors& w, DisparityMap& x, SolveReport& report, LevelSeconds& seconds) {
    const Stopwatch clock;
    const bool stationary = params.method != SolverMethod::multigrid;
    start_residual(s, h, x, exec, w.r[0]);
    const std::vector<std::uint8_t>& valid = s.valid.pixels;
    const auto unknowns = static_cast<double>(valid.size()) -
                          static_cast<double>(std::count(valid.begin(), valid.end(), std::uint8_t{0}));
    // A pause of few pixels hardly shows in the mean.
    const bool long_pauses = h.shared_cells > few_shared_cells;
    ErrorEstimate largest(0.4, long_pauses), root_mean_square(0.3, long_pauses);
    double alpha = 0, rz_before = 0, rz_first = 0;
    report.converged = false;
    while (!report.converged && report.iterations < params.max_iterations) {
        const GridVector& before = w.r[w.newest_r];
        GridVector& r = w.r[1 - w.newest_r];
        for (std::size_t k = 0; k < r.hubs.size(); ++k)
            r.hubs[k] = before.hubs[k] - alpha * w.q.hubs[k];
        const double rz = v_cycle(h, before, w.q.cells, static_cast<float>(alpha), r, w.z, exec, seconds);
        w.newest_r = 1 - w.newest_r;
        const double beta = stationary || report.iterations == 0 ? 0.0 : rz / rz_before;
        rz_before = rz;
        const DirectionSums sums = new_direction(h, w, beta, alpha, exec);
        if (!(sums.curvature > 0) || !(rz > 0)) {
            // Nothing is left to do, down to the last bit.
            report.converged = rz == 0;
            alpha = 0;
            break;
        }
        // A whole step of a cycle may overshoot where sets and anchors are; one to the least energy cannot.
        alpha = stationary ? std::min(1.0, rz / sums.curvature) : rz / sums.curvature;
        ++report.iterations;
        SolveStep step;
        step.error_max_px = largest.after(alpha * sums.largest);
        step.error_rms_px = root_mean_square.after(alpha * std::sqrt(sums.square / unknowns));
        if (report.iterations == 1) rz_first = rz;
        step.residual = std::sqrt(rz / rz_first);
        step.seconds = clock.seconds();
        report.steps.push_back(step);
        report.error_max_px = step.error_max_px;
        report.error_rms_px = step.error_rms_px;
        report.converged =
            step.error_max_px <= params.tolerance_max_px && step.error_rms_px <= params.tolerance_rms_px;
    }
    // The last step is still pending.
    const GridVector& p = w.p[w.newest_p];
    for (std::size_t k = 0; k < h.hubs.size(); ++k)
        w.x.hubs[k] += alpha * p.hubs[k];
    parallel_blocks(static_cast<std::size_t>(x.height), rows_per_task, exec,
                    [&](std::size_t begin, std::size_t end) {
                        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                            for (int i = 0; i < x.width; ++i)
                                w.x.cells.row(y)[i] += static_cast<float>(alpha) * p.cells.row(y)[i];
                        }
                    });
    add_solution(h, w, exec, x);
}

}  // namespace obscura
