#include "app/frame/frame_sky.h"

#include <cmath>

#include "app/frame/tile.h"
#include "core/error.h"
#include "core/num.h"
#include "core/vec_arrays.h"
#include "raster/lighting.h"

namespace obscura {
namespace {

constexpr int least_ground_lights = 4;

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

/// The gradient that is nearest to a model: for what surfaces mirror.
Sky gradient_of(const Sky& sky, const SkyModel& model) {
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

/// What comes from below the horizon: directions of equal solid angle, each with the radiance from there.
void add_ground(int count, FrameSky& sky) {
    const double solid_angle = 2 * num::pi / count;
    for (int k = 0; k < count; ++k) {
        const double y = -(k + 0.5) / count, level = std::sqrt(1 - y * y);
        const double angle = k * 2.39996322972865332223;  // of a sunflower
        const Vec3d direction{level * num::cos(angle), y, level * num::sin(angle)};
        const Vec3f radiance = sky.model ? sky_radiance(*sky.model, direction) : sky.sky.ground;
        sky.lights.push_back(
            parallel(direction, radiance * (sky.sky.ambient * static_cast<float>(solid_angle))));
        sky.solid_angle_sr.push_back(solid_angle);
    }
}

void add_lights(const Exec& exec, FrameSky& f) {
    const Sky& sky = f.sky;
    const SkyGrid grid =
        f.model ? sky_grid(*f.model, exec) : sky_grid([&](Vec3d d) { return gradient(sky, d); }, exec);
    // Where surfaces stand before it the sky's radiance is not what arrives: parts of it should not be large
    // only because they are dark.
    const SkyImportance importance = sky.bounces > 0 ? SkyImportance::root : SkyImportance::radiance;
    for (const SkyDirection& d : sky_directions(grid, sky.samples, importance)) {
        f.lights.push_back(parallel(d.direction, d.irradiance_w_m2 * sky.ambient));
        f.solid_angle_sr.push_back(d.solid_angle_sr);
    }
    add_ground(sky_light_count(sky) - sky.samples, f);
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
    if (sky.occlusion && sky.ambient > 0) add_lights(exec, f);
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
