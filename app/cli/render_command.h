#pragma once
// obscura render SCENE: from a scene file to picture files.

#include <filesystem>
#include <string>
#include <vector>

#include "app/report/output_plan.h"
#include "app/scene/scene.h"
#include "core/isa.h"

namespace obscura {

struct RenderOptions {
    std::filesystem::path scene;
    std::vector<std::string> overrides;                ///< "key=value"
    std::vector<std::filesystem::path> allowed_paths;  ///< besides the scene's folder
    std::string output;                                ///< empty: the scene's list, else SCENE.png
    std::vector<Aov> aovs;
    FileKind aov_kind = FileKind::pfm;
    std::string frames;                ///< "1-48x2", "1,5,9-12"; empty: all of the scene
    std::string crop;                  ///< "x0,y0,x1,y1"; empty: everything
    std::string pixel;                 ///< "x,y": print what made it, write nothing; empty: off
    std::filesystem::path stats_json;  ///< empty: none
    bool overwrite = false;
    bool quiet = false;
    int verbosity = 0;
    Exec exec;
};

/// Renders and writes; tells its progress on standard error. Everything that can be refused is refused
/// before the first tile: flags, the scene, limits, files that exist or cannot be written. Returns the exit
/// code. Throws UsageError, InputError, LimitError, OutputError, Interrupted.
int render_command(const RenderOptions& options);

}  // namespace obscura
