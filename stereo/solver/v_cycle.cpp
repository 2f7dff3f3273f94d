#include "stereo/solver/v_cycle.h"

#include "core/error.h"
#include "core/parallel.h"
#include "stereo/solver/dense_cholesky.h"
#include "stereo/solver/grid_restrict.h"

namespace obscura {
namespace {

constexpr int coarse_rows_per_task = 16;
constexpr auto keep = static_cast<float>(1 - jacobi_damping);

int tasks_of(int coarse_height) {
    return (coarse_height + coarse_rows_per_task - 1) / coarse_rows_per_task;
}

/// Where a descent's right side comes from: r itself, or r - alpha q, which is then kept in `out`.
struct RightSide {
    const GridPlane& r;
    const GridPlane* q = nullptr;
    float alpha = 0;
    GridPlane* out = nullptr;
};

/// One task's sweep downwards: rows of r and z = relax r are made when they are first asked for, and
/// residuals from three rows of z.
class DescentSweep {
  public:
    DescentSweep(const GridLevel& fine, const RightSide& in, const Exec& exec, int first, int last)
        : fine_(fine),
          in_(in),
          isa_(exec.isa),
          first_(first),
          last_(last),
          zeros_(fine.width, 1),
          r_(fine.width, 4),
          z_(fine.width, 4),
          left_(fine.width, 4),
          next_z_(std::max(first - 2, 0)),
          next_left_(std::max(first - 1, 0)) {}

    /// Residual row y, scaled for restriction; asked for in ascending order, at most four rows back.
    const float* residual(int y, std::vector<double>& hubs) {
        for (; next_left_ <= y; ++next_left_)
            make_residual(next_left_, hubs);
        return left_.row(y);
    }
    const float* zeros() const { return zeros_.row(0); }

  private:
    bool owned(int y) const { return first_ <= y && y < last_; }
    /// Row y of the right side.
    const float* right_side(int y) {
        if (in_.q == nullptr) return in_.r.row(y);
        return owned(y) ? in_.out->row(y) : r_.row(y);
    }
    void make_z(int y, std::vector<double>& hubs) {
        const float* relax = fine_.relax.row(y);
        const int count = fine_.relax.count();
        if (in_.q == nullptr) {
            OBSCURA_DISPATCH(isa_, relax_row, in_.r.row(y), relax, count, z_.row(y));
        } else {
            float* r = owned(y) ? in_.out->row(y) : r_.row(y);
            OBSCURA_DISPATCH(isa_, update_row, in_.r.row(y), in_.q->row(y), in_.alpha, relax, count, r,
                             z_.row(y));
        }
        if (!owned(y)) return;
        // A hub's own residual: its row of the matrix has -weight at each cell.
        for_couplings(fine_, y, [&](const Coupling& c) {
            hubs[c.hub] += static_cast<double>(c.weight) * static_cast<double>(z_.row(y)[c.x]);
        });
    }
    const float* z_row(int y) { return y < 0 || y >= fine_.height ? zeros() : z_.row(y); }
    void make_residual(int y, std::vector<double>& hubs) {
        for (; next_z_ <= std::min(y + 1, fine_.height - 1); ++next_z_)
            make_z(next_z_, hubs);
        const RowTriple z{z_row(y - 1), z_row(y), z_row(y + 1)};
        const float* scale = fine_.scale.empty() ? nullptr : fine_.scale.row(y);
        float* left = left_.row(y);
        OBSCURA_DISPATCH(isa_, residual_row, right_side(y), z, row_edges(fine_, y), fine_.relax.row(y), scale,
                         keep, fine_.relax.count(), left);
        if (!owned(y) || scale == nullptr) return;
        // Where interpolation takes a share of the hub, restriction gives it that share of the residual.
        for_couplings(fine_, y, [&](const Coupling& c) {
            if (c.share > 0) hubs[c.hub] += static_cast<double>(c.share * (left[c.x] / scale[c.x]));
        });
    }

