#include "app/report/pair_notes.h"

#include <fmt/format.h>

#include <algorithm>

namespace obscura {
namespace {

constexpr std::size_t most_unsatisfied = 8;

/// All conflicts of a kind together.
struct KindTotal {
    const Conflict* first = nullptr;
    std::int64_t places = 0, pixels = 0, inherited = 0;
    double worst_px = 0;
};

KindTotal total_of(const std::vector<Conflict>& conflicts, ConflictKind kind) {
    KindTotal total;
    for (const Conflict& c : conflicts) {
        if (c.kind != kind) continue;
        if (total.first == nullptr) total.first = &c;
        ++total.places;
        total.pixels += c.pixels;
        total.inherited += c.inherited;
        total.worst_px = std::max(total.worst_px, c.worst_px);
    }
    return total;
}

/// How many of them the system holds back (see edit.cpp).
std::int64_t held_back(const KindTotal& total, ConflictKind kind, const EditParams& p) {
    switch (kind) {
        case ConflictKind::depth_inversion:
            return p.reset_inversions ? total.pixels : 0;
        case ConflictKind::window_violation:  // where the rig alone is cut as badly stays what it was
            return p.window_weight > 0 ? total.pixels - (p.window_inherited ? 0 : total.inherited) : 0;
        case ConflictKind::comfort:
            return p.comfort_weight > 0 ? total.pixels : 0;
        case ConflictKind::fold:
            return p.limit_folds ? total.pixels : 0;
    }
    return 0;
}

std::string outcome_text(const KindTotal& total, ConflictKind kind, const StereoSettings& settings) {
    // A remap has no edits and solves nothing: what is told is the map that its curve starts from.
    if (settings.remap.kind != RemapKind::none) return "before the remap";
    const std::int64_t held = held_back(total, kind, settings.edit), pixels = total.pixels;
    if (held == 0) return "left as it is";
    if (held == pixels) return "held back before solving";
    return fmt::format("{} held back before solving, {} left as {}", held, pixels - held,
                       pixels - held == 1 ? "it is" : "they are");
}

/// "depth inversion: 210 pixels, worst by 3.2 px (ball in front of wall, and 2 more); held back before
/// solving".
void add_conflicts(const StereoPair& pair, const StereoSettings& settings, std::vector<std::string>& notes) {
    for (int k = 0; k < conflict_kinds; ++k) {
        const auto kind = static_cast<ConflictKind>(k);
        const KindTotal total = total_of(pair.edited.conflicts, kind);
        if (total.places == 0) continue;
        notes.push_back(fmt::format(
            "{}: {} pixel{}, worst by {:.2f} px ({}{}){}; {}", conflict_name(kind), total.pixels,
            total.pixels == 1 ? "" : "s", total.worst_px, total.first->what,
            total.places > 1 ? fmt::format(", and {} more", total.places - 1) : "",
            total.inherited > 0 ? fmt::format("; {} of them without edits, too", total.inherited) : "",
            outcome_text(total, kind, settings)));
    }
}

void add_solver(const StereoPair& pair, const StereoSettings& settings, std::vector<std::string>& notes) {
    const SolveReport& report = pair.solution.report;
    if (settings.solver.method == SolverMethod::cascade) {
        notes.push_back(fmt::format("solver \"cascade\" makes one pass; its map is off by about {:.2g} px",
                                    report.error_max_px));
    } else if (!report.converged) {
        notes.push_back(
            fmt::format("the map was not solved to {:.3g} px in {} iterations: about {:.3g} px are "
                        "left (max_iterations, tolerance_px)",
                        settings.solver.tolerance_max_px, report.iterations, report.error_max_px));
    }
    // What edits do to gradients is their purpose; only wishes that have a name are told.
    std::vector<const Unsatisfied*> named;
    for (const Unsatisfied& u : report.unsatisfied) {
        if (!u.name.empty()) named.push_back(&u);
    }
    for (std::size_t i = 0; i < std::min(named.size(), most_unsatisfied); ++i) {
        const Unsatisfied& u = *named[i];
        const auto title = [](const std::string& name) {
            return name == limits_area_name ? "the " + name : fmt::format("edit '{}'", name);
        };
        notes.push_back(fmt::format(
            "{} is not satisfied: it wants {:.2f} px and gets {:.2f} on average, {:.2f} px off at "
            "worst, {} pixels by more than {:.2g}; against it {}",
            title(u.name), u.wanted_px, u.reached_px, u.worst_px, u.pixels, unsatisfied_px,
            u.against.empty() ? "pull the depths around" : "pulls " + title(u.against)));
    }
    if (named.size() > most_unsatisfied)
        notes.push_back(fmt::format("and {} more edits are not", named.size() - most_unsatisfied));
}

}  // namespace

const char* solver_name(SolverMethod method) {
    constexpr const char* names[] = {"cascade", "vcycle", "fmg", "multigrid"};
    return names[static_cast<std::size_t>(method)];
}

std::vector<std::string> stereo_notes(const StereoPair& pair, const StereoSettings& settings) {
    std::vector<std::string> notes = settings.notes;
    for (const EditNotice& notice : pair.edited.notices)
        notes.push_back(fmt::format("edit '{}': {}", notice.edit, notice.text));
    add_conflicts(pair, settings, notes);
    add_solver(pair, settings, notes);
    const std::int64_t cracks = pair.eyes.left_map.cracks + pair.eyes.right_map.cracks;
    if (cracks > 0)
        notes.push_back(
            fmt::format("{} pixels show nothing where one surface runs on on both sides", cracks));
    return notes;
}

std::string stereo_details(const StereoPair& pair, const StereoSettings& settings) {
    const SolveReport& report = pair.solution.report;
    const StereoTimes& t = pair.times;
    std::string out = fmt::format(
        "  map {} x {} (margin {}), solved at 1:{} by {}: {} iterations{}, error about {:.3g} px, rms "
        "{:.3g}\n",
        pair.view.width(), pair.view.height(), pair.view.margin_px, settings.map_scale,
        solver_name(settings.solver.method), report.iterations, pair.warm ? " from the last frame's" : "",
        report.error_max_px, report.error_rms_px);
    out +=
        fmt::format("  {} triangles cut into {} in {} rounds; {:.3f} % of the pixels within {:.3g} px\n",
                    pair.reprojection.triangles_in, pair.reprojection.triangles_out, pair.reprojection.rounds,
                    100 * pair.reprojection.within, settings.reproject.tolerance_px);
    const DisparityError& e = pair.realised.error;
    if (e.pixels > 0) {
        out += fmt::format(
            "  shown disparity: {:.3f} % of {} pixels within {:.3g} px, rms {:.3g}, worst {:.3g}\n",
            100 * e.share(), e.pixels, settings.reproject.tolerance_px, e.rms_px, e.max_px);
    }
    if (pair.temporal) {
        out += fmt::format("  against the last frame: rms {:.3g} px, worst {:.3g} of {} pixels\n",
                           pair.temporal->error.rms_px, pair.temporal->error.max_px,
                           pair.temporal->error.pixels);
    }
    return out + fmt::format(
                     "  view {:.3f} s, edits {:.3f} s, solve {:.3f} s, upsample {:.3f} s, mesh {:.3f} s, "
                     "render {:.3f} s, measure {:.3f} s\n",
                     t.view_s, t.edit_s, t.solve_s, t.upsample_s, t.mesh_s, t.render_s, t.measure_s);
}

}  // namespace obscura
