// Lesson 14. One edit's conflict.
//
// You learn: edits change a map pixel by pixel, and what comes out, D~, is torn at borders and may turn the
// order of things round. Gradients tell: where a step across a border has another sign than before, the old
// step is put back; then one system looks for the map that has those gradients and stays at its anchors.
// (L. Scandolo, P. Bauszat, E. Eisemann, "Gradient-Guided Local Disparity Editing", CGF 2018.)
//
// Calls: stereo/edit.h edited_disparity, edited_system, stereo/conflict.h find_conflicts, inverted,
//        stereo/conflict_overlay.h conflict_overlay, stereo/solver/solver.h solve.

#include <algorithm>

#include <fmt/format.h>

#include "core/color.h"
#include "lessons/drawing/figure.h"
#include "lessons/drawing/panels.h"
#include "lessons/ladder.h"
#include "lessons/stereo_edits.h"
#include "lessons/stereo_panels.h"
#include "stereo/conflict_overlay.h"

namespace obscura {
namespace {

constexpr int width = 360, height = 240, row = 150;
constexpr Rgb8 before_color = ink::grey, edited_color = ink::orange, solved_color = ink::blue;

/// Step 1 to 3: what is seen, what edits make of it, what the solver finds.
struct Steps {
    MiddleView view;
    DisparityMap edited;        ///< D~
    EditedSystem system;        ///< conflicts found, inversions reset
    DisparityMap solved, kept;  ///< kept: every border's steps as in D, which is the default
};

Steps steps_of(const StereoScene& scene, const MiddleView& view, const Exec& exec) {
    const std::vector<StereoEdit> edits = lesson_edits(view, 16);
    EditParams params;
    params.interfaces = InterfaceGradients::edited;
    Steps s{
        view, edited_disparity(view, edits, exec), lesson_system(scene, view, edits, params, exec), {}, {}};
    s.solved = minimiser(s.system.system, exec);
    params.interfaces = InterfaceGradients::original;
    s.kept = minimiser(lesson_system(scene, view, edits, params, exec).system, exec);
    return s;
}

Image<Rgb8> overlay_picture(const Image<Rgb8>& picture, const Steps& s) {
    Image<Vec3f> linear(picture.width, picture.height);
    std::transform(picture.pixels.begin(), picture.pixels.end(), linear.pixels.begin(),
                   [](Rgb8 c) { return srgb8_to_linear(c); });
    const Image<Vec3f> over = conflict_overlay(linear, s.view, s.system.conflict_pixels);
    Image<Rgb8> out(picture.width, picture.height);
    std::transform(over.pixels.begin(), over.pixels.end(), out.pixels.begin(), [](Vec3f c) {
        return Rgb8{linear_to_srgb8(c.x), linear_to_srgb8(c.y), linear_to_srgb8(c.z)};
    });
    return out;
}

// Step 4: one row.
void draw_row(Figure& f, const Steps& s, const Plot& plot) {
    f.axes(plot, "", "disparity, pixels");
    level_lines(f, plot, {-30, -20, -10, 0, 10, 20});
    axis_numbers(f, plot, {0, 60, 120, 180, 240, 300, 360}, 0);
    f.text(plot.at(plot.x1, plot.y0) + Vec2d{10, 38}, "column", {9, ink::soft, Align::right, false, false});
    const MiddleView& v = s.view;
    for (int x = 0; x + 1 < width; ++x) {
        const double original = static_cast<double>(v.disparity(x + 1, row) - v.disparity(x, row));
        const double edited = static_cast<double>(s.edited(x + 1, row) - s.edited(x, row));
        if (v.object(x, row) == v.object(x + 1, row) || !inverted(original, edited, 0.05)) continue;
        const double at = plot.at(x + 1.0, 0).x;
        f.fill({at - 4, plot.box.y, 8, plot.box.h}, ink::red, 0.28);
    }
    row_curve(f, plot, row_of(v.disparity, row), {before_color, 2});
    row_curve(f, plot, row_of(s.edited, row), {edited_color, 2});
    row_curve(f, plot, row_of(s.kept, row), {ink::purple, 1.6, 5});
    row_curve(f, plot, row_of(s.solved, row), {solved_color, 2.4});
}

/// One line of a list: what, pairs, worst.
double list_conflicts(Figure& f, Vec2d at, const std::vector<Conflict>& conflicts) {
    int shown = 0;
    for (const Conflict& c : conflicts) {
        if (c.kind != ConflictKind::depth_inversion || ++shown > 3) continue;
        f.text(at, c.what);
        f.text(at + Vec2d{250, 0}, fmt::format("{}", c.pixels), lettering::right);
        f.text(at + Vec2d{350, 0}, fmt::format("{:.1f} px", c.worst_px), lettering::right);
        at.y += 24;
    }
    if (shown == 0) f.text(at, "none");
    return shown == 0 ? at.y + 24 : at.y;
}

void draw_lists(Figure& f, const StereoScene& scene, const Steps& s, Vec2d at) {
    const auto left_in = [&](const DisparityMap& map) {
        return find_conflicts(s.view, map, {}, object_names(scene.mesh)).list;
    };
    f.text(at + Vec2d{250, 0}, "pairs", {9, ink::soft, Align::right, false, false});
    f.text(at + Vec2d{350, 0}, "worst", {9, ink::soft, Align::right, false, false});
    const std::pair<const char*, std::vector<Conflict>> lists[] = {
        {"in D~", s.system.conflicts},
        {"solved, borders as in D", left_in(s.kept)},
        {"solved, turned steps reset", left_in(s.solved)}};
    for (const auto& [name, list] : lists) {
        f.text(at, name, lettering::bold);
        at.y = list_conflicts(f, at + Vec2d{0, 24}, list) + 12;
    }
}

}  // namespace

Image<Rgb8> lesson_14_conflict(const Exec& exec) {
    Figure f(lesson_width, lesson_height);
    f.heading(14, "One edit's conflict",
              "Edits alone tear a map and turn the order of things round; gradients tell where, and a system "
              "heals it.");
    const StereoScene scene = stereo_scene();
    const SeenPicture seen = seen_from_middle(scene.mesh, scene.camera, width, height, exec);
    const Steps s = steps_of(scene, stereo_view(scene, seen), exec);
    const DisparityColours colours{-20, 20};
    constexpr double y = 150, x[] = {40, 426, 812, 1200};
    constexpr const char* names[] = {"D: as seen", "D~: ball × 3 round, bust − 16 px",
                                     "where the order is turned round", "solved, turned steps reset"};
    for (int i = 0; i < 4; ++i)
        f.text({x[i], y - 12}, names[i], lettering::bold);
    draw_map(f, {x[0], y}, s.view.disparity, colours);
    draw_map(f, {x[1], y}, s.edited, colours);
    draw_picture(f, {x[2], y}, overlay_picture(shaded(scene.mesh, seen), s));
    draw_map(f, {x[3], y}, s.solved, colours);
    for (const int i : {0, 1, 3})
        f.line({x[i], y + row + 0.5}, {x[i] + width, y + row + 0.5}, {ink::dark, 1, 4});
    draw_colours(f, {x[0], y + height + 12}, 330, colours, "px");
    f.text({40, 478}, "The dashed row", lettering::head);
    draw_row(f, s, {{90, 520, 900, 340}, 0, 360, -30, 20});
    f.legend({90, 930}, {{Mark::line, before_color, "D"},
                         {Mark::line, edited_color, "D~"},
                         {Mark::dashes, ink::purple, "solved, borders as in D"},
                         {Mark::line, solved_color, "solved, turned steps reset"},
                         {Mark::square, mix(ink::panel, ink::red, 0.4), "turned round"}});
    f.text({1090, 478}, "Steps that turned round", lettering::head);
    draw_lists(f, scene, s, {1090, 516});
    f.paragraph(
        {1090, 770},
        "With all the steps of D~ the solution would be D~: it has\nthem already. With those put back "
        "that turned round, the bust\nstays at its anchor, the ball bends back to pass behind it, and\n"
        "wall and floor give way a little.\n \nBy default every border keeps its step of D, turned round or\n"
        "not: the wall stays as far behind the ball as it was.");
    f.source_line(14,
                  "stereo/edit.h edited_disparity edited_system · stereo/conflict.h find_conflicts · "
                  "stereo/conflict_overlay.h · stereo/solver/solver.h solve");
    return f.picture;
}

}  // namespace obscura
