#include "stereo/thesis/range_remap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/num.h"
#include "core/parallel.h"

namespace obscura {
namespace {

constexpr int knots = 1024;  // of curves that bend
constexpr int bins = 256;

struct Range {
    double low = 0, high = 0;
    bool any = false;
};

Range range_of(const DisparityMap& map, const Image<std::uint8_t>& valid) {
    Range r;
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        if (valid.pixels[i] == 0) continue;
        const auto d = static_cast<double>(map.pixels[i]);
        r.low = r.any ? std::min(r.low, d) : d;
        r.high = r.any ? std::max(r.high, d) : d;
        r.any = true;
    }
    return r;
}

/// [0, 1] to [0, 1], the faster the lower: log(1 + c u) / log(1 + c); for c < 0 turned by half a turn.
double log_share(double curvature, double u) {
    const double c = std::abs(curvature);
    // 1 + c holds no more of c than this; the curve is straight to c / 8.
    if (c < 1e-9) return u;
    const double scale = num::log(1 + c);
    return curvature > 0 ? num::log(1 + c * u) / scale : 1 - num::log(1 + c * (1 - u)) / scale;
}

/// Integral of a slope that is a mix of 1 and of the histogram, over [0, 1] in `bins` steps.
std::vector<double> histogram_shares(const DisparityMap& map, const Image<std::uint8_t>& valid,
                                     const Range& range, double strength) {
    std::vector<std::int64_t> count(bins, 0);
    std::int64_t all = 0;
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        if (valid.pixels[i] == 0) continue;
        const double u = (static_cast<double>(map.pixels[i]) - range.low) / (range.high - range.low);
        ++count[static_cast<std::size_t>(std::clamp(static_cast<int>(u * bins), 0, bins - 1))];
        ++all;
    }
    std::vector<double> share{0};
    std::int64_t sum = 0;
    for (int b = 0; b < bins; ++b) {
        sum += count[static_cast<std::size_t>(b)];
        share.push_back((1 - strength) * (b + 1) / bins +
                        strength * static_cast<double>(sum) / static_cast<double>(all));
    }
    return share;
}

/// Shares of the wanted range at even steps of the map's own.
std::vector<double> shares(const DisparityMap& map, const Image<std::uint8_t>& valid, const Range& range,
                           const RangeRemap& remap) {
    if (remap.kind == RemapKind::linear) return {0, 1};
    if (remap.kind == RemapKind::histogram) {
        CHECK(remap.strength >= 0 && remap.strength <= 1, fmt::format("strength {}", remap.strength));
        return histogram_shares(map, valid, range, remap.strength);
    }
    CHECK(remap.curvature != 0);
    std::vector<double> share;
    for (int k = 0; k <= knots; ++k)
        share.push_back(log_share(remap.curvature, static_cast<double>(k) / knots));
    return share;
}

}  // namespace

std::optional<RemapKind> parse_remap(std::string_view text) {
    constexpr std::pair<std::string_view, RemapKind> names[] = {{"none", RemapKind::none},
                                                                {"linear", RemapKind::linear},
                                                                {"log", RemapKind::logarithmic},
                                                                {"histogram", RemapKind::histogram},
                                                                {"match", RemapKind::match}};
    for (const auto& [name, kind] : names)
        if (name == text) return kind;
    return std::nullopt;
}

double RemapCurve::at(double d) const {
    if (from.empty()) return d;
    if (d <= from.front()) return to.front() + (d - from.front());
    if (d >= from.back()) return to.back() + (d - from.back());
    const auto after = static_cast<std::size_t>(std::upper_bound(from.begin(), from.end(), d) - from.begin());
    const double t = (d - from[after - 1]) / (from[after] - from[after - 1]);
    // Rounding may not carry a value past its knots, or the curve would not be monotone.
    return std::min(to[after - 1] + t * (to[after] - to[after - 1]), to[after]);
}

RemapCurve remap_curve(const DisparityMap& map, const Image<std::uint8_t>& valid, const RangeRemap& remap) {
    CHECK(valid.pixels.size() == map.pixels.size());
    if (remap.kind == RemapKind::none) return {};
    if (remap.kind == RemapKind::match) {
        const auto [low, high] = std::minmax(remap.first_px, remap.second_px);
        if (low == high) return {{low}, {remap.matched_px}};
        return {{low, high}, {remap.matched_px, remap.matched_px}};
    }

    CHECK(remap.nearest_px >= remap.farthest_px,
          fmt::format("{} to {}", remap.farthest_px, remap.nearest_px));
    const Range range = range_of(map, valid);
    if (!range.any) return {};
    if (range.low == range.high)
        return {{range.low}, {std::clamp(range.low, remap.farthest_px, remap.nearest_px)}};
    RemapCurve curve;
    const std::vector<double> share = shares(map, valid, range, remap);
    const auto steps = static_cast<double>(share.size() - 1);
    for (std::size_t k = 0; k < share.size(); ++k) {
        curve.from.push_back(range.low + (range.high - range.low) * (static_cast<double>(k) / steps));
        curve.to.push_back(remap.farthest_px + (remap.nearest_px - remap.farthest_px) * share[k]);
    }
    curve.from.back() = range.high;
    curve.to.back() = remap.nearest_px;
    return curve;
}

DisparityMap remapped(const DisparityMap& map, const Image<std::uint8_t>& valid, const RemapCurve& curve,
                      const Exec& exec) {
    CHECK(valid.pixels.size() == map.pixels.size());
    DisparityMap result = map;
    parallel_blocks(map.pixels.size(), 1 << 14, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (valid.pixels[i] != 0)
                result.pixels[i] = static_cast<float>(curve.at(static_cast<double>(map.pixels[i])));
    });
    return result;
}

}  // namespace obscura
