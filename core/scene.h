#pragma once
// What a picture is made of, after the scene file has been read: camera, materials, lights, sky, settings.
// Plain values in the units their names say; colours are linear Rec. 709.

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/lens_dirt.h"
#include "core/mesh.h"
#include "core/vec.h"

namespace obscura {

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
    std::int32_t texture = -1;           ///< index into Scene::textures, multiplies base_color; -1 = none
    float translucency = 0.0f;  ///< share of light that passes thin sheets diffusely (leaves), in [0, 1]
};

enum class CameraKind { perspective, orthographic };

struct Camera {
    CameraKind kind = CameraKind::perspective;
    Vec3d eye{0, 1, 5}, look_at{0, 0, 0}, up{0, 1, 0};
    double vfov_deg = 40.0;  ///< perspective: full vertical angle, in (0, 180)
    double height_m = 10.0;  ///< orthographic: world height of the picture
    double near_m = 0.05;
};

enum class LightKind { directional, sun, point, spot };
/// `map`: a dense shadow map. `compressed`: a multiresolution hierarchy of the same depth intervals.
enum class ShadowMethod { none, map, compressed };
/// Who receives shadows: `any` point outside solids (the papers' rule, for trees that are kept for receivers
/// which the scene does not have), or only the scene's own surfaces, as in every picture of it: then the
/// interval of an open crossing may reach up to the next surface, and open sheets cost no node per texel.
enum class Receivers { any, static_only };

/// Which part of a compressed map is built: what the frame's lookups ask for, or everything.
enum class ShadowScope { frame, full };
/// `pcf`: a kernel of texels. `hierarchical`: of the squares that are as large as the pixel on the map.
enum class ShadowFilter { pcf, hierarchical };
/// How a compressed map's nodes are written: words with offsets of 24 or 16 bits, or bytes without padding.
enum class ShadowLayout { words24, words16, bytes16 };

constexpr int auto_resolution = 0;
constexpr int least_map_resolution = 16, most_dense_resolution = 16384, most_map_resolution = 1 << 20;

struct ShadowSettings {
    ShadowMethod method = ShadowMethod::compressed;
    /// Texels per side, a power of two from least_map_resolution to most_dense_resolution (map) or
    /// most_map_resolution (compressed); or, compressed only, auto_resolution.
    int resolution = auto_resolution;
    int filter_px = 3;  ///< PCF kernel side in texels, odd: to 5 (map) or 15 (compressed)
    Receivers receivers = Receivers::static_only;
    double normal_offset_texels = 1.5;  ///< bias of receivers on open components only
    // Compressed only.
    ShadowScope scope = ShadowScope::frame;
    ShadowFilter filter = ShadowFilter::pcf;
    double max_magnification = 1.0;  ///< auto: pixels that a texel spans at most, the shorter way
    ShadowLayout layout = ShadowLayout::words24;
    int top_levels = 6;  ///< first levels that are kept as a table, in [0, 10]
    std::string cache;   ///< folder for finished maps of scope full; empty: none
};

struct Light {
    std::string id;
    LightKind kind = LightKind::directional;
    Vec3d direction{0, -1, 0};  ///< unit, the way the light travels (directional, sun, spot)
    Vec3d position{0, 0, 0};    ///< metres (point, spot)
    Vec3f color{1, 1, 1};  ///< irradiance in W/m^2 per channel on a facing surface (directional, sun), or
                           ///< radiant intensity in W/sr per channel (point, spot)
    double inner_cone_deg = 20, outer_cone_deg = 30;  ///< spot: half angles; full power inside, none outside
    double near_m = 0.05,
           range_m = 100;        ///< point and spot: shadow depth range; light ends smoothly at range_m
    bool below_horizon = false;  ///< sun: contributes nothing
    ShadowSettings shadow;
};

/// Ambient light: a gradient sky seen by every surface without occlusion, and the background. The default is
/// a clear day under a sun of irradiance 3: the sky sheds about a quarter of that on level ground.
struct Sky {
    Vec3f zenith{0.10f, 0.19f, 0.38f};  ///< radiance
    Vec3f horizon{0.36f, 0.42f, 0.48f};
    Vec3f ground{0.16f, 0.145f, 0.12f};
    float ambient = 1.0f;  ///< scale of the light it sheds
    bool visible = true;   ///< false: background is black
};

enum class ToneCurve { linear, filmic };

struct RenderSettings {
    int width = 960, height = 540;  ///< pixels
    int samples = 4;                ///< per pixel: 1, 4 or 16
    double exposure_ev = 0.0;       ///< linear radiance is scaled by 2^exposure_ev
    ToneCurve tone = ToneCurve::filmic;
    Receivers receivers = Receivers::static_only;
};

/// How the aperture that light samples see is found: `open`: the lens's own, for all; `exact`: less what the
/// scene hides of it from the light; `neighbours`: less the pixels around the source that do not glare.
enum class PupilVisibility { open, exact, neighbours };

/// The camera's lens as far as it diffracts. A pinhole's picture is taken; what this adds is glare.
struct OpticsSettings {
    bool enabled = false;
    std::string aperture = "iris";  ///< name of a shape, or "file"
    Image<float> mask;              ///< of aperture "file", else empty
    int mask_px = 512;              ///< side of a shape's mask
    int blades = 7;                 ///< iris, whirl
    double rotation_deg = 0;        ///< clockwise, as the photographer sees it
    double bow = 0;                 ///< iris: 0 straight blades, 1 a circle
    double aspect = 1;              ///< box: height / width
    double obstruction = 0.3;       ///< annulus: of the diameter
    int vanes = 4;                  ///< annulus
    int slits = 1, lines = 16, rings = 2;
    LensDirt dirt;
    // The lens. The camera's angle of view decides the size of the sensor.
    double focal_length_mm = 50, f_number = 8, sensor_height_mm = 24;
    double clip = 1;  ///< exposed radiance above which a pixel glares
    // Light: how its wavelengths are spread; colours stay the scene's.
    std::string light = "d65";
    double temperature_kelvin = 6500;
    int wavelengths = 0;      ///< 0: chosen from radius and tolerance
    double tolerance = 0.01;  ///< of colours
    int radius_px = 256;      ///< of the kernel
    int bloom_scale = 1;
    PupilVisibility visibility = PupilVisibility::open;
    int visibility_samples = 8;  ///< kernels per lamp, most
    int neighbourhood_px = 4;    ///< neighbours: how far the pupil reaches around a source
    double focus_m = 0;          ///< bright points out of focus show their near field; 0: all is sharp
    int focus_steps = 8;         ///< depths that have kernels of their own, most
    friend bool operator==(const OpticsSettings&, const OpticsSettings&) = default;
};

enum class Aov { beauty, depth, normal, albedo, object, shadow };

struct Output {
    Aov aov = Aov::beauty;
    std::string file;  ///< "####" stands for the frame number
};

/// Bounds that are checked before anything is allocated.
struct Limits {
    std::int64_t memory_mib = 4096;
    std::int64_t triangles = 50'000'000;
    std::int64_t texture_px = 16384;  ///< longest side
    std::int64_t texture_mib = 1024;  ///< all decoded textures together
    std::int64_t frames = 65536;
    std::int64_t image_px = 16384;  ///< longest side of a frame
};

/// One frame's worth of scene: everything is in world space and final.
struct Scene {
    Mesh mesh;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    Camera camera;
    std::vector<Light> lights;
    Sky sky;
    RenderSettings render;
    OpticsSettings optics;
    std::vector<Output> outputs;
    Limits limits;
};

}  // namespace obscura
