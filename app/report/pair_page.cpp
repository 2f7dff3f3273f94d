#include "app/report/pair_page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "app/report/inline_png.h"
#include "app/report/page_parts.h"
#include "app/report/pair_charts.h"
#include "app/report/pair_notes.h"
#include "app/report/pair_pictures.h"
#include "app/report/style.h"
#include "core/color.h"
#include "core/image_io.h"
#include "lessons/drawing/markup.h"
#include "stereo/conflict_overlay.h"
#include "stereo/disparity.h"
#include "stereo/disparity_colour.h"
#include "stereo/layout.h"

namespace obscura {
namespace {

/// A map as the picture has it: without margins, every n-th pixel.
DisparityMap shown_map(const MiddleView& view, const DisparityMap& map) {
    const int n = shrink_of(view.picture_width);
    DisparityMap out(view.picture_width / n, std::max(view.picture_height / n, 1));
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x)
            out(x, y) = view.object(view.margin_px + x * n, y * n) == nothing_seen
                            ? std::nanf("")
                            : map(view.margin_px + x * n, y * n);
    }
    return out;
}

/// The strip of colours over its numbers: pixels, percent of the width, degrees of vergence.
std::string scale_bar(const StereoReportInput& in, const DisparityColours& colours) {
    const DisparityScale scale = disparity_scale(640, 22, colours);
    const int width = in.pair.view.picture_width;
    std::string pixels, percent, degrees;
    for (const ScaleTick& tick : scale.ticks) {
        const double d = tick.disparity_px;
        const std::string at = fmt::format("<span style=\"left:{:.2f}%\">", 100 * tick.x / 640);
        pixels += fmt::format("{}{:.4g}</span>", at, d);
        percent += fmt::format("{}{:.2f} %</span>", at, percent_of_width(d, width));
        degrees += fmt::format("{}{:.2f}°</span>", at, vergence_deg(d, width, in.settings.rig));
    }
    return fmt::format(
        "<div class=\"scale\">{}<div class=\"numbers\">{}</div><div class=\"numbers faint\">{}</div>"
        "<div class=\"numbers faint\">{}</div>"
        "<div class=\"ends\"><span>behind the screen</span>"
        "<span>pixels, percent of the width, degrees of vergence</span><span>in front of "
        "it</span></div></div>",
        inline_png(encode_png(scale.strip.view()), "scale of disparity colours"), pixels, percent, degrees);
}

std::string disparity_section(const StereoReportInput& in, const Exec& exec) {
    const DisparityMap before = shown_map(in.pair.view, in.pair.view.disparity),
                       after = shown_map(in.pair.view, in.pair.optimised);
    const DisparityColours colours = common_colours(before, after, in.settings.edit.comfort);
    const auto picture = [&](const DisparityMap& map, const char* alt) {
        return inline_png(encode_png(disparity_picture(map, colours, exec).view()), alt);
    };
    return page_section(
        "Disparity",
        "Left minus right, seen from the middle between the eyes. Grey is the screen; stripes are "
        "outside of the comfort zone; nearly black is where nothing is seen.",
        "<div class=\"pair\">" + page_figure(picture(before, "disparity before"), "Before") +
            page_figure(picture(after, "disparity after"), "After") + "</div>" + scale_bar(in, colours));
}

std::string anaglyph_section(const StereoReportInput& in, const Exec& exec) {
    const auto picture = [&](const Image<Vec3f>& left, const Image<Vec3f>& right, const char* alt) {
        return inline_png(encode_display(shrunk(lay_out(left, right, StereoLayout::anaglyph_dubois))), alt);
    };
    std::string body = "<div class=\"pair\">";
    if (!in.unedited_left.pixels.empty())
        body += page_figure(picture(in.unedited_left, in.unedited_right, "anaglyph before"), "Before");
    const RenderSettings& render = in.scene.render;
    body += page_figure(
        picture(display_light(in.pair.eyes.left.radiance.view(), render, exec),
                display_light(in.pair.eyes.right.radiance.view(), render, exec), "anaglyph after"),
        "After");
    return page_section("Anaglyph", "For red-cyan glasses, red on the left (least squares after Dubois).",
                        body + "</div>");
}

