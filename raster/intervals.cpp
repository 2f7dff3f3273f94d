#include "raster/intervals.h"

#include <cmath>
#include <tuple>

namespace obscura {

bool comes_before(const LayerCrossing& p, const LayerCrossing& q) {
    return std::tie(p.depth, p.crossing, p.triangle) < std::tie(q.depth, q.crossing, q.triangle);
}

float just_before(float depth, float floor) {
    const float below = std::nextafterf(depth, -1.0f);
    return below > floor ? below : floor;
}

DepthInterval interval_of(std::span<const LayerCrossing> ordered, Receivers receivers) {
    int inside = 0;
    float entry = 1.0f;
    for (std::size_t i = 0; i < ordered.size(); ++i) {
        const auto [depth, crossing, triangle] = ordered[i];
        if (inside == 0) {
            if (crossing == Crossing::open && receivers == Receivers::static_only) {
                const bool last = i + 1 == ordered.size();
                return {depth, last ? 1.0f : just_before(ordered[i + 1].depth, depth)};
            }
            if (crossing != Crossing::entry) return {depth, depth};
            entry = depth;
        }
        if (crossing == Crossing::entry) ++inside;
        if (crossing == Crossing::exit && --inside == 0) return {entry, depth};
    }
    return {entry, entry};
}

}  // namespace obscura
