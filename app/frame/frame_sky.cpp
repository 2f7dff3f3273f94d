#include "app/frame/frame_sky.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/frame/tile.h"
#include "core/error.h"
#include "core/num.h"
#include "core/vec_arrays.h"
#include "raster/lighting.h"

namespace obscura {
namespace {

constexpr int least_ground_lights = 4;
/// Directions that patches ask.
constexpr int few_above = 16, few_below = 8;

Vec3f gradient(const Sky& sky, Vec3d direction) {
    const auto y = static_cast<float>(direction.y);
    return sky.horizon + (sky.zenith - sky.horizon) * y;
}

std::optional<SkyModel> model_of(const Sky& sky, const Exec& exec) {
    switch (sky.kind) {
        case SkyKind::gradient:
            return std::nullopt;
        case SkyKind::clear: {
            ClearAirParams params;
            params.turbidity = sky.turbidity;
            params.ground_albedo = to_double(sky.ground_albedo);
            params.sun_above_air_w_m2 = sky.sun_above_air;
            return clear_sky(clear_air(params, exec), sky.sun_azimuth_deg, sky.sun_elevation_deg, exec);
        }
        case SkyKind::overcast:
            return overcast_sky(sky.sun_elevation_deg, sky.sun_above_air, to_double(sky.ground_albedo));
        case SkyKind::image:
            CHECK(sky.image != nullptr, "a sky of an image without one");
            return *sky.image;
    }
    return std::nullopt;
}

/// The lower half of a picture as if it were the upper one.
SkyGrid lower_grid(const ImageSky& sky) {
    ImageSky flipped = sky;
    Image<Vec3f>& image = flipped.pixels;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            image(x, y) = sky.pixels(x, image.height - 1 - y);
    }
    return sky_grid(flipped);
}

/// Of a picture the gradient with the same light on level ground and, where it can, the same in all.
Sky gradient_of(const Sky& sky, const ImageSky& image) {
    const auto sums = [](const SkyGrid& grid) {
        std::pair<Vec3d, Vec3d> mean_and_level;
        auto& [mean, level] = mean_and_level;
        for (const SkyCell& cell : grid.cells) {
            mean = mean + Vec3d{length(cell.red), length(cell.green), length(cell.blue)} * (0.5 / num::pi);
            level = level + Vec3d{cell.red.y, cell.green.y, cell.blue.y} * (1 / num::pi);
        }
        return mean_and_level;
    };
    const auto [mean, level] = sums(sky_grid(image));
    // Means over the hemisphere, and by cosine: (h + z) / 2 and h / 3 + 2 z / 3.
    const auto ends = [](double m, double l) {
        const double zenith = std::clamp(3 * l - 2 * m, 0.0, 1.5 * l);
        return std::pair{3 * l - 2 * zenith, zenith};
    };
    Sky g = sky;
    const auto x = ends(mean.x, level.x), y = ends(mean.y, level.y), z = ends(mean.z, level.z);
    g.horizon = to_float(Vec3d{x.first, y.first, z.first});
    g.zenith = to_float(Vec3d{x.second, y.second, z.second});
    g.ground = to_float(sums(lower_grid(image)).first);
    return g;
}

/// The gradient that is nearest to a model: for what surfaces mirror.
Sky gradient_of(const Sky& sky, const SkyModel& model) {
    if (const auto* image = std::get_if<ImageSky>(&model)) return gradient_of(sky, *image);
    Sky g = sky;
    g.zenith = sky_radiance(model, {0, 1, 0});
    g.ground = sky_radiance(model, {0, -1, 0});
    constexpr int sides = 16;
    Vec3f low{0, 0, 0};
    for (int i = 0; i < sides; ++i) {
        const Vec3d d = compass_direction(360.0 * i / sides, 8);
        low = low + sky_radiance(model, d) * (1.0f / sides);
    }
    g.horizon = low;
    return g;
}

Light parallel(Vec3d towards, Vec3f irradiance) {
    Light light;
    light.kind = LightKind::directional;
    light.direction = -towards;
    light.color = irradiance;
    return light;
}

/// Directions of equal solid angle below the horizon: a sunflower.
std::vector<Vec3d> ground_directions(int count) {
    std::vector<Vec3d> directions;
    for (int k = 0; k < count; ++k) {
        const double y = -(k + 0.5) / count, level = std::sqrt(1 - y * y);
        const double angle = k * 2.39996322972865332223;
        directions.push_back({level * num::cos(angle), y, level * num::sin(angle)});
    }
    return directions;
}

/// What comes from below: of one radiance, or of a picture what lies nearest to each direction.
std::vector<Vec3f> ground_irradiance(const FrameSky& sky, const std::vector<Vec3d>& directions) {
    const auto solid_angle = static_cast<float>(2 * num::pi / static_cast<double>(directions.size()));
    const Vec3f even = sky.model ? sky_radiance(*sky.model, {0, -1, 0}) : sky.sky.ground;
    const auto* image = sky.model ? std::get_if<ImageSky>(&*sky.model) : nullptr;
    if (image == nullptr) return std::vector<Vec3f>(directions.size(), even * solid_angle);
    std::vector<Vec3d> sums(directions.size());
    for (const SkyCell& cell : lower_grid(*image).cells) {
        const auto down = [](Vec3d v) { return Vec3d{v.x, -v.y, v.z}; };
        const Vec3d towards = down(cell.red + cell.green + cell.blue);
        std::size_t nearest = 0;
        for (std::size_t k = 1; k < directions.size(); ++k) {
            if (dot(directions[k], towards) > dot(directions[nearest], towards)) nearest = k;
        }
        sums[nearest] = sums[nearest] + Vec3d{length(cell.red), length(cell.green), length(cell.blue)};
    }
    std::vector<Vec3f> irradiance;
    irradiance.reserve(sums.size());
    for (const Vec3d& sum : sums)
        irradiance.push_back(to_float(sum));
    return irradiance;
}

void add_lights(const FrameSky& sky, const SkyGrid& grid, int above, int below, std::vector<Light>& lights,
                std::vector<double>& solid_angle_sr) {
    // Where surfaces stand before it the sky's radiance is not what arrives: parts of it should not be large
    // only because they are dark.
    const SkyImportance importance = sky.sky.bounces > 0 ? SkyImportance::root : SkyImportance::radiance;
    for (const SkyDirection& d : sky_directions(grid, above, importance)) {
        lights.push_back(parallel(d.direction, d.irradiance_w_m2 * sky.sky.ambient));
        solid_angle_sr.push_back(d.solid_angle_sr);
    }
    const std::vector<Vec3d> directions = ground_directions(below);
    const std::vector<Vec3f> irradiance = ground_irradiance(sky, directions);
    for (std::size_t k = 0; k < directions.size(); ++k) {
        lights.push_back(parallel(directions[k], irradiance[k] * sky.sky.ambient));
        solid_angle_sr.push_back(2 * num::pi / below);
    }
}

void add_all_lights(const Exec& exec, FrameSky& f) {
    const SkyGrid grid =
        f.model ? sky_grid(*f.model, exec) : sky_grid([&](Vec3d d) { return gradient(f.sky, d); }, exec);
    const int below = sky_light_count(f.sky) - f.sky.samples;
    add_lights(f, grid, f.sky.samples, below, f.lights, f.solid_angle_sr);
    if (f.sky.bounces > 0) add_lights(f, grid, few_above, few_below, f.few, f.few_sr);
}

}  // namespace

