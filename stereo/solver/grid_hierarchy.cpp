#include "stereo/solver/grid_hierarchy.h"

#include <algorithm>
#include <cstring>
#include <tuple>

#include "stereo/grid_tasks.h"
#include "stereo/solver/dense_cholesky.h"
#include "stereo/solver/grid_couplings.h"
#include "stereo/solver/grid_restrict.h"

namespace obscura {
namespace {

constexpr int coarsest_side = 8;

/// Which cells the next level has: those with an unknown of this one inside.
Image<std::uint8_t> coarse_cells(const Image<std::uint8_t>& fine, const Exec& exec) {
    Image<std::uint8_t> coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
    for_rows(coarse.height, exec, [&](int Y) {
        const std::uint8_t* a = fine.row(2 * Y);
        const std::uint8_t* b = fine.row(std::min(2 * Y + 1, fine.height - 1));
        for (int X = 0; X < coarse.width; ++X) {
            const int right = std::min(2 * X + 1, fine.width - 1);
            coarse(X, Y) = static_cast<std::uint8_t>(a[2 * X] | a[right] | b[2 * X] | b[right]);
        }
    });
    return coarse;
}

/// 1 / the bilinear weights of the coarse cells around (x, y) that exist.
float spread_at(const Image<std::uint8_t>& coarse, int x, int y) {
    const int X = x / 2, Y = y / 2;
    const int X2 = std::clamp(X + (x % 2 == 0 ? -1 : 1), 0, coarse.width - 1);
    const int Y2 = other_coarse_row(y, coarse.height);
    const auto exists = [&](int i, int j) { return static_cast<float>(coarse(i, j)); };
    return 1.0f / (0.75f * (0.75f * exists(X, Y) + 0.25f * exists(X2, Y)) +
                   0.25f * (0.75f * exists(X, Y2) + 0.25f * exists(X2, Y2)));
}

/// Sum of the edges of row y's cells.
void sum_edges(const Image<std::uint8_t>& cells, const GridLevel& level, int y, float* edges) {
    if (level.uniform_edge > 0) {
        const std::uint8_t* here = cells.row(y);
        const std::uint8_t* above = cells.row(std::max(y - 1, 0));
        const std::uint8_t* below = cells.row(std::min(y + 1, level.height - 1));
        const int up = y > 0 ? 1 : 0, down = y + 1 < level.height ? 1 : 0, last = level.width - 1;
        const auto weight = [&](int x, int left, int right) {
            const int count = left + right + up * above[x] + down * below[x];
            return level.uniform_edge * static_cast<float>(count);
        };
        edges[0] = weight(0, 0, last > 0 ? here[1] : 0);
        for (int x = 1; x < last; ++x)
            edges[x] = weight(x, here[x - 1], here[x + 1]);
        if (last > 0) edges[last] = weight(last, here[last - 1], 0);
        return;
    }
    const float *right = level.edge_x.row(y), *up = level.edge_y.row(y - 1), *down = level.edge_y.row(y);
    for (int x = 0; x < level.width; ++x)
        edges[x] = (right[x - 1] + right[x]) + (up[x] + down[x]);
}

/// Diagonal out of edges and pulls.
void set_diagonal(const Image<std::uint8_t>& cells, const LevelPulls& pulls, const Exec& exec,
                  GridLevel& level) {
    level.diagonal = GridPlane::framed(level.width, level.height);
    level.relax = GridPlane::framed(level.width, level.height);
    for_rows(level.height, exec, [&](int y) {
        const std::uint8_t* here = cells.row(y);
        const float* anchor = pulls.anchor.row(y);
        float *diagonal = level.diagonal.row(y), *relax = level.relax.row(y);
        sum_edges(cells, level, y, diagonal);
        if (!pulls.member.empty()) {
            const float* member = pulls.member.row(y);
            for (int x = 0; x < level.width; ++x)
                diagonal[x] += anchor[x] + member[x];
        } else {
            for (int x = 0; x < level.width; ++x)
                diagonal[x] += anchor[x];
        }
        constexpr auto damping = static_cast<float>(jacobi_damping);
        for (int x = 0; x < level.width; ++x) {
            // A cell with neither edges nor pulls, left of an island of one pixel, is not an unknown.
            const bool unknown = here[x] != 0 && diagonal[x] > 0;
            relax[x] = unknown ? damping / diagonal[x] : 0.0f;
            diagonal[x] = unknown ? diagonal[x] : 0.0f;
        }
    });
}

/// All that pulls cells of row y, into `out`.
void sum_pulls(const LevelPulls& pulls, int y, int width, float* out) {
    const float* anchor = pulls.anchor.row(y);
    if (pulls.member.empty()) {
        std::copy_n(anchor, width, out);
        return;
    }
    const float* member = pulls.member.row(y);
    for (int x = 0; x < width; ++x)
        out[x] = anchor[x] + member[x];
}

/// Some cell's interpolation is not smooth.
bool any_stiff(const GridLevel& level, const LevelPulls& pulls, const Exec& exec) {
    std::vector<std::uint8_t> rows(static_cast<std::size_t>(level.height), 0);
    for_rows(level.height, exec, [&](int y) {
        std::vector<float> pull(static_cast<std::size_t>(level.width));
        sum_pulls(pulls, y, level.width, pull.data());
        const float* diagonal = level.diagonal.row(y);
        int count = 0;
        for (int x = 0; x < level.width; ++x)
            count += is_stiff(pull[static_cast<std::size_t>(x)], diagonal[x]) ? 1 : 0;
        rows[static_cast<std::size_t>(y)] = count > 0 ? 1 : 0;
    });
    return std::find(rows.begin(), rows.end(), 1) != rows.end();
}

/// Shares of hubs in interpolation, and the scale of the rest.
void set_interpolation(const Image<std::uint8_t>& cells, LevelPulls& pulls, const Exec& exec,
                       GridLevel& level) {
    // Where the next level has all its cells, interpolation has all its parts, whatever is missing here.
    const bool masked = std::memchr(pulls.coarse.pixels.data(), 0, pulls.coarse.pixels.size()) != nullptr;
    if (!masked && !any_stiff(level, pulls, exec)) return;
    if (masked) pulls.spread = GridPlane(level.width, level.height);
    level.scale = GridPlane(level.width, level.height);
    for_rows(level.height, exec, [&](int y) {
        std::vector<float> pull(static_cast<std::size_t>(level.width));
        sum_pulls(pulls, y, level.width, pull.data());
        const float* diagonal = level.diagonal.row(y);
        float* scale = level.scale.row(y);
        for (int x = 0; x < level.width; ++x) {
            if (cells(x, y) == 0) continue;
            float value = kept_share(pull[static_cast<std::size_t>(x)], diagonal[x]);
            if (masked) value *= pulls.spread.row(y)[x] = spread_at(pulls.coarse, x, y);
            scale[x] = value;
        }
        for_couplings(level, y, [&](Coupling& c) {
            const bool stiff = is_stiff(pull[static_cast<std::size_t>(c.x)], diagonal[c.x]);
            c.share = stiff ? c.weight / diagonal[c.x] : 0.0f;
        });
    });
}

/// What anchors weigh for the next level: those of the interpolated values.
GridPlane lumped_anchors(const GridLevel& fine, const LevelPulls& pulls, const Exec& exec) {
    GridPlane lumped = GridPlane::framed(fine.width, fine.height);
    for_rows(fine.height, exec, [&](int y) {
        std::vector<float> pull(static_cast<std::size_t>(fine.width));
        sum_pulls(pulls, y, fine.width, pull.data());
        const float *anchor = pulls.anchor.row(y), *diagonal = fine.diagonal.row(y);
        const float* spread = pulls.spread.empty() ? nullptr : pulls.spread.row(y);
        float* out = lumped.row(y);
        for (int x = 0; x < fine.width; ++x) {
            const float kept = kept_share(pull[static_cast<std::size_t>(x)], diagonal[x]);
            const float value = anchor[x] * kept * kept * (spread != nullptr ? spread[x] : 1.0f);
            out[x] = diagonal[x] > 0 ? value : 0.0f;
        }
    });
    return lumped;
}

/// Anchors of the next level.
GridPlane coarse_anchors(const GridLevel& fine, const LevelPulls& pulls, const Exec& exec) {
    GridPlane own;
    if (!fine.scale.empty()) own = lumped_anchors(fine, pulls, exec);
    const GridPlane& lumped = fine.scale.empty() ? pulls.anchor : own;
    const int width = pulls.coarse.width, height = pulls.coarse.height;
    GridPlane coarse = GridPlane::framed(width, height);
    for_rows(height, exec, [&](int Y) {
        RowRing scratch(fine.width + 32, 3);
        const float* sources[4];
        restrict_sources(
            Y, fine.height, lumped.row(-1), [&](int y) { return lumped.row(y); }, sources);
        float* out = coarse.row(Y);
        OBSCURA_DISPATCH(exec.isa, restrict_row, sources, fine.width, width, scratch.row(0), out);
        for (int X = 0; X < width; ++X)
            out[X] = pulls.coarse(X, Y) != 0 ? out[X] : 0.0f;
    });
    return coarse;
}

/// Edges of the next level: half the sum of the two that cross a side of a cell.
void set_coarse_edges(const GridLevel& fine, const Image<std::uint8_t>& fine_cells, const Exec& exec,
                      GridLevel& level) {
    level.edge_x = GridPlane(level.width, level.height);
    level.edge_y = GridPlane(level.width, level.height);
    const auto uniform = [&](int x, int y, int x2, int y2) {
        if (x2 >= fine.width || y2 >= fine.height || x >= fine.width || y >= fine.height) return 0.0f;
        return fine_cells(x, y) != 0 && fine_cells(x2, y2) != 0 ? fine.uniform_edge : 0.0f;
    };
    const bool finest = fine.uniform_edge > 0;
    for_rows(level.height, exec, [&](int Y) {
        float *right = level.edge_x.row(Y), *down = level.edge_y.row(Y);
        const int y = 2 * Y;
        for (int X = 0; X < level.width; ++X) {
            const int x = 2 * X;
            if (finest) {
                right[X] = 0.5f * (uniform(x + 1, y, x + 2, y) + uniform(x + 1, y + 1, x + 2, y + 1));
                down[X] = 0.5f * (uniform(x, y + 1, x, y + 2) + uniform(x + 1, y + 1, x + 1, y + 2));
            } else {
                right[X] = 0.5f * (fine.edge_x.row(y)[x + 1] + fine.edge_x.row(y + 1)[x + 1]);
                down[X] = y + 1 < fine.height
                              ? 0.5f * (fine.edge_y.row(y + 1)[x] + fine.edge_y.row(y + 1)[x + 1])
                              : 0.0f;
            }
        }
    });
}

/// Coarse cells that hold unknowns which nothing joins inside of them: things apart, as poles before a sky.
std::int64_t cells_shared(const GridLevel& fine, const Image<std::uint8_t>& cells) {
    std::int64_t shared = 0;
    const auto there = [&](int x, int y) { return x < fine.width && y < fine.height && cells(x, y) != 0; };
    const auto joined = [&](int x, int y, int x2, int y2) {
        if (!there(x, y) || !there(x2, y2)) return 0;
        if (fine.uniform_edge > 0) return 1;
        return (y == y2 ? fine.edge_x.row(y)[x] : fine.edge_y.row(y)[x]) > 0 ? 1 : 0;
    };
    for (int y = 0; y < fine.height; y += 2) {
        for (int x = 0; x < fine.width; x += 2) {
            const int count = there(x, y) + there(x + 1, y) + there(x, y + 1) + there(x + 1, y + 1);
            const int edges = joined(x, y, x + 1, y) + joined(x, y + 1, x + 1, y + 1) +
                              joined(x, y, x, y + 1) + joined(x + 1, y, x + 1, y + 1);
            shared += edges < count - 1 ? 1 : 0;
        }
    }
    return shared;
}

void finish_level(const Image<std::uint8_t>& cells, LevelPulls& pulls, const Exec& exec, GridLevel& level) {
    set_diagonal(cells, pulls, exec, level);
    pulls.coarse = coarse_cells(cells, exec);
    set_interpolation(cells, pulls, exec, level);
}

GridLevel finest_level(const DisparitySystem& s, const GridHierarchy& h, const Exec& exec,
                       Image<std::uint8_t>& cells, LevelPulls& pulls) {
    GridLevel level;
    level.width = s.width();
    level.height = s.height();
    level.uniform_edge = 2 * s.gradient_weight;
    cells = s.valid;
    for (const GridHierarchy::Pixel& hub : h.hubs)
        cells(hub.x, hub.y) = 0;
    pulls.anchor = GridPlane::framed(level.width, level.height);
    for_rows(level.height, exec, [&](int y) {
        float* anchor = pulls.anchor.row(y);
        const float* weight = s.anchor_weight.row(y);
        const std::uint8_t* here = cells.row(y);
        for (int x = 0; x < level.width; ++x)
            anchor[x] = here[x] != 0 ? s.epsilon + weight[x] : 0.0f;
    });
    if (!h.hubs.empty()) pulls.member = GridPlane(level.width, level.height);
    file_couplings(finest_couplings(s, h.hubs, level.hub_matrix), h.hubs.size(), level, pulls.member);
    finish_level(cells, pulls, exec, level);
    return level;
}

GridLevel coarser_level(const GridLevel& fine, std::size_t hubs, const Exec& exec, Image<std::uint8_t>& cells,
                        LevelPulls& pulls) {
    GridLevel level;
    level.width = (fine.width + 1) / 2;
    level.height = (fine.height + 1) / 2;
    set_coarse_edges(fine, cells, exec, level);
    LevelPulls next;
    next.anchor = coarse_anchors(fine, pulls, exec);
    if (hubs > 0) next.member = GridPlane(level.width, level.height);
    std::vector<PlacedCoupling> placed;
    if (hubs > 0) placed = coarse_couplings(fine, hubs, pulls, exec, level.hub_matrix);
    file_couplings(std::move(placed), hubs, level, next.member);
    cells = std::move(pulls.coarse);
    pulls = std::move(next);
    finish_level(cells, pulls, exec, level);
    level.rhs = GridPlane(level.width, level.height);
    level.solution = GridPlane(level.width, level.height);
    return level;
}

/// The coarsest level as one dense matrix: cells that exist, then hubs.
void factor_coarsest(GridHierarchy& h) {
    const GridLevel& level = h.levels.back();
    Image<std::int32_t> index(level.width, level.height, -1);
    for (int y = 0; y < level.height; ++y) {
        for (int x = 0; x < level.width; ++x) {
            if (!(level.diagonal.row(y)[x] > 0)) continue;
            index(x, y) = static_cast<std::int32_t>(h.unknowns.size());
            h.unknowns.push_back(y * level.width + x);
        }
    }
    const std::size_t cells = h.unknowns.size(), hubs = h.hubs.size(), n = cells + hubs;
    h.factor.assign(n * n, 0.0);
    const auto put = [&](std::size_t a, std::size_t b, double value) {
        h.factor[std::max(a, b) * n + std::min(a, b)] += value;
    };
    const auto edge = [&](int x, int y, int x2, int y2, float weight) {
        if (weight > 0 && index(x, y) >= 0 && index(x2, y2) >= 0)
            put(static_cast<std::size_t>(index(x, y)), static_cast<std::size_t>(index(x2, y2)),
                -static_cast<double>(weight));
    };
    const bool uniform = level.uniform_edge > 0;
    for (int y = 0; y < level.height; ++y) {
        for (int x = 0; x < level.width; ++x) {
            if (index(x, y) < 0) continue;
            const auto i = static_cast<std::size_t>(index(x, y));
            put(i, i, static_cast<double>(level.diagonal.row(y)[x]));
            if (x + 1 < level.width)
                edge(x, y, x + 1, y, uniform ? level.uniform_edge : level.edge_x.row(y)[x]);
            if (y + 1 < level.height)
                edge(x, y, x, y + 1, uniform ? level.uniform_edge : level.edge_y.row(y)[x]);
        }
        for_couplings(level, y, [&](const Coupling& c) {
            put(cells + c.hub, static_cast<std::size_t>(index(c.x, y)), -static_cast<double>(c.weight));
        });
    }
    for (std::size_t a = 0; a < hubs; ++a) {
        for (std::size_t b = 0; b <= a; ++b)
            put(cells + a, cells + b, level.hub_matrix[a * hubs + b]);
    }
    factor_cholesky(static_cast<int>(n), h.factor);
}

}  // namespace

GridHierarchy grid_hierarchy(const DisparitySystem& system, const Exec& exec) {
    GridHierarchy h;
    h.hubs = source_pixels(system);
    Image<std::uint8_t> cells;
    LevelPulls pulls;
    h.levels.push_back(finest_level(system, h, exec, cells, pulls));
    const bool masked = std::memchr(system.valid.pixels.data(), 0, system.valid.pixels.size()) != nullptr;
    while (h.levels.size() < 2 || std::max(h.levels.back().width, h.levels.back().height) > coarsest_side) {
        if (masked) h.shared_cells += cells_shared(h.levels.back(), cells);
        h.levels.push_back(coarser_level(h.levels.back(), h.hubs.size(), exec, cells, pulls));
    }
    factor_coarsest(h);
    return h;
}

int hub_at(const GridHierarchy& h, int x, int y) {
    for (std::size_t k = 0; k < h.hubs.size(); ++k) {
        if (h.hubs[k].x == x && h.hubs[k].y == y) return static_cast<int>(k);
    }
    return -1;
}

bool same_matrix(const DisparitySystem& a, const DisparitySystem& b) {
    if (a.gradient_weight != b.gradient_weight || a.epsilon != b.epsilon || a.valid != b.valid ||
        a.anchor_weight != b.anchor_weight || a.sets.size() != b.sets.size()) {
        return false;
    }
    const auto same_pixels = [](const MatchedPixel& p, const MatchedPixel& q) {
        return p.x == q.x && p.y == q.y;
    };
    for (std::size_t i = 0; i < a.sets.size(); ++i) {
        const MatchingSet &s = a.sets[i], &t = b.sets[i];
        if (s.source_x != t.source_x || s.source_y != t.source_y || s.weight != t.weight ||
            !std::equal(s.members.begin(), s.members.end(), t.members.begin(), t.members.end(),
                        same_pixels)) {
            return false;
        }
    }
    return true;
}

}  // namespace obscura
