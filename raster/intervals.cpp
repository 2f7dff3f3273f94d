#include "raster/intervals.h"

#include <cmath>
#include <tuple>

namespace obscura {

bool comes_before(const LayerCrossing& p, const LayerCrossing& q) {
    return std::tie(p.depth, p.crossing, p.triangle) < std::tie(q.depth, q.crossing, q.triangle);
}

float just_before(float depth) {
    return std::nextafterf(depth, -1.0f);
}

DepthInterval interval_of(std::span<const LayerCrossing> ordered, Receivers receivers) {
    if (ordered.empty()) return {};
    const float first = ordered.front().depth;
    if (receivers == Receivers::static_only) {
        for (const LayerCrossing& next : ordered) {
            if (next.depth > first) return {first, just_before(next.depth)};
        }
        return {first, 1.0f};
    }
    if (ordered.front().crossing != Crossing::entry) return {first, first};
    int inside = 0;
    for (const LayerCrossing& c : ordered) {
        if (c.crossing == Crossing::entry) ++inside;
        if (c.crossing == Crossing::exit && --inside == 0) return {first, c.depth};
    }
    return {first, first};
}

}  // namespace obscura
