// [camera]: where the picture is taken from.

#include "app/scene/build.h"
#include "app/scene/key_ranges.h"
#include "app/scene/key_row.h"
#include "app/scene/keys.h"
#include "core/num.h"

namespace obscura {
namespace {

using namespace key_ranges;

constexpr Word<CameraKind> projections[] = {{"perspective", CameraKind::perspective},
                                            {"orthographic", CameraKind::orthographic}};

const KeyRows<Camera>& camera_rows() {
    static const KeyRows<Camera> rows{
        word_row(&Camera::kind, projections, "projection", "Kind of camera."),
        key_row(&Camera::eye, vec3_key("eye_m", "Position.").in(anywhere).need().animate()),
        key_row(&Camera::look_at, vec3_key("look_at_m", "Point in the middle of the picture; not the eye.")
                                      .in(anywhere)
                                      .need()
                                      .animate()),
        key_row(&Camera::up, vec3_key("up", "Direction that is up in the picture; not the viewing direction.")
                                 .in(anywhere)
                                 .animate()),
        key_row(&Camera::near_m, number_key("near_m", "Nothing nearer than this is seen.").in(distance)),
    };
    return rows;
}

/// From a micrometre to a kilometre.
constexpr Range lens_mm{1e-3, 1e6};

/// A focal length and a sensor's height stand for the angle of view.
const KeyRows<Camera>& perspective_rows() {
    static const KeyRows<Camera> rows{
        key_row_if_given(
            &Camera::vfov_deg,
            number_key("vfov_deg", "Full vertical angle of view; 40 when no focal length is given either.")
                .in({1e-6, 180, false, true})
                .animate()),
        {number_key("focal_length_mm", "Instead of vfov_deg: focal length of a lens.").in(lens_mm).animate()},
        {number_key("sensor_height_mm", "Height of the sensor behind that lens; 24 when not given.")
             .in(lens_mm)},
    };
    return rows;
}

const KeyRows<Camera>& orthographic_rows() {
    static const KeyRows<Camera> rows{
        key_row(&Camera::height_m,
                number_key("height_m", "World height of the picture.").in(distance).need().animate()),
    };
    return rows;
}

}  // namespace

const TableSpec& camera_table() {
    static const TableSpec spec{
        "[camera]",
        "Where the picture is taken from. Perspective cameras give either vfov_deg or focal_length_mm.",
        keys_of(camera_rows()),
        "projection",
        {{"perspective", "", keys_of(perspective_rows())},
         {"orthographic", "", keys_of(orthographic_rows())}}};
    return spec;
}

Camera camera_of(const SceneTable& table) {
    Camera camera;
    read_rows(camera_rows(), table, camera);
    read_rows(perspective_rows(), table, camera);
    read_rows(orthographic_rows(), table, camera);
    if (table.has("focal_length_mm")) {
        const double half = 0.5 * number(table, "sensor_height_mm") / number(table, "focal_length_mm");
        camera.vfov_deg = 2.0 * num::atan(half) * (180.0 / num::pi);
    }
    return camera;
}

}  // namespace obscura