    const GridLevel& fine_;
    const RightSide& in_;
    Isa isa_;
    int first_, last_;
    GridPlane zeros_;
    RowRing r_, z_, left_;
    int next_z_, next_left_;
};

void descend_from(const GridLevel& fine, const RightSide& in, GridLevel& coarse, std::vector<double>& hub_rhs,
                  const Exec& exec) {
    const auto tasks = static_cast<std::size_t>(tasks_of(coarse.height));
    std::vector<std::vector<double>> hubs(tasks, std::vector<double>(hub_rhs.size(), 0.0));
    parallel_for(tasks, exec, [&](std::size_t task) {
        const int Y0 = static_cast<int>(task) * coarse_rows_per_task;
        const int Y1 = std::min(Y0 + coarse_rows_per_task, coarse.height);
        DescentSweep sweep(fine, in, exec, 2 * Y0, std::min(2 * Y1, fine.height));
        RowRing scratch(fine.width + 32, 3);
        for (int Y = Y0; Y < Y1; ++Y) {
            sweep.residual(std::min(2 * Y + 2, fine.height - 1), hubs[task]);
            const float* sources[4];
            restrict_sources(
                Y, fine.height, sweep.zeros(), [&](int y) { return sweep.residual(y, hubs[task]); }, sources);
            OBSCURA_DISPATCH(exec.isa, restrict_row, sources, fine.width, coarse.width, scratch.row(0),
                             coarse.rhs.row(Y));
        }
    });
    for (const auto& part : hubs) {
        for (std::size_t k = 0; k < hub_rhs.size(); ++k)
            hub_rhs[k] += part[k];
    }
}

/// One task's sweep upwards: rows of the corrected z are made when they are first asked for.
class AscentSweep {
  public:
    AscentSweep(const GridLevel& fine, const GridPlane& rhs, const GridLevel& coarse,
                const std::vector<double>& hubs, const Exec& exec, int first)
        : fine_(fine),
          rhs_(rhs),
          coarse_(coarse),
          hubs_(hubs),
          isa_(exec.isa),
          zeros_(fine.width, 1),
          z_(fine.width, 4),
          interpolated_(fine.width + 32, 3),
          scratch_(coarse.width + 16, 3),
          next_(std::max(first - 1, 0)) {}

    /// Smooths row y into `out`; in ascending order. Returns rhs . out.
    double smooth(int y, float* out) {
        for (; next_ <= std::min(y + 1, fine_.height - 1); ++next_)
            make_corrected(next_);
        const RowTriple z{row_of(y - 1), row_of(y), row_of(y + 1)};
        LaneSums sums;
        OBSCURA_DISPATCH(isa_, smooth_row, rhs_.row(y), z, row_edges(fine_, y), fine_.relax.row(y), keep,
                         fine_.relax.count(), out, sums);
        double dot = 0;
        for (const float lane : sums.dot)
            dot += static_cast<double>(lane);
        for_couplings(fine_, y, [&](const Coupling& c) {
            const float pull = fine_.relax.row(y)[c.x] * c.weight * static_cast<float>(hubs_[c.hub]);
            out[c.x] += pull;
            dot += static_cast<double>(rhs_.row(y)[c.x]) * static_cast<double>(pull);
        });
        return dot;
    }

  private:
    const float* row_of(int y) { return y < 0 || y >= fine_.height ? zeros_.row(0) : z_.row(y); }
    void make_corrected(int y) {
        const float* own = coarse_.solution.row(y / 2);
        const float* other = coarse_.solution.row(other_coarse_row(y, coarse_.height));
        OBSCURA_DISPATCH(isa_, prolong_row, own, other, fine_.width, coarse_.width, scratch_.row(0),
                         interpolated_.row(0));
        OBSCURA_DISPATCH(isa_, correct_row, rhs_.row(y), interpolated_.row(0), fine_.relax.row(y),
                         fine_.scale.empty() ? nullptr : fine_.scale.row(y), fine_.relax.count(), z_.row(y));
        if (fine_.scale.empty()) return;
        for_couplings(fine_, y, [&](const Coupling& c) {
            z_.row(y)[c.x] += c.share * static_cast<float>(hubs_[c.hub]);
        });
    }

