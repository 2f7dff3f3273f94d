#pragma once
// Which files `obscura stereo` writes.

#include <filesystem>
#include <string>
#include <vector>

#include "stereo/layout.h"

namespace obscura {

/// Comparisons beside the pair, each labelled by the name of its file.
struct StereoCompare {
    bool warp = false;      ///< the middle picture warped instead of the scene rendered
    bool remap = false;     ///< one curve of disparity for the whole picture instead of edits
    bool unedited = false;  ///< what the rig alone gives
};
/// "warp,unedited". Throws UsageError.
StereoCompare compare_value(const std::string& flag, const std::string& text);

struct StereoFile {
    std::string role, pattern;
    int least_run = 1;  ///< of # that is the frame number, as PlannedOutput has it
};

struct StereoFileRequest {
    std::string output, maps, report;  ///< -o, --maps, --report
    StereoLayout layout = StereoLayout::side_by_side;
    StereoCompare compare;
    bool several_frames = false;  ///< are rendered
    // The shortest runs of # that are the frame number, as PlannedOutput has it; of -o, and of the others.
    int output_run = 1, least_run = 1;
};

/// Every file of a frame: NAME.png, or NAME.left.png and NAME.right.png; NAME.warp.png and so on;
/// PREFIX.before.pfm and so on; the report's page. Throws UsageError for suffixes other than .png (.html),
/// several frames without #### in a name, and names that meet.
std::vector<StereoFile> plan_stereo_files(const StereoFileRequest& request);

/// The file of a role at one frame; the role must be planned.
std::filesystem::path stereo_path(const std::vector<StereoFile>& files, const std::string& role, int frame);

}  // namespace obscura
