#pragma once
// What commands share that render a scene frame after frame.

#include <filesystem>
#include <functional>
#include <new>
#include <string>
#include <vector>

#include "app/cli/progress.h"
#include "app/models/file_access.h"
#include "app/scene/scene_file.h"
#include "core/error.h"
#include "core/file_output.h"
#include "core/isa.h"

namespace obscura {

/// Which scene and frames, how to execute, what to say.
struct SceneRun {
    std::filesystem::path scene;
    std::vector<std::string> overrides;                ///< "key=value"
    std::vector<std::filesystem::path> allowed_paths;  ///< besides the scene's folder
    bool allow_missing = false;                        ///< mesh files may lack materials and textures
    std::string frames;                                ///< "1-48x2", "1,5,9-12"; empty: all of the scene
    std::filesystem::path stats_json;                  ///< empty: none; "-": standard output
    bool overwrite = false;
    bool quiet = false;
    int verbosity = 0;
    Exec exec;

    Existing existing() const { return overwrite ? Existing::replace : Existing::refuse; }
};

/// The files that the scene may name; `read` has the scene file and all that it names, and gets whatever
/// these lead to.
FileAccess recording_access(const SceneRun& run, const SceneDocument& document);

/// The frames that the run asks for, ascending. Throws UsageError.
std::vector<int> frames_of(const SceneRun& run, const SceneDocument& document);

/// Calls `work` with each frame in turn, each an equal share of the progress.
void for_each_frame(const std::vector<int>& frames, Progress& progress, const std::function<void(int)>& work);

/// Runs one stage; when memory ends in it, the message says in which.
template <class Fn>
auto in_stage(const std::string& stage, Fn&& fn) {
    try {
        return fn();
    } catch (const std::bad_alloc&) {
        throw LimitError("out of memory while " + stage);
    }
}

}  // namespace obscura
