#include "stereo/solver/grid_couplings.h"

#include <algorithm>
#include <tuple>

#include "core/parallel.h"
#include "stereo/solver/grid_restrict.h"

namespace obscura {
namespace {

bool before(const GridHierarchy::Pixel& a, const GridHierarchy::Pixel& b) {
    return std::tie(a.y, a.x) < std::tie(b.y, b.x);
}

int index_of(const std::vector<GridHierarchy::Pixel>& hubs, int x, int y) {
    const GridHierarchy::Pixel pixel{x, y};
    const auto it = std::lower_bound(hubs.begin(), hubs.end(), pixel, before);
    return it != hubs.end() && it->x == x && it->y == y ? static_cast<int>(it - hubs.begin()) : -1;
}

bool is_valid(const DisparitySystem& s, int x, int y) {
    return x >= 0 && y >= 0 && x < s.width() && y < s.height() && s.valid(x, y) != 0;
}

/// Collects the terms weight (hub - pixel)^2.
struct Collector {
    const std::vector<GridHierarchy::Pixel>& hubs;
    std::vector<double>& matrix;
    std::vector<PlacedCoupling> placed;

    double& entry(std::size_t row, std::size_t column) { return matrix[row * hubs.size() + column]; }
    void add(std::size_t hub, int x, int y, float weight) {
        const int other = index_of(hubs, x, y);
        if (other == static_cast<int>(hub)) return;
        entry(hub, hub) += static_cast<double>(weight);
        if (other < 0) {
            placed.push_back({x, y, static_cast<std::uint32_t>(hub), weight});
        } else {
            const auto o = static_cast<std::size_t>(other);
            entry(o, o) += static_cast<double>(weight);
            entry(hub, o) -= static_cast<double>(weight);
            entry(o, hub) -= static_cast<double>(weight);
        }
    }
};

/// The part of a level that one hub's couplings lie in, as a plane of its own.
struct HubWindow {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< half open; corners are even, a margin is around what is inside
};

HubWindow window_of(const GridLevel& level, std::uint32_t hub) {
    HubWindow w{level.width, level.height, 0, 0};
    for (int y = 0; y < level.height; ++y) {
        for_couplings(level, y, [&](const Coupling& c) {
            if (c.hub != hub) return;
            w.x0 = std::min(w.x0, c.x);
            w.x1 = std::max(w.x1, c.x + 1);
            w.y0 = std::min(w.y0, y);
            w.y1 = y + 1;
        });
    }
    if (w.x0 >= w.x1) return {};
    w.x0 = std::max(w.x0 - 2, 0) / 2 * 2;
    w.y0 = std::max(w.y0 - 2, 0) / 2 * 2;
    w.x1 = std::min((w.x1 + 3) / 2 * 2, level.width);
    w.y1 = std::min((w.y1 + 3) / 2 * 2, level.height);
    return w;
}

/// Restricts one hub's lumped weights to the next level's cells.
void restrict_hub(const GridLevel& fine, std::uint32_t hub, const LevelPulls& known,
                  std::vector<PlacedCoupling>& out) {
    const HubWindow w = window_of(fine, hub);
    if (w.x0 >= w.x1) return;
    GridPlane pulls(w.x1 - w.x0, w.y1 - w.y0);
    for (int y = w.y0; y < w.y1; ++y) {
        for_couplings(fine, y, [&](const Coupling& c) {
            if (c.hub != hub) return;
            // Where the hub takes part in interpolation, x - hub is only (1 - all members' share) of the
            // smooth part's difference to it.
            const float all = known.member.row(y)[c.x] / fine.diagonal.row(y)[c.x];
            const float left = c.share > 0 ? 1.0f - all : 1.0f;
            const float spread = known.spread.empty() ? 1.0f : known.spread.row(y)[c.x];
            pulls.row(y - w.y0)[c.x - w.x0] = c.weight * left * left * spread;
        });
    }
    const int fine_width = w.x1 - w.x0, fine_height = w.y1 - w.y0;
    const int width = (fine_width + 1) / 2, height = (fine_height + 1) / 2;
    RowRing scratch(fine_width + 32, 3);
    GridPlane result(width, 1);
    for (int Y = 0; Y < height; ++Y) {
        const float* sources[4];
        restrict_sources(
            Y, fine_height, pulls.row(-1), [&](int y) { return pulls.row(y); }, sources);
        ref::restrict_row(sources, fine_width, width, scratch.row(0), result.row(0));
        for (int X = 0; X < width; ++X) {
            const float weight = result.row(0)[X];
            const int x = X + w.x0 / 2, y = Y + w.y0 / 2;
            if (weight > 0 && known.coarse(x, y) != 0) out.push_back({x, y, hub, weight});
        }
    }
}

}  // namespace

std::vector<GridHierarchy::Pixel> source_pixels(const DisparitySystem& s) {
    std::vector<GridHierarchy::Pixel> pixels;
    for (const MatchingSet& set : s.sets) {
        if (is_valid(s, set.source_x, set.source_y)) pixels.push_back({set.source_x, set.source_y});
    }
    std::sort(pixels.begin(), pixels.end(), before);
    const auto same = [](const auto& a, const auto& b) { return a.x == b.x && a.y == b.y; };
    pixels.erase(std::unique(pixels.begin(), pixels.end(), same), pixels.end());
    return pixels;
}

std::vector<PlacedCoupling> finest_couplings(const DisparitySystem& s,
                                             const std::vector<GridHierarchy::Pixel>& hubs,
                                             std::vector<double>& hub_matrix) {
    hub_matrix.assign(hubs.size() * hubs.size(), 0.0);
    Collector collect{hubs, hub_matrix, {}};
    const float edge = 2 * s.gradient_weight;
    for (std::size_t k = 0; k < hubs.size(); ++k) {
        const auto [x, y] = hubs[k];
        collect.entry(k, k) += static_cast<double>(s.epsilon) + static_cast<double>(s.anchor_weight(x, y));
        const int neighbour[4][2] = {{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}};
        for (const auto& n : neighbour) {
            if (!is_valid(s, n[0], n[1])) continue;
            // A pair of hubs is one edge, met from both ends.
            const int other = index_of(hubs, n[0], n[1]);
            if (other >= 0 && static_cast<std::size_t>(other) < k) continue;
            collect.add(k, n[0], n[1], edge);
        }
    }
    for (const MatchingSet& set : s.sets) {
        const int hub = index_of(hubs, set.source_x, set.source_y);
        if (hub < 0) continue;
        for (const MatchedPixel& p : set.members) {
            if (is_valid(s, p.x, p.y)) collect.add(static_cast<std::size_t>(hub), p.x, p.y, set.weight);
        }
    }
    return std::move(collect.placed);
}

void file_couplings(std::vector<PlacedCoupling> placed, std::size_t hubs, GridLevel& level,
                    GridPlane& member) {
    level.coupling_rows.assign(static_cast<std::size_t>(level.height) + 1, 0);
    level.couplings.clear();
    if (hubs == 0) return;
    std::stable_sort(placed.begin(), placed.end(), [](const PlacedCoupling& a, const PlacedCoupling& b) {
        return std::tie(a.y, a.x, a.hub) < std::tie(b.y, b.x, b.hub);
    });
    std::int32_t last_y = -1;
    for (const PlacedCoupling& c : placed) {
        member.row(c.y)[c.x] += c.weight;
        const bool same =
            last_y == c.y && level.couplings.back().x == c.x && level.couplings.back().hub == c.hub;
        if (same) {
            level.couplings.back().weight += c.weight;
        } else {
            level.couplings.push_back({c.x, c.hub, c.weight, 0.0f});
            ++level.coupling_rows[static_cast<std::size_t>(c.y) + 1];
        }
        last_y = c.y;
    }
    for (std::size_t y = 0; y < static_cast<std::size_t>(level.height); ++y)
        level.coupling_rows[y + 1] += level.coupling_rows[y];
}

std::vector<PlacedCoupling> coarse_couplings(const GridLevel& fine, std::size_t hubs, const LevelPulls& pulls,
                                             const Exec& exec, std::vector<double>& hub_matrix) {
    // A stiff cell's members pull (x - h_k) with x = kept * smooth + sum of share_j h_j; what that leaves
    // between the hubs themselves goes into their matrix.
    hub_matrix = fine.hub_matrix;
    for (int y = 0; y < fine.height; ++y) {
        const auto row = static_cast<std::size_t>(y);
        const std::uint32_t end = fine.coupling_rows[row + 1];
        for (std::uint32_t i = fine.coupling_rows[row]; i < end;) {
            std::uint32_t last = i;
            while (last < end && fine.couplings[last].x == fine.couplings[i].x)
                ++last;
            if (fine.couplings[i].share > 0) {
                const auto d = static_cast<double>(fine.diagonal.row(y)[fine.couplings[i].x]);
                const auto all = static_cast<double>(pulls.member.row(y)[fine.couplings[i].x]);
                const double taken = 2 / d - all / (d * d);
                for (std::uint32_t a = i; a < last; ++a) {
                    for (std::uint32_t b = i; b < last; ++b) {
                        const Coupling &j = fine.couplings[a], &k = fine.couplings[b];
                        hub_matrix[j.hub * hubs + k.hub] -=
                            taken * static_cast<double>(j.weight) * static_cast<double>(k.weight);
                    }
                }
            }
            i = last;
        }
    }
    std::vector<std::vector<PlacedCoupling>> per_hub(hubs);
    parallel_for(hubs, exec, [&](std::size_t k) {
        restrict_hub(fine, static_cast<std::uint32_t>(k), pulls, per_hub[k]);
    });
    std::vector<PlacedCoupling> placed;
    for (const auto& list : per_hub)
        placed.insert(placed.end(), list.begin(), list.end());
    return placed;
}

}  // namespace obscura
