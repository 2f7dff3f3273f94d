#include "hierarchy/terrain/day_light.h"

#include <algorithm>
#include <cstddef>

#include "core/error.h"
#include "core/num.h"
#include "core/parallel.h"
#include "raster/heights/height_horizon.h"
#include "raster/heights/height_sweep.h"

namespace obscura {
namespace {

constexpr int whole[] = {0};

/// Suns whose shadows are found at a time.
constexpr std::size_t together = 16;

void add_hard(const HeightField& field, std::span<const FarSun> suns, const Exec& exec, Image<float>& hours) {
    std::vector<ShadowBits> dark(suns.size());
    parallel_for(suns.size(), exec,
                 [&](std::size_t i) { dark[i] = sweep_shadows(field, suns[i].direction, whole)[0]; });
    parallel_for(static_cast<std::size_t>(field.height()), exec, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (std::size_t i = 0; i < suns.size(); ++i) {
            const auto more = static_cast<float>(suns[i].hours);
            for (int x = 0; x < field.width(); ++x)
                hours(x, y) += dark[i](x, y) ? 0.0f : more;
        }
    });
}

}  // namespace

Image<float> lit_shares(const HeightField& field, const FarSun& sun, double disc_radius_deg,
                        const Exec& exec) {
    CHECK(disc_radius_deg >= 0);
    Image<float> shares(field.width(), field.height());
    if (disc_radius_deg == 0) {
        const ShadowBits dark = sweep_shadows(field, sun.direction, whole)[0];
        for (int y = 0; y < field.height(); ++y) {
            for (int x = 0; x < field.width(); ++x)
                shares(x, y) = dark(x, y) ? 0.0f : 1.0f;
        }
        return shares;
    }
    const Image<float> tangents = horizon_tangents(field, sun.direction, exec);
    parallel_for(static_cast<std::size_t>(field.height()), exec, [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < field.width(); ++x) {
            const double horizon_deg = num::atan(static_cast<double>(tangents(x, y))) * (180 / num::pi);
            shares(x, y) =
                static_cast<float>(lit_share_of_disc(sun.elevation_deg, horizon_deg, disc_radius_deg));
        }
    });
    return shares;
}

Image<float> lit_hours(const HeightField& field, std::span<const FarSun> suns, double disc_radius_deg,
                       const Exec& exec, const FarDayWatch& watch) {
    Image<float> hours(field.width(), field.height());
    if (disc_radius_deg > 0) {
        for (std::size_t i = 0; i < suns.size() && !stopped(watch.cancel); ++i) {
            const Image<float> shares = lit_shares(field, suns[i], disc_radius_deg, exec);
            const auto more = static_cast<float>(suns[i].hours);
            for (std::size_t p = 0; p < hours.pixels.size(); ++p)
                hours.pixels[p] += more * shares.pixels[p];
            if (watch.progress) watch.progress(static_cast<int>(i + 1));
        }
        return hours;
    }
    for (std::size_t first = 0; first < suns.size() && !stopped(watch.cancel); first += together) {
        const auto part = suns.subspan(first, std::min(together, suns.size() - first));
        add_hard(field, part, exec, hours);
        if (watch.progress) watch.progress(static_cast<int>(first + part.size()));
    }
    return hours;
}

}  // namespace obscura
