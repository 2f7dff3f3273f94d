// Tables -> camera, lights, settings. Whatever depends on the frame is here.

#include <map>
#include <string_view>

#include "app/scene/build.h"
#include "app/scene/keyframes.h"
#include "core/num.h"
#include "core/sun.h"

namespace obscura {
namespace {

/// Unit vector towards (azimuth clockwise from north = -Z, elevation above the horizon).
Vec3d towards(double azimuth_deg, double elevation_deg) {
    const double level = num::cos_deg(elevation_deg);
    return {level * num::sin_deg(azimuth_deg), num::sin_deg(elevation_deg),
            -level * num::cos_deg(azimuth_deg)};
}

/// Relative optical air mass. F. Kasten and A. T. Young, "Revised optical air mass tables and approximation
/// formula", Applied Optics 28 (1989), equation 3. elevation_deg >= 0, as seen.
double air_mass(double elevation_deg) {
    return 1.0 / (num::sin_deg(elevation_deg) + 0.50572 * num::pow(elevation_deg + 6.07995, -1.6364));
}

/// Optical depths of clear air at 615, 535 and 445 nm: Rayleigh scattering (0.008569 / um^4, rounded) plus
/// 0.06, 0.08 and 0.10 for aerosol and ozone.
constexpr Vec3d clear_air{0.12, 0.19, 0.31};

void set_sun(Light& light, const SceneTable& table) {
    const DateTime t = date_time(table, "time");
    const double hour_utc = t.hour + (t.minute - t.offset_minutes) / 60.0 +
                            (t.second + static_cast<double>(t.nanosecond) * 1e-9) / 3600.0;
    const SunPosition sun = solar_position(t.year, t.month, t.day, hour_utc, number(table, "latitude_deg"),
                                           number(table, "longitude_deg"));
    const double elevation = sun.apparent_elevation_deg;
    light.direction = -towards(sun.azimuth_deg, elevation);
    light.below_horizon = elevation <= 0;
    if (light.below_horizon) {
        light.color = {0, 0, 0};
    } else if (table.has("irradiance_w_m2")) {
        light.color = to_float(vec3(table, "irradiance_w_m2"));
    } else {
        const double above = number(table, "extraterrestrial_w_m2"), mass = air_mass(elevation);
        const auto arriving = [&](double depth) { return above * num::exp(-depth * mass); };
        light.color = to_float(Vec3d{arriving(clear_air.x), arriving(clear_air.y), arriving(clear_air.z)});
    }
}

/// Where text equals one of `names`: its index.
template <class T, std::size_t n>
T choice(const SceneTable& table, std::string_view key, const char* const (&names)[n]) {
    const std::string& value = text(table, key);
    std::size_t i = 0;
    while (i + 1 < n && value != names[i])
        ++i;
    return static_cast<T>(i);
}

ShadowSettings shadow_of(const SceneTable& table) {
    ShadowSettings s;
    s.method = choice<ShadowMethod>(table, "method", {"none", "map", "compressed"});
    s.filter_px = static_cast<int>(integer(table, "filter_px"));
    s.receivers = choice<Receivers>(table, "receivers", {"any", "static"});
    s.normal_offset_texels = number(table, "normal_offset_texels");
    if (s.method == ShadowMethod::none) return s;
    const SceneValue& resolution = table.find("resolution")->value;
    const auto* texels = std::get_if<std::int64_t>(&resolution.data);
    s.resolution = texels != nullptr ? static_cast<int>(*texels) : auto_resolution;
    if (s.method == ShadowMethod::map) return s;
    s.scope = choice<ShadowScope>(table, "scope", {"frame", "full"});
    s.filter = choice<ShadowFilter>(table, "filter", {"pcf", "hierarchical"});
    if (table.has("max_magnification")) s.max_magnification = number(table, "max_magnification");
    s.layout = choice<TreeLayout>(table, "layout", {"words16", "words24", "bytes16"});
    s.top_levels = static_cast<int>(integer(table, "top_levels"));
    if (table.has("cache")) s.cache = text(table, "cache");
    return s;
}

/// Keys that only some shapes have.
void set_shape(const SceneTable& table, ApertureShape& o) {
    const auto take = [&](const char* key, double& to) {
        if (table.has(key)) to = number(table, key);
    };
    const auto count = [&](const char* key, int& to) {
        if (table.has(key)) to = static_cast<int>(integer(table, key));
    };
    take("rotation_deg", o.rotation_deg);
    take("bow", o.bow);
    take("aspect", o.aspect);
    take("obstruction", o.obstruction);
    count("blades", o.blades);
    count("vanes", o.vanes);
    count("slits", o.slits);
    count("lines", o.lines);
    count("rings", o.rings);
}

LensDirt dirt_of(const SceneTable& table) {
    static const std::map<std::string, Occluder> occluders = {
        {"none", Occluder::none}, {"housing", Occluder::housing}, {"disc", Occluder::disc}};
    LensDirt d;
    d.seed = integer(table, "seed");
    d.noise = number(table, "noise");
    d.noise_cell = number(table, "noise_cell");
    d.noise_stretch = number(table, "noise_stretch");
    d.noise_angle_deg = number(table, "noise_angle_deg");
    d.dust = static_cast<int>(integer(table, "dust"));
    d.dust_radius = number(table, "dust_radius");
    d.dust_softness = number(table, "dust_softness");
    d.scratches = static_cast<int>(integer(table, "scratches"));
    d.scratch_width = number(table, "scratch_width");
    d.scratch_length = number(table, "scratch_length");
    d.scratch_spread_deg = number(table, "scratch_spread_deg");
    d.eyelashes = static_cast<int>(integer(table, "eyelashes"));
    d.eyelash_width = number(table, "eyelash_width");
    d.eyelash_length = number(table, "eyelash_length");
    d.occluder = occluders.at(text(table, "occluder"));
    d.occluder_diameter = number(table, "occluder_diameter");
    d.occluder_x = number(table, "occluder_x");
    d.occluder_y = number(table, "occluder_y");
    return d;
}

/// The angle of view is the camera's; one more length makes it a lens and a sensor.
void set_lens(const SceneTable& table, const SceneTable& camera, const RenderSettings& render,
              OpticsSettings& o) {
    if (camera.has("focal_length_mm")) {
        o.focal_length_mm = number(camera, "focal_length_mm");
        o.sensor_height_mm = number(camera, "sensor_height_mm");
        return;
    }
    const double height_per_focal = 2 * num::tan(number(camera, "vfov_deg") * (num::pi / 360));
    if (table.has("focal_length_mm")) {
        o.focal_length_mm = number(table, "focal_length_mm");
        o.sensor_height_mm = o.focal_length_mm * height_per_focal;
        return;
    }
    if (table.has("sensor_width_mm"))
        o.sensor_height_mm = number(table, "sensor_width_mm") * render.height / render.width;
    o.focal_length_mm = o.sensor_height_mm / height_per_focal;
}

}  // namespace

Camera camera_of(const SceneTable& table) {
    Camera camera;
    camera.eye = vec3(table, "eye_m");
    camera.look_at = vec3(table, "look_at_m");
    camera.up = vec3(table, "up");
    camera.near_m = number(table, "near_m");
    if (text(table, "projection") == "orthographic") {
        camera.kind = CameraKind::orthographic;
        camera.height_m = number(table, "height_m");
    } else if (table.has("focal_length_mm")) {
        const double half = 0.5 * number(table, "sensor_height_mm") / number(table, "focal_length_mm");
        camera.vfov_deg = 2.0 * num::atan(half) * (180.0 / num::pi);
    } else {
        camera.vfov_deg = number(table, "vfov_deg");
    }
    return camera;
}

SceneLight light_of(const SceneTable& table) {
    SceneLight result;
    Light& light = result.light;
    light.id = text(table, "id");
    result.shadow = shadow_of(subtable(table, "shadow"));
    const std::string& type = text(table, "type");
    if (type == "sun") {
        light.kind = LightKind::sun;
        set_sun(light, table);
    } else if (type == "directional") {
        light.kind = LightKind::directional;
        light.direction = -towards(number(table, "azimuth_deg"), number(table, "elevation_deg"));
        light.color = to_float(vec3(table, "irradiance_w_m2"));
    } else {
        light.kind = type == "point" ? LightKind::point : LightKind::spot;
        light.position = vec3(table, "position_m");
        light.color = to_float(vec3(table, "intensity_w_sr"));
        light.near_m = number(table, "near_m");
        light.range_m = number(table, "range_m");
    }
    if (type == "spot") {
        light.direction = normalize(vec3(table, "look_at_m") - light.position);
        light.inner_cone_deg = number(table, "inner_cone_deg");
        light.outer_cone_deg = number(table, "outer_cone_deg");
    }
    return result;
}

Limits limits_of(const SceneDocument& document) {
    const SceneTable& table = subtable(document.root, "limits");
    Limits limits;
    limits.memory_mib = integer(table, "memory_mib");
    limits.triangles = integer(table, "triangles");
    limits.texture_px = integer(table, "texture_px");
    limits.texture_mib = integer(table, "texture_mib");
    limits.frames = integer(table, "frames");
    limits.image_px = integer(table, "image_px");
    return limits;
}

RenderSettings render_settings_of(const SceneDocument& document) {
    const SceneTable& table = subtable(document.root, "render");
    RenderSettings render;
    const Size2 size = size2(table, "size_px");
    render.width = size.width;
    render.height = size.height;
    render.samples = static_cast<int>(integer(table, "samples"));
    render.exposure_ev = number(table, "exposure_ev");
    render.tone = text(table, "tone") == "linear" ? ToneCurve::linear : ToneCurve::filmic;
    render.receivers = text(table, "receivers") == "static" ? Receivers::static_only : Receivers::any;
    return render;
}

OpticsSettings optics_of(const SceneDocument& document, double frame) {
    OpticsSettings o;
    if (!document.root.has("optics")) return o;
    const SceneTable table = optics_at(document, frame), camera = camera_at(document, frame);
    o.enabled = true;
    o.from_file = text(table, "aperture") == "file";
    if (!o.from_file)
        o.shape.kind = choice<ApertureKind>(
            table, "aperture", {"iris", "circle", "box", "whirl", "annulus", "slit", "grating", "hexagons"});
    set_shape(table, o.shape);
    o.dirt = dirt_of(table);
    o.f_number = number(table, "f_number");
    o.clip = number(table, "clip");
    o.mask_px = static_cast<int>(integer(table, "mask_px"));
    o.light.source = choice<LightSource>(table, "light", {"d65", "equal", "blackbody", "sodium", "rgb_led"});
    o.light.kelvin = number(table, "temperature_kelvin");
    const auto* count = std::get_if<std::int64_t>(&table.find("wavelengths")->value.data);
    o.wavelengths = count != nullptr ? static_cast<int>(*count) : 0;
    o.tolerance = number(table, "tolerance");
    o.radius_px = static_cast<int>(integer(table, "radius_px"));
    o.bloom_scale = static_cast<int>(integer(table, "bloom_scale"));
    o.visibility = choice<PupilVisibility>(table, "visibility", {"open", "exact", "neighbours"});
    o.visibility_samples = static_cast<int>(integer(table, "visibility_samples"));
    o.neighbourhood_px = static_cast<int>(integer(table, "neighbourhood_px"));
    if (table.has("focus_m")) o.focus_m = number(table, "focus_m");
    o.focus_steps = static_cast<int>(integer(table, "focus_steps"));
    set_lens(table, camera, render_settings_of(document), o);
    return o;
}

void set_frame(Scene& scene, const SceneDocument& document, double frame) {
    scene.camera = camera_of(camera_at(document, frame));
    Image<float> mask = std::move(scene.optics.mask);
    scene.optics = optics_of(document, frame);
    scene.optics.mask = std::move(mask);
    scene.lights.clear();
    for (const SceneTable* light : subtables(document.root, "light")) {
        scene.lights.push_back(light_of(light_at(document, *light, frame)));
    }
}

}  // namespace obscura
