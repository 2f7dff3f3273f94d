#include "stereo/hidden_change.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "core/union_find.h"
#include "stereo/affine_fit.h"

namespace obscura {
namespace {

constexpr std::size_t block_points = 2048;
constexpr int smoothing_sweeps = 8;

/// Which points have their change.
using Known = std::vector<std::uint8_t>;

/// Triangles with a corner that is not known.
std::vector<std::uint32_t> unfinished(std::span<const Triangle> triangles, const Known& known) {
    std::vector<std::uint32_t> list;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto& p = triangles[t].v;
        if ((known[p[0]] & known[p[1]] & known[p[2]]) == 0) list.push_back(t);
    }
    return list;
}

/// Step 1: the plane through what a triangle shows, at its hidden corners; the mean over a corner's
/// triangles, by the pixels they show.
void extend_seen_triangles(const SeenChange& seen, std::span<const Triangle> triangles,
                           const TrianglePixels& pixels, const Exec& exec, std::vector<SurfacePoint>& points,
                           Known& known) {
    std::vector<std::uint32_t> list = unfinished(triangles, known);
    std::erase_if(list, [&](std::uint32_t t) { return pixels.of(t).empty(); });
    struct Corners {
        double change[3];
    };
    std::vector<Corners> fitted(list.size());
    parallel_blocks(list.size(), 64, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            AffineFit fit;
            for (const std::uint32_t pixel : pixels.of(list[i])) {
                const auto width = static_cast<std::uint32_t>(seen.view.width());
                const std::uint32_t x = pixel % width, y = pixel / width;
                fit.add({x + 0.5, y + 0.5}, static_cast<double>(seen.at(pixel)), 1);
            }
            for (int k = 0; k < 3; ++k) {
                const MapPoint& at = points[triangles[list[i]].v[k]].map;
                // A plane over the screen goes on behind the camera, by the same formula.
                fitted[i].change[k] = at.z == 0 ? 0.5 * (fit.low() + fit.high())
                                                : fit.at({at.column(), at.row()}, seen.slack(at));
            }
        }
    });
    std::vector<double> sum(points.size(), 0), weight(points.size(), 0);
    for (std::size_t i = 0; i < list.size(); ++i) {
        const auto count = static_cast<double>(pixels.of(list[i]).size());
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t p = triangles[list[i]].v[k];
            sum[p] += count * fitted[i].change[k];
            weight[p] += count;
        }
    }
    for (std::size_t p = 0; p < points.size(); ++p) {
        if (known[p] != 0 || weight[p] == 0) continue;
        points[p].change_px = static_cast<float>(sum[p] / weight[p]);
        known[p] = 1;
    }
}

/// Neighbours along edges, of the points that are not known; one that shares two triangles counts twice.
struct Neighbours {
    std::vector<std::uint32_t> first, list;
    std::span<const std::uint32_t> of(std::uint32_t p) const {
        return {list.data() + first[p], first[p + 1] - first[p]};
    }
};

Neighbours neighbours(std::span<const Triangle> triangles, const Known& known) {
    const std::vector<std::uint32_t> todo = unfinished(triangles, known);
    Neighbours n;
    n.first.assign(known.size() + 1, 0);
    for (const std::uint32_t t : todo) {
        for (const std::uint32_t p : triangles[t].v)
            n.first[p + 1] += known[p] == 0 ? 2 : 0;
    }
    std::partial_sum(n.first.begin(), n.first.end(), n.first.begin());
    n.list.resize(n.first.back());
    std::vector<std::uint32_t> next(n.first.begin(), n.first.end() - 1);
    for (const std::uint32_t t : todo) {
        const auto& v = triangles[t].v;
        for (int k = 0; k < 3; ++k) {
            if (known[v[k]] != 0) continue;
            n.list[next[v[k]]++] = v[(k + 1) % 3];
            n.list[next[v[k]]++] = v[(k + 2) % 3];
        }
    }
    return n;
}

/// Mean change of those neighbours that count.
template <class Counts>
float mean_change(std::span<const std::uint32_t> around, const std::vector<float>& change, Counts&& counts) {
    double sum = 0, weight = 0;
    for (const std::uint32_t q : around) {
        if (!counts(q)) continue;
        sum += static_cast<double>(change[q]);
        weight += 1;
    }
    return static_cast<float>(sum / weight);
}