int sky_light_count(const Sky& sky) {
    if (sky.bounces > 0) return sky.samples + sky.samples / 2;
    return sky.samples + std::max(sky.samples / 16, least_ground_lights);
}

FrameSky frame_sky(const Sky& sky, const Exec& exec) {
    FrameSky f;
    f.sky = sky;
    f.model = model_of(sky, exec);
    f.shade = shade_sky(f.model ? gradient_of(sky, *f.model) : sky);
    if (sky.occlusion && sky.ambient > 0) add_all_lights(exec, f);
    return f;
}

void draw_sky(const SkyModel& model, TileWork& work) {
    for (int group = 0; group < block_groups; ++group) {
        for (std::uint32_t left = ~work.surface.covered[group] & 0xffffu; left != 0; left &= left - 1) {
            const int at = group * 16 + std::countr_zero(left);
            const Vec3d d = to_double(-Vec3f{work.shade.vx[at], work.shade.vy[at], work.shade.vz[at]});
            Vec3f radiance = sky_radiance(model, d);
            if (const auto* clear = std::get_if<ClearSky>(&model))
                radiance = radiance + sun_disc_radiance(*clear, d);
            work.shade.r[at] = radiance.x;
            work.shade.g[at] = radiance.y;
            work.shade.b[at] = radiance.z;
        }
    }
}

}  // namespace obscura