std::string css_colour(Vec3f linear) {
    const Rgb8 code = linear_to_srgb8(linear);
    return fmt::format("#{:02x}{:02x}{:02x}", code.r, code.g, code.b);
}

std::string conflict_table(const std::vector<Conflict>& list) {
    std::string body =
        "<table><thead><tr><th>conflict</th><th>where</th><th class=\"n\">pixels</th>"
        "<th class=\"n\">without edits</th><th class=\"n\">worst</th></tr></thead><tbody>";
    for (const Conflict& c : list) {
        body += fmt::format(
            "<tr><td><i class=\"key\" style=\"background:{}\"></i>{}</td><td>{}</td>"
            "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{:.2f} px</td></tr>",
            css_colour(conflict_colour(c.kind)), html_text(conflict_name(c.kind)), html_text(c.what),
            c.pixels, c.inherited, c.worst_px);
    }
    return body + "</tbody></table>";
}

/// A table of conflicts and where they are, or nothing when there are none.
std::string conflict_block(const StereoReportInput& in, const std::vector<Conflict>& list,
                           const Image<std::uint8_t>& pixels, const char* caption, const Exec& exec) {
    if (list.empty()) return {};
    std::string body = conflict_table(list);
    if (!in.pair.eyes.middle) return body;
    const MiddleView& view = in.pair.view;
    const Image<Vec3f> middle = without_margins(
        display_light(in.pair.eyes.middle->radiance.view(), in.scene.render, exec), view.margin_px);
    return body + page_figure(inline_png(encode_display(shrunk(conflict_overlay(middle, view, pixels))),
                                         "conflicts over the middle picture"),
                              caption);
}

/// `left`: conflicts of the map that is shown.
std::string conflicts_section(const StereoReportInput& in, const Conflicts& left, const Exec& exec) {
    const std::vector<Conflict>& list = in.frame.conflicts;
    return page_section("Conflicts of the edits",
                        list.empty()
                            ? "None: the edits keep the order of objects, the window and the comfort zone."
                            : "Found in the map as the edits alone make it; what is done about them "
                              "stands in the notes.",
                        conflict_block(in, list, in.pair.edited.conflict_pixels,
                                       "Where the edits alone are in conflict, before solving", exec)) +
           page_section(
               "Conflicts that are left",
               left.list.empty() ? "None in the optimised map, which the pictures show."
                                 : "Found in the optimised map, which the pictures show.",
               conflict_block(in, left.list, left.pixels, "Where the optimised map is in conflict", exec));
}

std::string histogram_section(const StereoReportInput& in) {
    const ComfortZone& zone = in.settings.edit.comfort;
    const int width = in.pair.view.picture_width;
    const DisparityHistogram h = disparity_histogram(in.pair.view, in.pair.optimised, zone);
    const bool limited = zone.nearest_px < 1e8 || zone.farthest_px > -1e8;
    std::string text = fmt::format(
        "{} pixels. Before: {:.2f} to {:.2f} px. After: {:.2f} to {:.2f} px ({:.2f} to {:.2f} % of the "
        "width).",
        h.pixels, h.before_low, h.before_high, h.after_low, h.after_high,
        percent_of_width(h.after_low, width), percent_of_width(h.after_high, width));
    if (limited)
        text += fmt::format(" Outside of the comfort zone: {:.2f} % of the pixels before, {:.2f} % after.",
                            h.near_percent_before + h.far_percent_before, h.near_percent + h.far_percent);
    const std::string key = fmt::format(
        "<p class=\"keys\"><i class=\"key before\"></i>before <i class=\"key after\"></i>after{} "
        "<span class=\"faint\">heights by the square root of the share</span></p>",
        limited ? " <i class=\"key zone\"></i>comfort zone" : "");
    return page_section("Histogram", text, histogram_svg(h, zone, width) + key);
}

