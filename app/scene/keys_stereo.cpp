// Keys of the two eyes; those of edits stand in stereo_edits.cpp.

#include "app/scene/key_ranges.h"
#include "app/scene/keys.h"
#include "app/scene/stereo_rows.h"

namespace obscura {
namespace {

constexpr Word<SolverMethod> solver_words[] = {{"multigrid", SolverMethod::multigrid},
                                               {"fmg", SolverMethod::fmg},
                                               {"vcycle", SolverMethod::vcycle},
                                               {"cascade", SolverMethod::cascade}};
constexpr Word<InterfaceGradients> interface_words[] = {{"original", InterfaceGradients::original},
                                                        {"edited", InterfaceGradients::edited}};
constexpr Word<RemapKind> remap_words[] = {{"linear", RemapKind::linear},
                                           {"log", RemapKind::logarithmic},
                                           {"histogram", RemapKind::histogram},
                                           {"match", RemapKind::match}};

constexpr Word<EyeShading> shading_words[] = {{"eyes", EyeShading::eyes}, {"middle", EyeShading::middle}};

constexpr Range weight_range{0, 1e6};
// What floats hold beside the other weights.
constexpr Range positive_weight{1e-9, 1e6};

KeyRows<StereoRig> rig_rows() {
    return {
        key_row(&StereoRig::interaxial_m,
                number_key("interaxial_m", "Between the two eyes' cameras.").in({0, 1e6, true}).animate()),
        {number_key("zero_parallax_m",
                    "Distance along the view axis of what appears on the screen itself; when not given, that "
                    "of the camera's look_at_m.")
             .in(key_ranges::distance)
             .animate()},
        key_row(&StereoRig::screen_width_m,
                number_key("screen_width_m", "Of the screen that the picture fills; for vergence in degrees.")
                    .in({0, 1000, true})),
        key_row(&StereoRig::viewing_distance_m,
                number_key("viewing_distance_m", "From the viewer to the screen.").in({0, 1000, true})),
        key_row(&StereoRig::eye_separation_m,
                number_key("eye_separation_m", "Of the viewer.").in({0, 1, true})),
    };
}

KeyRows<SolverParams> solver_rows() {
    return {
        word_row(&SolverParams::method, solver_words, "solver",
                 "multigrid: conjugate gradients with a V-cycle. fmg: full multigrid, then V-cycles. "
                 "vcycle: V-cycles alone. cascade: the paper's single pass from coarse to fine, inexact."),
        key_row(&SolverParams::tolerance_max_px,
                number_key(
                    "tolerance_px",
                    "Largest error of the map at which solving stops; its root mean square has to be 0.4 of "
                    "that. Not of \"cascade\".")
                    .in({0, 100, true})),
        key_row(&SolverParams::max_iterations,
                integer_key("max_iterations", "Where solving gives up; a note says so.").in({1, 100000})),
        key_row(&SolverParams::sweeps,
                integer_key("cascade_sweeps", "Jacobi sweeps per level of \"cascade\".").in({0, 100000})),
    };
}

KeyRows<SolverParams> storage_rows() {
    return {
        key_row(&SolverParams::half_storage,
                boolean_key("half_storage",
                            "Keeps the maps of \"cascade\" as 16-bit floats, as the paper does.")),
    };
}

KeyRows<EditParams> energy_rows() {
    return {
        word_row(&EditParams::interfaces, interface_words, "interfaces",
                 "What is wanted where two objects meet. original: the step that is there unedited, so that "
                 "neighbours follow an edit. edited: the step between the objects as edited, so that they "
                 "part; interface edits keep the original where it matters."),
        key_row(&EditParams::gradient_weight,
                number_key("gradient_weight", "Of every wanted difference between neighbours.")
                    .in(positive_weight)),
        key_row(&EditParams::anchor_weight,
                number_key("anchor_weight", "Of anchors, times their own.").in(weight_range)),
        key_row(&EditParams::match_weight,
                number_key("match_weight", "Of matched points, times their own.").in(weight_range)),
        key_row(
            &EditParams::epsilon,
            number_key("regularization", "Pull of every pixel to its unedited disparity.").in({1e-12, 1e6})),
    };
}

KeyRows<EditParams> conflict_rows() {
    return {
        {number_key("comfort_near_percent", "Largest disparity that is comfortable; no limit when not given.")
             .in({0, 100})
             .animate()},
        {number_key("comfort_far_percent", "Smallest one, behind the screen and so negative.")
             .in({-100, 0})
             .animate()},
        {number_key("comfort_near_deg", "Instead of comfort_near_percent: as vergence.")
             .in({0, 90})
             .animate()},
        {number_key("comfort_far_deg", "Instead of comfort_far_percent: as vergence.")
             .in({-90, 0})
             .animate()},
        key_row(&EditParams::comfort_weight,
                number_key("comfort_weight", "Anchors of pixels outside of these limits; 0: leave them.")
                    .in(weight_range)),
        key_row(&EditParams::window_weight,
                number_key("window_weight",
                           "Anchors of what the picture's sides cut in front of the screen; 0: leave it.")
                    .in(weight_range)),
        key_row(&EditParams::window_inherited,
                boolean_key("window_inherited", "Also what the sides cut as badly without any edit.")),
        key_row(
            &EditParams::reset_inversions,
            boolean_key("reset_inversions",
                        "Where an edit would turn near and far around, the original difference is wanted.")),
        key_row(&EditParams::limit_folds,
                boolean_key(
                    "limit_folds",
                    "Depth that would rise so steeply that an eye looks behind it is kept from folding.")),
    };
}

/// The comparison that --compare remap shows.
KeyRows<RangeRemap> remap_rows() {
    const auto percent = [](const char* name, const char* doc) {
        return number_key(name, doc).in({-100, 100});
    };
    KeyRows<RangeRemap> rows{
        word_row_if_given(
            &RangeRemap::kind, remap_words, "remap",
            "One curve for the disparities of the whole picture, to compare edits with (--compare "
            "remap). linear: to a range. log: to a range, near depth compressed. histogram: to a range, "
            "depths that many pixels have get more of it. match: two disparities become one."),
        {percent("remap_near_percent", "Largest disparity of the wanted range.").or_else(1.0)},
        {percent("remap_far_percent", "Smallest one.").or_else(-1.0)},
        key_row(
            &RangeRemap::curvature,
            number_key(
                "remap_curvature",
                "Of \"log\": the slope at the near end is 1 / (1 + it) of that at the far end; negative: the "
                "reverse; 0 is linear.")
                .in({-1000, 1000})),
        key_row(&RangeRemap::strength,
                number_key("remap_strength", "Of \"histogram\": 0 is linear, at 1 unused disparities vanish.")
                    .in({0, 1})),
        {percent("remap_first_percent", "Of \"match\": a disparity.").or_else(0.0)},
        {percent("remap_second_percent", "The one that it is brought together with.").or_else(0.0)},
        {percent("remap_matched_percent", "What both become.").or_else(0.0)},
    };
    rows[0].key.fallback = value_of("linear");  // the struct's own is to compare with nothing
    return rows;
}

}  // namespace

const KeyRows<StereoSettings>& stereo_rows() {
    using Settings = StereoSettings;
    static const KeyRows<Settings> rows =
        rows_within(&Settings::rig, rig_rows()) +
        KeyRows<Settings>{
            word_row(
                &Settings::shading, shading_words, "shading",
                "Whose view highlights and the mirrored sky are of. eyes: each eye's own, as two cameras "
                "see them, behind or before the surface that mirrors. middle: the camera's own for both "
                "eyes, so that they lie on surfaces."),
            count_or_word_row(
                &Settings::margin_px, "auto", auto_margin,
                integer_key(
                    "margin_px",
                    "Columns by which the middle view is wider than the picture, on either side; \"auto\": "
                    "as many as the largest disparity needs, at most a quarter of the picture.")
                    .in({0, 8192})
                    .or_else("auto")),
            key_row(&Settings::map_scale,
                    integer_key("map_scale", "The disparity map is solved at 1 : map_scale of the picture.")
                        .one_of({1, 2, 4, 8})),
        } +
        rows_within(&Settings::solver, solver_rows()) +
        KeyRows<Settings>{key_row(
            &Settings::warm_start,
            boolean_key(
                "warm_start",
                "Solves a frame from the map of the one before, in fewer iterations; its pixels then depend, "
                "within the tolerance, on which frames are rendered."))} +
        rows_within(&Settings::solver, storage_rows()) +
        rows_within(&Settings::reproject,
                    KeyRows<ReprojectParams>{key_row(
                        &ReprojectParams::tolerance_px,
                        number_key("tessellation_px",
                                   "Triangles are split until their disparity is this near to the map's.")
                            .in({0.001, 100}))}) +
        rows_within(&Settings::edit, energy_rows() + conflict_rows()) +
        rows_within(&Settings::compare_remap, remap_rows());
    return rows;
}

const TableSpec& stereo_table() {
    static const TableSpec spec = [] {
        TableSpec s{"[stereo]",
                    "Two eyes in place of the camera, and edits of the disparity between them: x of a point "
                    "in the left picture minus x in the right one, positive in front of the screen.",
                    keys_of(stereo_rows()),
                    "",
                    {}};
        s.keys.push_back(table_list_key("edit", stereo_edit_table()));
        return s;
    }();
    return spec;
}

}  // namespace obscura
