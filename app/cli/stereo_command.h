#pragma once
// obscura stereo SCENE: from a scene file to pictures for two eyes.

#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/stereo_plan.h"
#include "core/isa.h"
#include "stereo/layout.h"

namespace obscura {

struct StereoOptions {
    std::filesystem::path scene;
    std::vector<std::string> overrides;                ///< "key=value"
    std::vector<std::filesystem::path> allowed_paths;  ///< besides the scene's folder
    std::string output;                                ///< empty: SCENE.stereo.png
    StereoLayout layout = StereoLayout::side_by_side;
    StereoCompare compare;
    std::string maps;                  ///< prefix of the maps' files; empty: none
    std::string report;                ///< a page about the pair (.html); empty: none
    std::string frames;                ///< "1-48x2", "1,5,9-12"; empty: all of the scene
    bool preview = false;              ///< small pictures, one sample
    std::filesystem::path stats_json;  ///< empty: none
    bool overwrite = false;
    bool quiet = false;
    int verbosity = 0;
    Exec exec;
};

/// Side of a preview's pictures: the scene's divided by this, rounded up.
constexpr int preview_scale = 4;

/// Renders and writes; tells its progress, and what the edits met with, on standard error. Everything that
/// can be refused is refused before the first tile. Returns the exit code. Throws UsageError, InputError,
/// LimitError, OutputError, Interrupted.
int stereo_command(const StereoOptions& options);

}  // namespace obscura
