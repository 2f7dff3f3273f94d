#pragma once
// Which files a render writes.

#include <filesystem>
#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace obscura {

enum class FileKind { png, pfm };

/// One picture per frame. The last run of # in the file's name (never its folders) stands for the frame
/// number, padded with zeros to as many digits, when it has `least_run` or more.
struct PlannedOutput {
    Aov aov = Aov::beauty;
    std::string pattern;
    FileKind kind = FileKind::png;
    int least_run = 1;  ///< 0: no # is a number
};

/// A single # is the frame number where the scene has several frames; elsewhere it is a # ("take #3.png").
constexpr int least_number_run(bool scene_has_several_frames) {
    return scene_has_several_frames ? 1 : 2;
}

struct OutputRequest {
    std::string output;     ///< -o; empty: the scene's list, else SCENE.png in the current folder
    std::vector<Aov> aovs;  ///< --aov: further pictures NAME.AOV.png or .pfm beside the first
    FileKind aov_kind = FileKind::pfm;
    std::string scene_stem;                 ///< file name of the scene without its suffix
    bool several_frames = false;            ///< are rendered
    bool scene_has_several_frames = false;  ///< whether they are or not
};

/// Whether `pattern` has a place for the frame number.
bool has_frame_number(const std::string& pattern);

/// Throws UsageError for another suffix than .png or .pfm, for several frames without #, and when two
/// pictures would go to one file.
std::vector<PlannedOutput> plan_outputs(const OutputRequest& request,
                                        const std::vector<Output>& scene_outputs);

/// The file of one frame.
std::filesystem::path output_path(const PlannedOutput& output, int frame);

/// .png or .pfm, in any case.
FileKind file_kind(const std::string& file);

}  // namespace obscura
