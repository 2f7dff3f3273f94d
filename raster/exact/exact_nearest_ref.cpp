// The nearest triangle before a sample, one sample and one triangle at a time: the definition.

#include <algorithm>
#include <limits>

#include "raster/depth_tile.h"
#include "raster/exact/exact_nearest.h"
#include "raster/exact/exact_question.h"

namespace obscura::ref {

void exact_locate_nearest(const ExactPoints& points, const ExactLight& light, ExactSamples& samples,
                          std::uint32_t* lit, const ExactHits&, ExactCounts&) noexcept {
    samples.count = 0;
    std::fill_n(lit, points.count / 16, 0u);
    for (int at = 0; at < points.count; ++at) {
        const Question q = question(points, light, at);
        if (q.asks) lit[at / 16] |= 1u << (at % 16);
        if (q.looks) add_sample(q, samples);
    }
}

void exact_nearest(const ExactPoints& points, const ExactLight& light, const ExactSamples& samples,
                   const std::uint32_t* order, std::uint32_t* lit, const ExactHits& hits,
                   ExactCounts& counts) noexcept {
    for (std::int32_t k = 0; k < samples.count; ++k) {
        const std::uint32_t i = order[k], at = samples.point[i];
        const ExactView& view = light.view[samples.view[i]];
        const Place place = question(points, light, static_cast<int>(at)).place;
        double nearest = std::numeric_limits<double>::infinity();
        std::uint32_t triangle = no_triangle;
        // Every triangle, whatever the boxes say.
        for (std::size_t c = 0; c < static_cast<std::size_t>(view.count); ++c) {
            const CasterTriangle& t = view.triangles[c];
            ++counts.triangles;
            if (!darkens(t, view.boxes[0][c / 16].z_low[c % 16], light, points, place)) continue;
            const double behind = -((t.n[0] * place.p.x + t.n[1] * place.p.y) + (t.n[2] * place.p.z + t.d));
            const double distance =
                std::max(behind / exact_cosine(t, light),
                         exact_least_distance(view, place.z, view.boxes[0][c / 16].z_high[c % 16]));
            if (!exact_is_nearer(distance, t.triangle, nearest, triangle)) continue;
            nearest = distance;
            triangle = t.triangle;
        }
        if (triangle == no_triangle) continue;
        lit[at / 16] &= ~(1u << (at % 16));
        hits.triangle[at] = triangle;
        hits.distance_m[at] = static_cast<float>(nearest);
    }
    counts.samples += samples.count;
}

}  // namespace obscura::ref