std::string solver_section(const StereoReportInput& in) {
    const SolveReport& r = in.frame.solve;
    const std::string chart = convergence_svg(r, in.settings.solver);
    const std::string text = fmt::format(
        "{} at 1:{}: {} iterations{}, {}. Estimated error {:.3g} px at most, {:.3g} px rms; residual {:.2g} "
        "of that of the start.",
        solver_name(in.frame.solver), in.frame.map_scale, r.iterations,
        in.frame.warm ? ", begun at the last frame's map" : "",
        r.converged ? "converged" : "<b class=\"bad\">not converged</b>", r.error_max_px, r.error_rms_px,
        r.residual);
    return page_section(
        "Convergence", text,
        chart.empty() ? "<p class=\"faint\">This solver makes no estimates on its way.</p>" : chart);
}

std::string time_section(const StereoReportInput& in) {
    const StereoTimes& t = in.frame.times;
    const std::string stages = bars_svg({{"middle view", t.view_s},
                                         {"edits", t.edit_s},
                                         {"solve", t.solve_s},
                                         {"upsample", t.upsample_s},
                                         {"move triangles", t.mesh_s},
                                         {"render both eyes", t.render_s},
                                         {"measure", t.measure_s}},
                                        "Time per stage");
    std::vector<ChartBar> levels;
    for (const LevelTime& level : in.frame.solve.levels)
        levels.push_back({fmt::format("{} × {}", level.width, level.height), level.seconds});
    std::string body =
        "<div class=\"pair\">" + page_figure(stages, fmt::format("Stages, {} in all", time_text(t.total_s)));
    if (!levels.empty())
        body += page_figure(
            bars_svg(levels, "Time per level"),
            fmt::format("Levels of the solver, finest first; set-up {}", time_text(in.frame.solve.setup_s)));
    return page_section("Time", "", body + "</div>");
}

std::string unsatisfied_section(const StereoReportInput& in) {
    std::string rows;
    for (const Unsatisfied& u : in.frame.solve.unsatisfied) {
        rows += fmt::format(
            "<tr><td>{}</td><td class=\"n\">{:.2f} px</td><td class=\"n\">{:.2f} px</td>"
            "<td class=\"n\">{:.2f} px</td><td class=\"n\">{}</td><td>{}</td></tr>",
            u.name.empty() ? "<span class=\"faint\">gradients of the edited picture</span>"
                           : html_text(u.name),
            u.wanted_px, u.reached_px, u.worst_px, u.pixels,
            u.against.empty() ? "<span class=\"faint\">what is around</span>" : html_text(u.against));
    }
    if (rows.empty())
        return page_section(
            "Unsatisfied edits",
            fmt::format("None: everything is within {:.2g} px of what was asked for.", unsatisfied_px), "");
    return page_section(
        "Unsatisfied edits",
        fmt::format("Missed by more than {:.2g} px somewhere, worst first.", unsatisfied_px),
        "<table><thead><tr><th>edit</th><th class=\"n\">wanted</th><th class=\"n\">reached</th>"
        "<th class=\"n\">worst</th><th class=\"n\">pixels</th><th>against it</th></tr></thead><tbody>" +
            rows + "</tbody></table>");
}

std::string error_row(const char* name, const DisparityError& e) {
    if (e.pixels == 0) return {};
    return fmt::format(
        "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{:.3f} %</td>"
        "<td class=\"n\">{:.4f} px</td><td class=\"n\">{:.3f} px</td></tr>",
        name, e.pixels, 100 * e.share(), e.rms_px, e.max_px);
}