/// Step 2: rings of hidden points around the known ones, then some smoothing, as the order of rings leaves
/// creases where they meet. Corners that step 1 found far outside of the map say where their triangle leans
/// to, which is nothing to follow.
void spread_over_surface(const SeenChange& seen, std::span<const Triangle> triangles, const Exec& exec,
                         std::vector<SurfacePoint>& points, Known& known) {
    const Neighbours around = neighbours(triangles, known);
    constexpr std::uint32_t never = UINT32_MAX;
    std::vector<std::uint32_t> ring(points.size(), never), hidden, front;
    const auto leads = [&](std::uint32_t p) {
        return known[p] != 0 && (points[p].seen || seen.projection.on_map(points[p].map));
    };
    std::vector<float> change(points.size());  // apart from all else that a point is, which is much
    for (std::uint32_t p = 0; p < points.size(); ++p) {
        change[p] = points[p].change_px;
        if (leads(p)) ring[p] = 0;
    }
    const auto join = [&](std::uint32_t p, std::uint32_t r) {
        ring[p] = r;
        front.push_back(p);
    };
    for (std::uint32_t p = 0; p < points.size(); ++p) {
        const auto list = around.of(p);
        if (std::any_of(list.begin(), list.end(), [&](std::uint32_t q) { return ring[q] == 0; })) join(p, 1);
    }
    for (std::uint32_t r = 1; !front.empty(); ++r) {
        parallel_blocks(front.size(), block_points, exec, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                change[front[i]] =
                    mean_change(around.of(front[i]), change, [&](std::uint32_t q) { return ring[q] < r; });
            }
        });
        hidden.insert(hidden.end(), front.begin(), front.end());
        const std::vector<std::uint32_t> last = std::exchange(front, {});
        for (const std::uint32_t p : last) {
            for (const std::uint32_t q : around.of(p)) {
                if (ring[q] == never && known[q] == 0) join(q, r + 1);
            }
        }
    }
    std::vector<float> smooth(hidden.size());
    for (int sweep = 0; sweep < smoothing_sweeps; ++sweep) {
        parallel_blocks(hidden.size(), block_points, exec, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                smooth[i] = mean_change(around.of(hidden[i]), change,
                                        [&](std::uint32_t q) { return ring[q] != never; });
        });
        for (std::size_t i = 0; i < hidden.size(); ++i)
            change[hidden[i]] = smooth[i];
    }
    for (const std::uint32_t p : hidden) {
        points[p].change_px = change[p];
        known[p] = 1;
    }
}

/// The plane through all that is seen of each object, over the map.
std::vector<AffineFit> object_fits(const SeenChange& seen, std::uint32_t objects) {
    std::vector<AffineFit> fits(objects);
    for (int y = 0; y < seen.view.height(); ++y) {
        for (int x = 0; x < seen.view.width(); ++x) {
            const std::uint32_t object = seen.view.object(x, y);
            if (object < objects && seen.view.triangle(x, y) != nothing_seen)
                fits[object].add({x + 0.5, y + 0.5}, static_cast<double>(seen.change_px(x, y)), 1);
        }
    }
    return fits;
}

/// Steps 3 and 4: parts that hang on nothing seen.
void move_parts_whole(const SeenChange& seen, std::span<const Triangle> triangles,
                      std::vector<SurfacePoint>& points, Known& known) {
    const std::vector<std::uint32_t> todo = unfinished(triangles, known);
    UnionFind parts(points.size());
    for (const std::uint32_t t : todo) {
        parts.unite(triangles[t].v[0], triangles[t].v[1]);
        parts.unite(triangles[t].v[0], triangles[t].v[2]);
    }
    struct Part {
        Vec3d sum;
        double count = 0;
        float change_px = 0;
        bool found = false;
    };
    constexpr std::uint32_t none = UINT32_MAX;
    std::vector<std::uint32_t> number(points.size(), none);  // of the part, at its root
    std::vector<Part> part;
    std::uint32_t objects = 0;
    for (std::uint32_t p = 0; p < points.size(); ++p) {
        if (known[p] != 0) continue;
        const std::uint32_t root = parts.root(p);
        if (number[root] == none) {
            number[root] = static_cast<std::uint32_t>(part.size());
            part.emplace_back();
        }
        Part& of = part[number[root]];
        of.sum = of.sum + to_double(points[p].position);
        of.count += 1;
        if (points[p].object != nothing_seen) objects = std::max(objects, points[p].object + 1);
    }
    const std::vector<AffineFit> fits = object_fits(seen, objects);
    for (std::uint32_t p = 0; p < points.size(); ++p) {
        if (known[p] != 0) continue;
        Part& of = part[number[parts.root(p)]];
        if (!of.found) {
            of.found = true;
            const MapPoint place = seen.projection.project(to_float(of.sum * (1.0 / of.count)));
            const std::uint32_t object = points[p].object;
            const bool fitted = object != nothing_seen && !fits[object].empty();
            of.change_px = !fitted ? change_at_place(seen, place)
                           : seen.projection.in_front(place)
                               ? static_cast<float>(fits[object].at({place.column(), place.row()}, 0.0))
                               : static_cast<float>(0.5 * (fits[object].low() + fits[object].high()));
        }
        points[p].change_px = of.change_px;
        known[p] = 1;
    }
}

}  // namespace

void gather_seen(const SeenChange& seen, const Exec& exec, std::span<SurfacePoint> points) {
    parallel_blocks(points.size(), 1024, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::optional<float> change = gather_change(seen, points[i]);
            points[i].seen = change.has_value();
            if (change) points[i].change_px = *change;
        }
    });
}

void fill_hidden(const SeenChange& seen, std::span<const Triangle> triangles, const TrianglePixels& pixels,
                 const Exec& exec, std::vector<SurfacePoint>& points) {
    Known known(points.size());
    for (std::size_t p = 0; p < points.size(); ++p)
        known[p] = points[p].seen ? 1 : 0;
    const auto all_known = [&] { return std::find(known.begin(), known.end(), 0) == known.end(); };
    if (all_known()) return;
    extend_seen_triangles(seen, triangles, pixels, exec, points, known);
    spread_over_surface(seen, triangles, exec, points, known);
    if (!all_known()) move_parts_whole(seen, triangles, points, known);
}

}  // namespace obscura
