// Flags of `obscura stereo`.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "app/cli/flag_values.h"
#include "app/cli/flags.h"
#include "app/cli/scene_flags.h"
#include "app/cli/stereo_command.h"
#include "app/scene/schema.h"
#include "core/error.h"

namespace obscura {
namespace {

StereoLayout layout_value(const std::string& flag, const std::string& text) {
    if (const auto layout = parse_layout(text)) return *layout;
    std::vector<std::string> names;
    for (const std::string_view name : layout_names())
        names.emplace_back(name);
    throw UsageError(fmt::format("{}: there is no layout '{}'{}", flag, text, hint(text, names)));
}

/// Layouts that name an eye show that one.
void check_swap(const StereoOptions& options) {
    const StereoLayout l = options.layout;
    if (!options.swap_eyes ||
        (l != StereoLayout::left && l != StereoLayout::right && l != StereoLayout::separate))
        return;
    throw UsageError(fmt::format("--swap-eyes: layout '{}' names its eyes", layout_name(l)));
}

/// --solver and --map-scale say what keys of the scene say.
void add_overrides(const std::string& solver, std::int64_t map_scale, std::vector<std::string>& overrides) {
    const std::vector<std::string> solvers{"multigrid", "fmg", "vcycle", "cascade"};
    if (!solver.empty()) {
        if (std::find(solvers.begin(), solvers.end(), solver) == solvers.end())
            throw UsageError(
                fmt::format("--solver: there is no solver '{}'{}", solver, hint(solver, solvers)));
        overrides.push_back("stereo.solver=" + solver);
    }
    if (map_scale == 0) return;
    if (map_scale != 1 && map_scale != 2 && map_scale != 4 && map_scale != 8)
        throw UsageError(fmt::format("--map-scale: '{}' is not 1, 2, 4 or 8", map_scale));
    overrides.push_back(fmt::format("stereo.map_scale={}", map_scale));
}

}  // namespace

int run_stereo(const Arguments& arguments) {
    Flags flags(
        "stereo [options] SCENE",
        "Renders a scene for two eyes, its disparity edited as [stereo] says, and tells what the edits "
        "met with.");
    RunFlags run;
    StereoOptions options;
    std::string layout = "side-by-side", solver, compare;
    std::int64_t map_scale = 0;

    run.scene.add_to(flags);
    flags.group("Pictures");
    flags.text("-o,--output", "FILE", options.output,
               "Where the pair goes: .png (8-bit sRGB); #### stands for the frame number and pads it.",
               "SCENE.stereo.png in the current folder");
    flags.text(
        "--layout", "LAYOUT", layout,
        "side-by-side, half-side-by-side, cross-eye, over-under, half-over-under, anaglyph (red-cyan), "
        "anaglyph-half, anaglyph-dubois, interlaced, left, right, or separate: two files NAME.left.png "
        "and NAME.right.png.",
        "side-by-side");
    flags.on_off("--swap-eyes", options.swap_eyes,
                 "The right eye's picture where the layout has the left's, and the other way round, as for "
                 "interlaced screens whose first row is the right eye's.");
    flags.text("--compare", "VARIANTS", compare,
               "Further pictures NAME.warp.png and so on, separated by commas: warp (the middle picture "
               "warped), remap (one curve instead of edits, stereo.remap), unedited.",
               "none");
    flags.text(
        "--maps", "PREFIX", options.maps,
        "Write disparity PREFIX.before and .after, of both eyes PREFIX.left and .right (PFM in pixels, "
        "PNG in colours), what only one eye sees, and PREFIX.conflicts.png.",
        "none");
    flags.text("--report", "FILE", options.report,
               "Write a page about the pair (.html, needs nothing else): disparity and anaglyph before and "
               "after, conflicts, histograms, convergence, times.",
               "none");
    run.add_frames_to(flags);
    flags.group("Editing");
    flags.text("--solver", "SOLVER", solver, "multigrid, fmg, vcycle or cascade.", "the scene's");
    flags.whole("--map-scale", "N", map_scale, 1, 8, "Solve at 1 : N of the picture: 1, 2, 4 or 8.",
                "the scene's");
    flags.on_off("--preview", options.preview,
                 "Pictures a quarter as wide and high, one sample per pixel, coarse shadows: for a quick "
                 "look at edits.");
    run.add_execution_to(flags, "Write times (s), counts and disparities (pixels) as JSON.");
    if (!flags.parse(arguments)) return 0;

    options.run = run.value();
    add_overrides(solver, map_scale, options.run.overrides);
    options.layout = layout_value("--layout", layout);
    check_swap(options);
    if (!compare.empty()) options.compare = compare_value("--compare", compare);
    options.run.exec = run.exec();
    return stereo_command(options);
}

}  // namespace obscura