std::string realised_section(const StereoReportInput& in) {
    const ReprojectStats& r = in.frame.reprojection;
    const std::string text = fmt::format(
        "{} triangles became {} in {} rounds; {} vertices are seen, {} hidden. As cut, {:.3f} % of the "
        "pixels follow the map within {:.3g} px. Holes: {}.",
        r.triangles_in, r.triangles_out, r.rounds, r.vertices_seen, r.vertices_hidden, 100 * r.within,
        in.settings.reproject.tolerance_px, in.frame.cracks);
    const std::string rows =
        error_row("surface points", in.frame.realised) + error_row("left picture", in.frame.left) +
        error_row("right picture", in.frame.right) +
        (in.frame.temporal ? error_row("against the frame before", *in.frame.temporal) : "");
    if (rows.empty())
        return page_section("Triangles and what they show", text, "<p class=\"faint\">Not measured.</p>");
    return page_section(
        "Triangles and what they show", text,
        "<table><thead><tr><th>measured disparity</th><th class=\"n\">pixels</th>"
        "<th class=\"n\">within tolerance</th><th class=\"n\">rms</th><th class=\"n\">worst</th></tr>"
        "</thead><tbody>" +
            rows + "</tbody></table>");
}

std::string sight_row(const char* name, const EyeDisparity& eye) {
    std::array<std::int64_t, 4> counts{};
    for (const Sight s : eye.sight.pixels)
        ++counts[static_cast<std::size_t>(s)];
    std::string row = fmt::format("<tr><td>{}</td>", name);
    for (const std::int64_t count : counts)
        row += fmt::format("<td class=\"n\">{:.2f} %</td>",
                           100.0 * static_cast<double>(count) / static_cast<double>(eye.sight.pixels.size()));
    return row + "</tr>";
}

std::string occlusion_section(const StereoReportInput& in, const Exec& exec) {
    const TwoWayDisparity eyes = two_way_maps(in.pair, exec);
    return page_section("What only one eye sees", "",
                        "<table><thead><tr><th>picture</th><th class=\"n\">both see</th>"
                        "<th class=\"n\">hidden from the other</th><th class=\"n\">beyond its side</th>"
                        "<th class=\"n\">nothing there</th></tr></thead><tbody>" +
                            sight_row("left eye", eyes.left) + sight_row("right eye", eyes.right) +
                            "</tbody></table>");
}

std::string zone_text(const StereoReportInput& in) {
    const ComfortZone& zone = in.settings.edit.comfort;
    const int width = in.pair.view.picture_width;
    if (zone.nearest_px > 1e8 && zone.farthest_px < -1e8) return "no limits";
    const auto end = [&](double d) {
        return std::fabs(d) > 1e8 ? std::string("no limit")
                                  : fmt::format("{:.2f} px ({:.2f} %)", d, percent_of_width(d, width));
    };
    return end(zone.farthest_px) + " to " + end(zone.nearest_px);
}

std::string edit_text(const StereoEdit& edit) {
    if (const auto* round = std::get_if<RoundnessEdit>(&edit.what))
        return fmt::format("roundness {:.4g}{}", round->roundness, round->together ? ", as one thing" : "");
    if (const auto* anchor = std::get_if<AnchorEdit>(&edit.what))
        return fmt::format("anchor, offset {:+.3g} px", anchor->offset_px);
    if (const auto* border = std::get_if<InterfaceEdit>(&edit.what))
        return border->keep ? "interface: keep" : "interface: let go";
    const auto& match = std::get<MatchEdit>(edit.what);
    return fmt::format(
        "match, offset {:+.3g} px, {}", match.offset_px,
        match.radius_px > 0 ? fmt::format("radius {:.3g} px", match.radius_px) : "whole object");
}

