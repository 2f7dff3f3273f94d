#include "app/scene/rules_optics.h"

#include <fmt/format.h>

#include <cmath>

#include "app/scene/validate.h"
#include "core/num.h"

namespace obscura {
namespace {

using Sources = std::vector<std::string>;

constexpr double agreement = 0.005;  // of the sensor's width: half a percent, as lens makers round

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
