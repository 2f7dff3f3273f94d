#include "stereo/conflict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "core/error.h"
#include "core/parallel.h"
#include "stereo/map_columns.h"

namespace obscura {
namespace {

/// Where at the object: which side of the picture, or which end of the comfort zone.
enum class Side { none, left, right, near, far };

struct Key {
    ConflictKind kind;
    std::uint32_t object, behind;
    Side side;
    friend auto operator<=>(const Key&, const Key&) = default;
};
struct Tally {
    std::int64_t pixels = 0, inherited = 0;
    double worst_px = 0;
};
using Tallies = std::map<Key, Tally>;

struct Scan {
    const MiddleView& view;
    const DisparityMap& map;
    const ConflictLimits& limits;
    const Image<std::uint8_t>& valid;
    const std::vector<double>& distance;  ///< of each column to the picture's side
    Image<std::uint8_t>& marks;
};

void count(Tallies& tallies, const Key& key, double wrong_px, bool inherited) {
    Tally& tally = tallies[key];
    ++tally.pixels;
    tally.inherited += inherited ? 1 : 0;
    tally.worst_px = std::max(tally.worst_px, wrong_px);
}

/// Steps between p = (x, y) and a neighbour, both valid. `first`: p comes before it, so the pair is counted.
void look_at_pair(const Scan& s, int x, int y, int nx, int ny, bool first, Tallies& tallies) {
    const double original =
        static_cast<double>(s.view.disparity(nx, ny)) - static_cast<double>(s.view.disparity(x, y));
    const double edited = static_cast<double>(s.map(nx, ny)) - static_cast<double>(s.map(x, y));
    const std::uint32_t p = s.view.object(x, y), q = s.view.object(nx, ny);
    if (p != q) {
        if (!inverted(original, edited, s.limits.meaningful_px)) return;
        s.marks(x, y) |= conflict_bit(ConflictKind::depth_inversion);
        const bool q_in_front = original > 0;
        if (first)
            count(tallies,
                  {ConflictKind::depth_inversion, q_in_front ? q : p, q_in_front ? p : q, Side::none},
                  std::abs(edited), false);
        return;
    }
    const double fold = fold_step(s.view.reduction);
    if (y != ny || std::abs(edited) < fold + s.limits.meaningful_px || std::abs(original) >= fold) return;
    s.marks(x, y) |= conflict_bit(ConflictKind::fold);
    if (first)
        count(tallies, {ConflictKind::fold, p, nothing_seen, Side::none}, std::abs(edited) - fold, false);
}

void look_at_pixel(const Scan& s, int x, int y, Tallies& tallies) {
    const auto d = static_cast<double>(s.map(x, y)), original = static_cast<double>(s.view.disparity(x, y));
    const std::uint32_t object = s.view.object(x, y);
    const auto found = [&](ConflictKind kind, Side side, double wrong_px, bool inherited) {
        if (wrong_px < s.limits.meaningful_px) return;
        s.marks(x, y) |= conflict_bit(kind);
        count(tallies, {kind, object, nothing_seen, side}, wrong_px, inherited);
    };
    const Side side = 2 * picture_x(s.view, x) < s.view.picture_width ? Side::left : Side::right;
    found(ConflictKind::window_violation, side, d - s.distance[static_cast<std::size_t>(x)], original >= d);
    found(ConflictKind::comfort, Side::near, d - s.limits.comfort.nearest_px, original >= d);
    found(ConflictKind::comfort, Side::far, s.limits.comfort.farthest_px - d, original <= d);

    const auto valid = [&](int i, int j) {
        return i >= 0 && j >= 0 && i < s.map.width && j < s.map.height && s.valid(i, j) != 0;
    };
    if (valid(x + 1, y)) look_at_pair(s, x, y, x + 1, y, true, tallies);
    if (valid(x, y + 1)) look_at_pair(s, x, y, x, y + 1, true, tallies);
    if (valid(x - 1, y)) look_at_pair(s, x, y, x - 1, y, false, tallies);
    if (valid(x, y - 1)) look_at_pair(s, x, y, x, y - 1, false, tallies);
}

std::string what(const Key& key, const std::vector<std::string>& names) {
    const auto name = [&](std::uint32_t object) {
        return object < names.size() && !names[object].empty() ? names[object]
                                                               : fmt::format("object {}", object);
    };
    switch (key.side) {
        case Side::left:
            return name(key.object) + " at the left";
        case Side::right:
            return name(key.object) + " at the right";
        case Side::near:
            return name(key.object) + " too near";
        case Side::far:
            return name(key.object) + " too far";
        case Side::none:
            break;
    }
    if (key.kind == ConflictKind::depth_inversion)
        return name(key.object) + " in front of " + name(key.behind);
    return name(key.object);
}

}  // namespace

std::string_view conflict_name(ConflictKind kind) {
    constexpr std::array<std::string_view, conflict_kinds> names = {"depth inversion", "window violation",
                                                                    "outside comfort zone", "fold"};
    return names[static_cast<std::size_t>(kind)];
}

std::int64_t Conflicts::count(ConflictKind kind) const {
    std::int64_t sum = 0;
    for (const Conflict& c : list)
        sum += c.kind == kind ? c.pixels : 0;
    return sum;
}

double Conflicts::worst(ConflictKind kind) const {
    double worst = 0;
    for (const Conflict& c : list)
        if (c.kind == kind) worst = std::max(worst, c.worst_px);
    return worst;
}

Image<std::uint8_t> valid_pixels(const MiddleView& view) {
    Image<std::uint8_t> valid(view.width(), view.height());
    for (std::size_t i = 0; i < valid.pixels.size(); ++i)
        valid.pixels[i] =
            view.object.pixels[i] != nothing_seen && std::isfinite(view.disparity.pixels[i]) ? 1 : 0;
    return valid;
}

double border_distance(const MiddleView& view, int column) {
    const double x = picture_x(view, column);
    return std::min(std::abs(x), std::abs(x - view.picture_width));
}

Conflicts find_conflicts(const MiddleView& view, const DisparityMap& map, const ConflictLimits& limits,
                         const std::vector<std::string>& object_names, const Exec& exec) {
    CHECK(map.width == view.width() && map.height == view.height() &&
          limits.comfort.nearest_px >= limits.comfort.farthest_px);
    const Image<std::uint8_t> valid = valid_pixels(view);
    std::vector<double> distance;
    for (int x = 0; x < map.width; ++x)
        distance.push_back(border_distance(view, x));

    Conflicts found;
    found.pixels = Image<std::uint8_t>(map.width, map.height);
    const Scan scan{view, map, limits, valid, distance, found.pixels};
    constexpr std::size_t block = 16;
    const auto height = static_cast<std::size_t>(map.height);
    std::vector<Tallies> partial((height + block - 1) / block);
    parallel_blocks(height, block, exec, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < map.width; ++x)
                if (valid(x, y) != 0) look_at_pixel(scan, x, y, partial[begin / block]);
    });

    Tallies total;
    for (const Tallies& tallies : partial) {
        for (const auto& [key, tally] : tallies) {
            Tally& sum = total[key];
            sum.pixels += tally.pixels;
            sum.inherited += tally.inherited;
            sum.worst_px = std::max(sum.worst_px, tally.worst_px);
        }
    }
    for (const auto& [key, tally] : total)
        found.list.push_back({key.kind, tally.pixels, tally.inherited, tally.worst_px,
                              what(key, object_names), key.object, key.behind});
    std::stable_sort(found.list.begin(), found.list.end(),
                     [](const Conflict& a, const Conflict& b) { return a.pixels > b.pixels; });
    return found;
}

}  // namespace obscura