std::string settings_section(const StereoReportInput& in) {
    const StereoSettings& s = in.settings;
    const StereoRig& rig = s.rig;
    std::string items;
    const auto add = [&](const char* name, const std::string& value) {
        items += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, html_text(value));
    };
    add("picture", fmt::format("{} × {}, {} samples", in.scene.render.width, in.scene.render.height,
                               in.scene.render.samples));
    add("margin", fmt::format("{} px", in.frame.margin_px));
    add("interaxial distance", fmt::format("{:.4g} m", rig.interaxial_m));
    add("screen stands at", fmt::format("{:.4g} m", rig.zero_parallax_m));
    add("screen",
        fmt::format("{:.3g} m wide, seen from {:.3g} m", rig.screen_width_m, rig.viewing_distance_m));
    add("viewer's eyes", fmt::format("{:.3g} m apart", rig.eye_separation_m));
    add("comfort zone", zone_text(in));
    add("solver", fmt::format("{} at 1:{}", solver_name(s.solver.method), s.map_scale));
    add("tolerance of the map",
        fmt::format("{:.3g} px, rms {:.3g} px", s.solver.tolerance_max_px, s.solver.tolerance_rms_px));
    add("weights",
        fmt::format("gradients {:.3g}, anchors {:.3g}, matches {:.3g}, {:.2g} towards the original",
                    s.edit.gradient_weight, s.edit.anchor_weight, s.edit.match_weight, s.edit.epsilon));
    std::string edits;
    for (const StereoEdit& edit : s.edits)
        edits += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{:.3g}</td></tr>",
                             html_text(edit.name), html_text(edit_text(edit)), edit.weight);
    if (!edits.empty())
        edits =
            "<table><thead><tr><th>edit</th><th>what it asks for</th><th "
            "class=\"n\">weight</th></tr></thead><tbody>" +
            edits + "</tbody></table>";
    return page_section("Settings", "", "<dl>" + items + "</dl>" + edits);
}

std::int64_t pixels_of(const std::vector<Conflict>& list) {
    std::int64_t pixels = 0;
    for (const Conflict& c : list)
        pixels += c.pixels;
    return pixels;
}

std::string tiles(const StereoReportInput& in, const Conflicts& left) {
    const auto tile = [](const std::string& value, const char* name) {
        return fmt::format("<div class=\"tile\"><b>{}</b><span>{}</span></div>", value, name);
    };
    const auto named = std::count_if(in.frame.solve.unsatisfied.begin(), in.frame.solve.unsatisfied.end(),
                                     [](const Unsatisfied& u) { return !u.name.empty(); });
    return "<div class=\"tiles\">" + tile(fmt::format("{}", in.settings.edits.size()), "edits") +
           tile(fmt::format("{}", pixels_of(in.frame.conflicts)), "pixels in conflict by the edits") +
           tile(fmt::format("{}", pixels_of(left.list)), "pixels in conflict after solving") +
           tile(fmt::format("{}", named), "edits not satisfied") +
           tile(fmt::format("{}", in.frame.solve.iterations), "iterations") +
           tile(in.frame.realised.pixels > 0 ? fmt::format("{:.2f} %", 100 * in.frame.realised.share()) : "–",
                "shown as in the map") +
           tile(fmt::format("{}", in.frame.cracks), "holes") +
           tile(time_text(in.frame.times.total_s), "in all") + "</div>";
}

std::string notes_list(const std::vector<std::string>& notes) {
    if (notes.empty()) return {};
    std::string items;
    for (const std::string& note : notes)
        items += "<li>" + html_text(note) + "</li>";
    return page_section("Notes", "", "<ul>" + items + "</ul>");
}

}  // namespace

std::string stereo_report(const StereoReportInput& in, const Exec& exec) {
    const std::string name = html_text(in.scene_name);
    const Conflicts left = remaining_conflicts(in.scene, in.settings, in.pair, exec);
    return fmt::format(
               "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
               "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>"
               "<title>Stereo report: {}</title><style>{}</style></head>\n<body><main>"
               "<header><p class=\"kind\">Obscura · stereo report</p><h1>{}</h1><p>frame {}</p>{}</header>\n",
               name, report_style, name, in.frame.frame, tiles(in, left)) +
           disparity_section(in, exec) + anaglyph_section(in, exec) + conflicts_section(in, left, exec) +
           unsatisfied_section(in) + histogram_section(in) + solver_section(in) + realised_section(in) +
           occlusion_section(in, exec) + time_section(in) + notes_list(in.frame.notes) +
           settings_section(in) + "</main></body></html>\n";
}

}  // namespace obscura
