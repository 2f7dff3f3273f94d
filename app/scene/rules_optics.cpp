#include "app/scene/rules_optics.h"

#include <fmt/format.h>

#include <cmath>

#include "app/scene/validate.h"
#include "core/num.h"

namespace obscura {
namespace {

using Sources = std::vector<std::string>;

constexpr double agreement = 0.005;  // of the sensor's width: half a percent, as lens makers round
// Side of a pixel on the sensor, and the lens's focal length. What has glare to be seen lies far inside.
constexpr double least_pixel_m = 1e-9, most_pixel_m = 1;
constexpr double least_focal_m = 1e-9, most_focal_m = 1e9;

/// The key that says how large the sensor is, and how high that makes it. Without one it is 24 mm high.
struct SensorSize {
    const SceneTable* table;
    const char* key;
    double height_mm;
};
SensorSize sensor_size(const SceneTable& optics, const SceneTable& camera, Size2 size_px) {
    if (camera.has("focal_length_mm"))
        return {&camera, "sensor_height_mm", number(camera, "sensor_height_mm")};
    const double height_per_focal = 2 * num::tan(number(camera, "vfov_deg") * (num::pi / 360));
    if (optics.has("focal_length_mm"))
        return {&optics, "focal_length_mm", number(optics, "focal_length_mm") * height_per_focal};
    if (optics.has("sensor_width_mm"))
        return {&optics, "sensor_width_mm",
                number(optics, "sensor_width_mm") * size_px.height / size_px.width};
    return {nullptr, "", 24};
}

void check_pixels(const SensorSize& sensor, int height_px, const Sources& sources) {
    const double pixel_m = 1e-3 * sensor.height_mm / height_px;
    if (sensor.table == nullptr || (pixel_m >= least_pixel_m && pixel_m <= most_pixel_m)) return;
    fail_at(place_of(*sensor.table, sensor.key), sources,
            fmt::format("'{}' makes pixels of {:.6g} m; on the sensor they must be from {:g} to {:g} m wide",
                        sensor.key, pixel_m, least_pixel_m, most_pixel_m));
}

void check_focal_length(const SceneTable& camera, const SensorSize& sensor, const Sources& sources) {
    const bool given = camera.has("focal_length_mm");
    const double half_angle = given ? 0 : number(camera, "vfov_deg") * (num::pi / 360);
    const double focal_m =
        1e-3 * (given ? number(camera, "focal_length_mm") : sensor.height_mm / (2 * num::tan(half_angle)));
    if (focal_m >= least_focal_m && focal_m <= most_focal_m) return;
    const char* key = given ? "focal_length_mm" : "vfov_deg";
    fail_at(place_of(camera, key), sources,
            fmt::format(
                "'{}' makes a lens of {:.6g} m focal length; with [optics] it must be from {:g} to {:g} m",
                key, focal_m, least_focal_m, most_focal_m));
}

}  // namespace

void check_optics(const SceneTable& root, const Sources& sources) {
    if (!root.has("optics")) return;
    const SceneTable& optics = subtable(root, "optics");
    const SceneTable& camera = subtable(root, "camera");
    if (text(camera, "projection") != "perspective") {
        fail_at(root.find("optics")->place, sources,
                "[optics] needs a camera with projection = \"perspective\": parallel views have no lens");
    }
    if (camera.has("focal_length_mm")) {
        for (const char* key : {"focal_length_mm", "sensor_width_mm"}) {
            if (!optics.has(key)) continue;
            fail_at(place_of(optics, key), sources,
                    fmt::format("'{}': [camera] has said it with its focal_length_mm", key));
        }
    }
    if (optics.has("focus_m") && text(optics, "visibility") != "open") {
        fail_at(
            place_of(optics, "focus_m"), sources,
            "'focus_m' needs visibility = \"open\": patterns are out of focus or partly hidden, not both");
    }
    if (place_of(optics, "temperature_kelvin").source >= 0 && text(optics, "light") != "blackbody") {
        fail_at(place_of(optics, "temperature_kelvin"), sources,
                "'temperature_kelvin' needs light = \"blackbody\"");
    }
}

void check_lens(const SceneTable& optics, const SceneTable& camera, Size2 size_px, const Sources& sources) {
    const SensorSize sensor = sensor_size(optics, camera, size_px);
    check_pixels(sensor, size_px.height, sources);
    check_focal_length(camera, sensor, sources);
    if (!optics.has("focal_length_mm") || !optics.has("sensor_width_mm")) return;
    const double height =
        2 * number(optics, "focal_length_mm") * num::tan(number(camera, "vfov_deg") * (num::pi / 360));
    const double width = height * size_px.width / size_px.height;
    const double given = number(optics, "sensor_width_mm");
    if (std::fabs(width - given) <= agreement * width) return;
    fail_at(place_of(optics, "sensor_width_mm"), sources,
            fmt::format("'sensor_width_mm' = {:.6g} does not fit focal_length_mm = {:.6g} and the camera's "
                        "angle of view, which make it {:.6g}; give one of the two",
                        given, number(optics, "focal_length_mm"), width));
}

}  // namespace obscura
