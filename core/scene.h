#pragma once
// What a picture shows: camera, materials, textures, lights, sky. Plain values in the units their names say;
// colours are linear Rec. 709. How it is rendered stands with whoever does it (app/scene/scene.h has all).

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/sun_path.h"
#include "core/vec.h"

namespace obscura {

struct ImageSky;
struct EmitterSurface;

/// A decoded texture, linear-light RGB with its mip chain (level 0 first; each level halves, rounding up
/// to 1; 2 x 2 box filter).
struct Texture {
    std::string name;
    std::vector<Image<Vec3f>> levels;
};

/// Metallic-roughness surface: Lambert + GGX (Walter et al. 2007; Burley 2012 parameters).
struct Material {
    std::string name;
    Vec3f base_color{0.8f, 0.8f, 0.8f};  ///< linear, each in [0, 1]
    float roughness = 0.8f;              ///< perceptual, alpha = roughness^2, in [0.02, 1]
    float metallic = 0.0f;               ///< in [0, 1]
    Vec3f emission{0, 0, 0};             ///< emitted radiance, W / (m^2 sr) per channel
    std::int32_t texture = -1;  ///< index among the scene's textures, multiplies base_color; -1 = none
    float translucency = 0.0f;  ///< share of light that passes thin sheets diffusely (leaves), in [0, 1]
    friend bool operator==(const Material&, const Material&) = default;
};

enum class CameraKind { perspective, orthographic };

struct Camera {
    CameraKind kind = CameraKind::perspective;
    Vec3d eye{0, 1, 5}, look_at{0, 0, 0}, up{0, 1, 0};
    double vfov_deg = 40.0;  ///< perspective: full vertical angle, in (0, 180)
    double height_m = 10.0;  ///< orthographic: world height of the picture
    double near_m = 0.05;
    friend bool operator==(const Camera&, const Camera&) = default;
};

enum class LightKind { directional, sun, point, spot, area, surface };

/// Whether all of the light travels one way: it then has no position and reaches everywhere.
constexpr bool is_parallel(LightKind kind) {
    return kind == LightKind::directional || kind == LightKind::sun;
}

/// How many square views a shadow map needs to see what the light sees: the faces of a cube, where that may
/// be anywhere.
constexpr int shadow_view_count(LightKind kind) {
    return is_parallel(kind) || kind == LightKind::spot ? 1 : 6;
}

/// Outline of an area light: a rectangle, or the ellipse in it.
enum class AreaShape { rectangle, disc };

struct Light {
    std::string id;
    LightKind kind = LightKind::directional;
    Vec3d direction{0, -1,
                    0};       ///< unit, the way the light travels (directional, sun, spot; area: its normal)
    Vec3d position{0, 0, 0};  ///< metres (point, spot; area, surface: its middle)
    Vec3f color{1, 1,
                1};  ///< irradiance in W/m^2 per channel on a facing surface (directional, sun),
                     ///< radiant intensity in W/sr (point, spot), or radiance in W/(m^2 sr) (area, surface)
    double inner_cone_deg = 20, outer_cone_deg = 30;  ///< spot: half angles; full power inside, none outside
    double near_m = 0.05,
           range_m = 100;         ///< with a position: shadow depth range; light ends smoothly at range_m
    bool below_horizon = false;   ///< sun: contributes nothing
    std::optional<SunPath> path;  ///< sun: its way over the day, which hours of sun are counted along
    // How large it is. Shadows of what is none are hard.
    double angular_diameter_deg = 0;  ///< directional, sun: full angle that it fills, uniformly bright
    double radius_m = 0;              ///< point, spot: of a ball that looks like a uniform disc from anywhere
    AreaShape shape = AreaShape::rectangle;  ///< area,
    Vec3d across{1, 0, 0};                   ///< unit, along its width, at right angles to `direction`
    double width_m = 1, height_m = 1;        ///< whole sides, or axes of the ellipse
    bool two_sided = false;                  ///< also shines against `direction`
    std::string material;                    ///< surface: what has it shines, as bright as its emission says;
    std::shared_ptr<const EmitterSurface> surface;  ///< all of that, and null in a file's own light
    double part = 1;  ///< area: of its surface, shining from `position` (raster/light_samples.h)
    friend bool operator==(const Light&, const Light&) = default;
};

/// gradient: a mix of colours. clear and overcast follow the sun: computed from the air (core/sky), and the
/// standard one. image: a picture of all directions.
enum class SkyKind { gradient, clear, overcast, image };

/// The background, and the light that it sheds. The default is a gradient: a clear day under a sun of
/// irradiance 3; the sky sheds about a quarter of that on level ground.
struct Sky {
    Vec3f zenith{0.10f, 0.19f, 0.38f};  ///< radiance, gradient
    Vec3f horizon{0.36f, 0.42f, 0.48f};
    Vec3f ground{0.16f, 0.145f, 0.12f};
    float ambient = 1.0f;  ///< scale of the light it sheds
    bool visible = true;   ///< false: background is black
    SkyKind kind = SkyKind::gradient;
    double turbidity = 3;                   ///< clear: 2 very clear, 6 hazy
    Vec3f ground_albedo{0.2f, 0.2f, 0.2f};  ///< clear, overcast
    bool occlusion = false;                 ///< false: it reaches every surface, whatever stands before
    int samples = 64;                       ///< occlusion: directions that stand for it, 16, 64, 256 or 1024
    int bounces = 1;                        ///< occlusion: how often surfaces send on what arrives, 0 to 4
    std::shared_ptr<const ImageSky> image;  ///< image
    std::string sun;  ///< the light that clear and overcast skies follow; empty: the first that may be
    // What follows from that light.
    double sun_azimuth_deg = 0, sun_elevation_deg = 45;
    Vec3d sun_above_air{5, 5, 5};  ///< irradiance, W/m^2
    friend bool operator==(const Sky&, const Sky&) = default;
};

}  // namespace obscura
