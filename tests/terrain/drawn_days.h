#pragma once
// Ground and suns that tests of days share.

#include <vector>

#include "core/num.h"
#include "hierarchy/terrain/far_day.h"
#include "tests/heights/drawn_heights.h"

namespace obscura::drawn {

/// Hills with spikes on them.
inline HeightField hills(int width, int height, Diagonal diagonal = Diagonal::falling) {
    HeightField f{Image<std::int32_t>(width, height), 10, 12, diagonal};
    Random random(4);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double m = 60 * num::sin(0.05 * x) + 50 * num::sin(0.04 * y + 0.03 * x) +
                             (below(random, 60) == 0 ? 15 : 2) * unit(random);
            f.height_q16(x, y) = height_q16_of(m);
        }
    }
    return f;
}

inline std::vector<FarSun> suns_over(const HeightField& field, int count) {
    std::vector<FarSun> suns;
    for (int i = 0; i < count; ++i) {
        const double share = (i + 0.5) / count;
        FarSun s{6 + 12 * share, 12.0 / count, 90 + 180 * share, 2 + 40 * num::sin(3.14159 * share), {}};
        s.direction = height_sun(field, s.azimuth_deg, s.elevation_deg);
        suns.push_back(s);
    }
    return suns;
}

}  // namespace obscura::drawn
