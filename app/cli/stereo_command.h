#pragma once
// obscura stereo SCENE: from a scene file to pictures for two eyes.

#include <string>

#include "app/cli/command.h"
#include "app/cli/scene_run.h"
#include "app/cli/stereo_plan.h"
#include "stereo/layout.h"

namespace obscura {

struct StereoOptions {
    SceneRun run;
    std::string output;  ///< empty: SCENE.stereo.png
    StereoLayout layout = StereoLayout::side_by_side;
    bool swap_eyes = false;  ///< in a layout of both: the right eye's picture where the left's would be
    StereoCompare compare;
    std::string maps;      ///< prefix of the maps' files; empty: none
    std::string report;    ///< a page about the pair (.html); empty: none
    bool preview = false;  ///< small pictures, one sample
};

/// Side of a preview's pictures: the scene's divided by this, rounded up.
constexpr int preview_scale = 4;

/// Renders and writes; tells its progress, and what the edits met with, on standard error. Everything that
/// can be refused is refused before the first tile. Returns the exit code. Throws UsageError, InputError,
/// LimitError, OutputError, Interrupted.
int stereo_command(const StereoOptions& options);

/// The command line of it.
int run_stereo(const Arguments& arguments);

}  // namespace obscura
