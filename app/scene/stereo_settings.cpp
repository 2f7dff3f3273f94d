#include "app/scene/stereo_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/scene/keyframes.h"
#include "app/scene/keys.h"
#include "app/scene/stereo_edits.h"
#include "app/scene/stereo_rows.h"
#include "app/scene/validate.h"

namespace obscura {
namespace {

/// [stereo] at the frame, or its defaults.
SceneTable stereo_table_at(const SceneDocument& document, double frame) {
    if (document.root.has("stereo")) return stereo_at(document, frame);
    return validate_table({}, {}, stereo_table(), document.sources);
}

/// Where the screen stands when the scene does not say.
double zero_parallax_m(const SceneTable& table, const Camera& camera) {
    return table.has("zero_parallax_m") ? number(table, "zero_parallax_m")
                                        : length(camera.look_at - camera.eye);
}

/// The limit in pixels that either unit gives; `limit` stays when neither does.
template <class Limit>
void set_limit(const SceneTable& table, const std::string& name, const StereoRig& rig, int width,
               Limit& limit) {
    if (table.has(name + "_percent")) {
        limit = 0.01 * number(table, name + "_percent") * width;
    } else if (table.has(name + "_deg")) {
        limit = disparity_of_vergence(number(table, name + "_deg"), width, rig);
    }
}

void set_remap_pixels(const SceneTable& table, int width, RangeRemap& r) {
    const auto pixels = [&](const char* key) { return 0.01 * number(table, key) * width; };
    if (r.curvature == 0 && r.kind == RemapKind::logarithmic) r.kind = RemapKind::linear;
    r.nearest_px = pixels("remap_near_percent");
    r.farthest_px = pixels("remap_far_percent");
    r.first_px = pixels("remap_first_percent");
    r.second_px = pixels("remap_second_percent");
    r.matched_px = pixels("remap_matched_percent");
}

}  // namespace

StereoSettings stereo_settings(const SceneDocument& document, const Scene& scene, double frame,
                               const FileAccess& access) {
    const SceneTable table = stereo_table_at(document, frame);
    const Size2 size = size2(subtable(document.root, "render"), "size_px");
    const EditContext context{document, scene, access, static_cast<double>(scene.render.width) / size.width};
    StereoSettings s;
    read_rows(stereo_rows(), table, s);
    s.rig.zero_parallax_m = zero_parallax_m(table, scene.camera);
    if (s.margin_px != auto_margin)
        s.margin_px = static_cast<int>(std::lround(static_cast<double>(s.margin_px) * context.px));
    s.solver.tolerance_rms_px = 0.4 * s.solver.tolerance_max_px;
    set_limit(table, "comfort_near", s.rig, scene.render.width, s.edit.comfort.nearest_px);
    set_limit(table, "comfort_far", s.rig, scene.render.width, s.edit.comfort.farthest_px);
    // Vergence comes back as pixels with rounding, or as infinite where eyes cannot turn so far.
    s.edit.comfort.nearest_px = std::max(s.edit.comfort.nearest_px, 0.0);
    s.edit.comfort.farthest_px = std::min(s.edit.comfort.farthest_px, 0.0);
    set_remap_pixels(table, scene.render.width, s.compare_remap);
    for (const SceneTable* edit : subtables(table, "edit")) {
        if (auto wish = stereo_edit_of(context, stereo_edit_at(document, *edit, frame))) {
            s.edits.push_back(std::move(*wish));
        } else {
            s.notes.push_back(fmt::format(
                "edit '{}' does nothing in this frame: its source or destination is behind the camera",
                text(*edit, "id")));
        }
    }
    return s;
}

std::string stereo_text(const StereoSettings& settings, const Scene& scene) {
    const StereoRig& rig = settings.rig;
    const int width = scene.render.width;
    const DisparityLaw law = disparity_law(rig, scene.camera, scene.render.height);
    std::string out = fmt::format(
        "stereo    eyes {:.4g} mm apart, screen at {:.4g} m; what is far away has {:.4g} px of disparity "
        "({:.3g} % of the width, {:.3g} degrees)\n",
        1e3 * rig.interaxial_m, rig.zero_parallax_m, -law.offset, percent_of_width(-law.offset, width),
        vergence_deg(-law.offset, width, rig));
    for (const StereoEdit& edit : settings.edits)
        out += fmt::format("edit      {}: {}, weight {:.4g}\n", edit.name,
                           stereo_edit_kinds()[edit.what.index()].name, edit.weight);
    for (const std::string& note : settings.notes)
        out += fmt::format("note      {}\n", note);
    return out;
}

}  // namespace obscura
