// Shadows of samples in an order of their own: bunches of sixteen neighbours on the light's grid.

#include "raster/exact/exact_bunch.h"
#include "raster/exact/exact_nearby.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Darkens the open lanes of `n` bunches, which are of one view.
void darken(const ExactPoints& points, const ExactLight& light, const ExactView& view, Bunch* bunch, int n,
            Nearby& nearby, ExactCounts& counts) {
    // Halves, until what is near has room.
    while (n > 1 && !collect(light, view, bunch, n, nearby, counts)) {
        darken(points, light, view, bunch, n / 2, nearby, counts);
        bunch += n / 2;
        n -= n / 2;
    }
    if (n == 1) {
        Bunch& s = bunch[0];
        walk(view, s.extent, counts.groups, [&](const CasterBoxes& boxes, std::uint32_t first, int k) {
            ++counts.triangles;
            s.open &= ~darkened(view.triangles[first + static_cast<std::uint32_t>(k)], boxes.z_low[k], points,
                                light, s);
            return s.open != 0;
        });
        return;
    }
    for (int b = 0; b < n; ++b)
        darken_near(points, light, view, nearby, Nearby::room, bunch[b], counts);
}

}  // namespace

void exact_darken(const ExactPoints& points, const ExactLight& light, const ExactSamples& samples,
                  const std::uint32_t* order, std::uint32_t* lit, ExactCounts& counts) noexcept {
    Bunch bunch[bunches];
    Nearby nearby;
    std::int32_t next = 0;
    while (next < samples.count) {
        const std::uint8_t view = samples.view[order[next]];
        const std::int32_t first = next;
        const int n = gather_bunches(points, light, samples, order, next, bunch);
        darken(points, light, light.view[view], bunch, n, nearby, counts);
        for (std::int32_t i = first; i < next; ++i) {
            const std::int32_t at = i - first;
            if ((bunch[at / lanes].open >> (at % lanes) & 1u) != 0) continue;
            const std::uint32_t point = samples.point[order[i]];
            lit[point / 16] &= ~(1u << (point % 16));
        }
    }
    counts.samples += samples.count;
}

}  // namespace obscura::OBSCURA_ISA
