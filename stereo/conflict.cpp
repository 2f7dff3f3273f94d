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
    // NOLINTNEXTLINE(modernize-use-nullptr): the compiler's own comparisons with 0
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
    const std::vector<double>& distance;  ///< of each column to the picture's side
    Image<std::uint8_t>& marks;
};

void count(Tallies& tallies, const Key& key, double wrong_px, bool inherited) {
    Tally& tally = tallies[key];
    ++tally.pixels;
    tally.inherited += inherited ? 1 : 0;
    tally.worst_px = std::max(tally.worst_px, wrong_px);
}

bool seen(const MiddleView& view, std::size_t i) {
    return view.object.pixels[i] != nothing_seen && std::isfinite(view.disparity.pixels[i]);
}

/// What is wrong with the step from pixel p to its neighbour q, both seen, by index; 0 for nothing.
std::uint8_t wrong_step(const Scan& s, std::size_t p, std::size_t q, bool across) {
    const double edited = static_cast<double>(s.map.pixels[q]) - static_cast<double>(s.map.pixels[p]);
    const auto original = [&] {
        return static_cast<double>(s.view.disparity.pixels[q]) -
               static_cast<double>(s.view.disparity.pixels[p]);
    };
    if (s.view.object.pixels[p] != s.view.object.pixels[q])
        return inverted(original(), edited, s.limits.meaningful_px)
                   ? conflict_bit(ConflictKind::depth_inversion)
                   : std::uint8_t{0};
    const double fold = fold_step(s.view.reduction);
    if (!across || std::abs(edited) < fold + s.limits.meaningful_px || std::abs(original()) >= fold) return 0;
    return conflict_bit(ConflictKind::fold);
}

void count_step(const Scan& s, std::size_t p, std::size_t q, std::uint8_t wrong, Tallies& tallies) {
    const double step = std::abs(static_cast<double>(s.map.pixels[q]) - static_cast<double>(s.map.pixels[p]));
    const std::uint32_t a = s.view.object.pixels[p], b = s.view.object.pixels[q];
    if (wrong == conflict_bit(ConflictKind::fold)) {
        count(tallies, {ConflictKind::fold, a, nothing_seen, Side::none}, step - fold_step(s.view.reduction),
              false);
        return;
    }
    const bool b_in_front = s.view.disparity.pixels[q] > s.view.disparity.pixels[p];
    count(tallies, {ConflictKind::depth_inversion, b_in_front ? b : a, b_in_front ? a : b, Side::none}, step,
          false);
}

/// Window and comfort, of one pixel.
void look_at_pixel(const Scan& s, int x, std::size_t i, Tallies& tallies) {
    const auto d = static_cast<double>(s.map.pixels[i]),
               original = static_cast<double>(s.view.disparity.pixels[i]);
    const auto found = [&](ConflictKind kind, Side side, double wrong_px, bool inherited) {
        if (wrong_px < s.limits.meaningful_px) return;
        s.marks.pixels[i] |= conflict_bit(kind);
        count(tallies, {kind, s.view.object.pixels[i], nothing_seen, side}, wrong_px, inherited);
    };
    const Side side = 2 * x < s.map.width ? Side::left : Side::right;
    found(ConflictKind::window_violation, side, d - s.distance[static_cast<std::size_t>(x)], original >= d);
    found(ConflictKind::comfort, Side::near, d - s.limits.comfort.nearest_px, original >= d);
    found(ConflictKind::comfort, Side::far, s.limits.comfort.farthest_px - d, original <= d);
}

/// Rows [begin, end). A step is counted where it begins; its second pixel is marked by the rows it is in.
void look_at_rows(const Scan& s, int begin, int end, Tallies& tallies) {
    const auto width = static_cast<std::size_t>(s.map.width);
    for (int y = begin; y < end; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t p = static_cast<std::size_t>(y) * width + x;
            if (!seen(s.view, p)) continue;
            look_at_pixel(s, static_cast<int>(x), p, tallies);
            const auto step_to = [&](std::size_t q, bool across, bool ours) {
                if (!seen(s.view, q)) return;
                const std::uint8_t wrong = wrong_step(s, p, q, across);
                if (wrong == 0) return;
                count_step(s, p, q, wrong, tallies);
                s.marks.pixels[p] |= wrong;
                if (ours) s.marks.pixels[q] |= wrong;
            };
            if (x + 1 < width) step_to(p + 1, true, true);
            if (y + 1 < s.map.height) step_to(p + width, false, y + 1 < end);
            if (y == begin && y > 0 && seen(s.view, p - width))
                s.marks.pixels[p] |= wrong_step(s, p - width, p, false);
        }
    }
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
        valid.pixels[i] = seen(view, i) ? 1 : 0;
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
    std::vector<double> distance;
    distance.reserve(static_cast<std::size_t>(map.width));
    for (int x = 0; x < map.width; ++x)
        distance.push_back(border_distance(view, x));

    Conflicts found;
    found.pixels = Image<std::uint8_t>(map.width, map.height);
    const Scan scan{view, map, limits, distance, found.pixels};
    constexpr std::size_t block = 16;
    const auto height = static_cast<std::size_t>(map.height);
    std::vector<Tallies> partial((height + block - 1) / block);
    parallel_blocks(height, block, exec, [&](std::size_t begin, std::size_t end) {
        look_at_rows(scan, static_cast<int>(begin), static_cast<int>(end), partial[begin / block]);
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
