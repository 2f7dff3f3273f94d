#include "stereo/solver/full_multigrid.h"

#include "stereo/grid_tasks.h"
#include "stereo/solver/grid_restrict.h"

namespace obscura {
namespace {

/// Calls fn(coupling, y) for all of a level.
template <class Fn>
void for_all_couplings(const GridLevel& level, Fn&& fn) {
    for (int y = 0; y < level.height; ++y)
        for_couplings(level, y, [&](const Coupling& c) { fn(c, y); });
}

/// The right side in terms of the next level: the transpose of interpolation.
GridVector restricted(const GridLevel& fine, const GridLevel& coarse, const GridVector& r, const Exec& exec) {
    GridPlane scaled(fine.width, fine.height);
    const GridPlane zeros(fine.width, 1);
    const RowTriple none{zeros.row(0), zeros.row(0), zeros.row(0)};
    for_rows(fine.height, exec, [&](int y) {
        OBSCURA_DISPATCH(exec.isa, residual_row, r.cells.row(y), none, row_edges(fine, y), fine.relax.row(y),
                         fine.scale.empty() ? nullptr : fine.scale.row(y), 1.0f, fine.relax.count(),
                         scaled.row(y));
    });
    GridVector out{GridPlane(coarse.width, coarse.height), r.hubs};
    for_rows(coarse.height, exec, [&](int Y) {
        RowRing scratch(fine.width + 32, 3);
        const float* sources[4];
        restrict_sources(
            Y, fine.height, zeros.row(0), [&](int y) { return scaled.row(y); }, sources);
        OBSCURA_DISPATCH(exec.isa, restrict_row, sources, fine.width, coarse.width, scratch.row(0),
                         out.cells.row(Y));
    });
    for_all_couplings(fine, [&](const Coupling& c, int y) {
        out.hubs[c.hub] += static_cast<double>(c.share) * static_cast<double>(r.cells.row(y)[c.x]);
    });
    return out;
}

/// A coarse solution on the next finer level.
GridVector interpolated(const GridLevel& fine, const GridLevel& coarse, const GridVector& x,
                        const Exec& exec) {
    GridVector out{GridPlane(fine.width, fine.height), x.hubs};
    const GridPlane zeros(fine.width, 1);
    for_rows(fine.height, exec, [&](int y) {
        RowRing row(fine.width + 32, 3), scratch(coarse.width + 16, 3);
        OBSCURA_DISPATCH(exec.isa, prolong_row, x.cells.row(y / 2),
                         x.cells.row(other_coarse_row(y, coarse.height)), fine.width, coarse.width,
                         scratch.row(0), row.row(0));
        OBSCURA_DISPATCH(exec.isa, correct_row, zeros.row(0), row.row(0), fine.relax.row(y),
                         fine.scale.empty() ? nullptr : fine.scale.row(y), fine.relax.count(),
                         out.cells.row(y));
    });
    for_all_couplings(fine, [&](const Coupling& c, int y) {
        out.cells.row(y)[c.x] += c.share * static_cast<float>(x.hubs[c.hub]);
    });
    return out;
}

/// b - A x.
GridVector left_over(const GridLevel& level, const GridVector& b, const GridVector& x, const Exec& exec) {
    GridVector r{GridPlane(level.width, level.height), b.hubs};
    for_rows(level.height, exec, [&](int y) {
        LaneSums sums;
        float* out = r.cells.row(y);
        const RowTriple rows{x.cells.row(y - 1), x.cells.row(y), x.cells.row(y + 1)};
        OBSCURA_DISPATCH(exec.isa, apply_row, rows, row_edges(level, y), level.diagonal.row(y),
                         level.relax.row(y), level.relax.count(), out, sums);
        for (int i = 0; i < level.width; ++i)
            out[i] = b.cells.row(y)[i] - out[i];
    });
    for_all_couplings(level, [&](const Coupling& c, int y) {
        r.cells.row(y)[c.x] += c.weight * static_cast<float>(x.hubs[c.hub]);
        r.hubs[c.hub] += static_cast<double>(c.weight) * static_cast<double>(x.cells.row(y)[c.x]);
    });
    const std::size_t hubs = b.hubs.size();
    for (std::size_t k = 0; k < hubs; ++k) {
        for (std::size_t j = 0; j < hubs; ++j)
            r.hubs[k] -= level.hub_matrix[k * hubs + j] * x.hubs[j];
    }
    return r;
}

/// Sum of the products, cells row by row in double.
double dot(const GridVector& a, const GridVector& b, const Exec& exec) {
    std::vector<double> rows(static_cast<std::size_t>(a.cells.height()), 0.0);
    for_rows(a.cells.height(), exec, [&](int y) {
        double sum = 0;
        for (int x = 0; x < a.cells.width(); ++x)
            sum += static_cast<double>(a.cells.row(y)[x]) * static_cast<double>(b.cells.row(y)[x]);
        rows[static_cast<std::size_t>(y)] = sum;
    });
    double sum = 0;
    for (const double row : rows)
        sum += row;
    for (std::size_t k = 0; k < a.hubs.size(); ++k)
        sum += a.hubs[k] * b.hubs[k];
    return sum;
}

/// Adds one V-cycle from level l down to what x leaves of b.
void improve(GridHierarchy& h, std::size_t l, const GridVector& b, GridVector& x, const Exec& exec) {
    GridVector r = left_over(h.levels[l], b, x, exec);
    std::vector<double> hubs = r.hubs;
    const std::size_t last = h.levels.size() - 1;
    for (std::size_t i = l; i < last; ++i)
        descend(h.levels[i], i == l ? r.cells : h.levels[i].rhs, h.levels[i + 1], hubs, exec);
    solve_coarsest(h, hubs);
    for (std::size_t i = last - 1; i > l; --i)
        ascend(h.levels[i], h.levels[i].rhs, h.levels[i + 1], hubs, h.levels[i].solution, exec);
    GridVector step{GridPlane(h.levels[l].width, h.levels[l].height), std::move(hubs)};
    ascend(h.levels[l], r.cells, h.levels[l + 1], step.hubs, step.cells, exec);

    // No farther than to the least energy along the correction: sets and anchors may make it too long.
    const double slope = dot(r, step, exec);
    const double curvature = slope - dot(left_over(h.levels[l], r, step, exec), step, exec);
    const double length = slope < curvature ? slope / curvature : 1.0;
    if (!(slope > 0)) return;
    for_rows(h.levels[l].height, exec, [&](int y) {
        for (int i = 0; i < h.levels[l].width; ++i)
            x.cells.row(y)[i] += static_cast<float>(length) * step.cells.row(y)[i];
    });
    for (std::size_t k = 0; k < step.hubs.size(); ++k)
        x.hubs[k] += length * step.hubs[k];
}

}  // namespace

GridVector full_multigrid(GridHierarchy& h, const GridVector& r, const Exec& exec, LevelSeconds& seconds) {
    std::vector<GridVector> b(h.levels.size());
    for (std::size_t l = 0; l + 1 < h.levels.size(); ++l)
        b[l + 1] = restricted(h.levels[l], h.levels[l + 1], l == 0 ? r : b[l], exec);
    GridLevel& coarsest = h.levels.back();
    for (int y = 0; y < coarsest.height; ++y)
        std::copy_n(b.back().cells.row(y), coarsest.relax.count(), coarsest.rhs.row(y));
    GridVector x{GridPlane(coarsest.width, coarsest.height), b.back().hubs};
    solve_coarsest(h, x.hubs);
    for (int y = 0; y < coarsest.height; ++y)
        std::copy_n(coarsest.solution.row(y), coarsest.relax.count(), x.cells.row(y));
    for (std::size_t l = h.levels.size() - 1; l-- > 0;) {
        const LevelClock clock(seconds, l);
        x = interpolated(h.levels[l], h.levels[l + 1], x, exec);
        improve(h, l, l == 0 ? r : b[l], x, exec);
    }
    return x;
}

}  // namespace obscura