    const GridLevel& fine_;
    const GridPlane& rhs_;
    const GridLevel& coarse_;
    const std::vector<double>& hubs_;
    Isa isa_;
    GridPlane zeros_;
    RowRing z_, interpolated_, scratch_;
    int next_;
};

}  // namespace

GridVector grid_vector(const GridHierarchy& h) {
    return {GridPlane(h.levels[0].width, h.levels[0].height), std::vector<double>(h.hubs.size(), 0.0)};
}

GridVector framed_vector(const GridHierarchy& h) {
    return {GridPlane::framed(h.levels[0].width, h.levels[0].height),
            std::vector<double>(h.hubs.size(), 0.0)};
}

RowEdges row_edges(const GridLevel& level, int y) {
    if (level.uniform_edge > 0) return {level.uniform_edge, nullptr, nullptr, nullptr};
    return {0.0f, level.edge_x.row(y), level.edge_y.row(y - 1), level.edge_y.row(y)};
}

void descend(const GridLevel& fine, const GridPlane& rhs, GridLevel& coarse, std::vector<double>& hub_rhs,
             const Exec& exec) {
    descend_from(fine, {rhs, nullptr, 0.0f, nullptr}, coarse, hub_rhs, exec);
}

double ascend(const GridLevel& fine, const GridPlane& rhs, const GridLevel& coarse,
              const std::vector<double>& hubs, GridPlane& solution, const Exec& exec) {
    constexpr int rows_per_task = 2 * coarse_rows_per_task;
    const auto tasks = static_cast<std::size_t>((fine.height + rows_per_task - 1) / rows_per_task);
    std::vector<double> dots(tasks, 0.0);
    parallel_for(tasks, exec, [&](std::size_t task) {
        const int y0 = static_cast<int>(task) * rows_per_task;
        AscentSweep sweep(fine, rhs, coarse, hubs, exec, y0);
        for (int y = y0; y < std::min(y0 + rows_per_task, fine.height); ++y)
            dots[task] += sweep.smooth(y, solution.row(y));
    });
    double dot = 0;
    for (const double part : dots)
        dot += part;
    return dot;
}

void solve_coarsest(GridHierarchy& h, std::vector<double>& hubs) {
    GridLevel& level = h.levels.back();
    const std::size_t cells = h.unknowns.size();
    const auto row_of = [&](std::size_t i) { return h.unknowns[i] / level.width; };
    const auto column_of = [&](std::size_t i) { return h.unknowns[i] % level.width; };
    std::vector<double> b(cells + hubs.size());
    for (std::size_t i = 0; i < cells; ++i)
        b[i] = static_cast<double>(level.rhs.row(row_of(i))[column_of(i)]);
    std::copy(hubs.begin(), hubs.end(), b.begin() + static_cast<std::ptrdiff_t>(cells));
    solve_cholesky(static_cast<int>(b.size()), h.factor, b);
    for (std::size_t i = 0; i < cells; ++i)
        level.solution.row(row_of(i))[column_of(i)] = static_cast<float>(b[i]);
    std::copy(b.begin() + static_cast<std::ptrdiff_t>(cells), b.end(), hubs.begin());
}

double v_cycle(GridHierarchy& h, const GridVector& r_before, const GridPlane& q, float alpha, GridVector& r,
               GridVector& z, const Exec& exec, LevelSeconds& seconds) {
    CHECK(h.levels.size() > 1 && &r != &r_before, "a V-cycle needs two levels and two residuals");
    z.hubs = r.hubs;
    {
        const LevelClock clock(seconds, 0);
        descend_from(h.levels[0], {r_before.cells, &q, alpha, &r.cells}, h.levels[1], z.hubs, exec);
    }
    const std::size_t last = h.levels.size() - 1;
    for (std::size_t l = 1; l < last; ++l) {
        const LevelClock clock(seconds, l);
        descend(h.levels[l], h.levels[l].rhs, h.levels[l + 1], z.hubs, exec);
    }
    {
        const LevelClock clock(seconds, last);
        solve_coarsest(h, z.hubs);
    }
    for (std::size_t l = last - 1; l > 0; --l) {
        const LevelClock clock(seconds, l);
        ascend(h.levels[l], h.levels[l].rhs, h.levels[l + 1], z.hubs, h.levels[l].solution, exec);
    }
    const LevelClock clock(seconds, 0);
    double dot = ascend(h.levels[0], r.cells, h.levels[1], z.hubs, z.cells, exec);
    for (std::size_t k = 0; k < z.hubs.size(); ++k)
        dot += r.hubs[k] * z.hubs[k];
    return dot;
}

}  // namespace obscura
