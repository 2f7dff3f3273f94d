#pragma once
// obscura render SCENE: from a scene file to picture files.

#include <string>
#include <vector>

#include "app/cli/command.h"
#include "app/cli/scene_run.h"
#include "app/report/output_plan.h"
#include "app/scene/scene.h"

namespace obscura {

struct RenderOptions {
    SceneRun run;
    std::string output;  ///< empty: the scene's list, else SCENE.png
    std::vector<Aov> aovs;
    FileKind aov_kind = FileKind::pfm;
    std::string crop;   ///< "x0,y0,x1,y1"; empty: everything
    std::string pixel;  ///< "x,y": print what made it, write nothing; empty: off
};

/// Renders and writes; tells its progress on standard error. Everything that can be refused is refused
/// before the first tile: flags, the scene, limits, files that exist or cannot be written. Returns the exit
/// code. Throws UsageError, InputError, LimitError, OutputError, Interrupted.
int render_command(const RenderOptions& options);

/// The command line of it.
int run_render(const Arguments& arguments);

}  // namespace obscura
