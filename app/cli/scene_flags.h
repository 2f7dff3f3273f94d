#pragma once
// The flags of every command that reads a scene.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/flag_values.h"
#include "app/cli/flags.h"
#include "app/cli/scene_run.h"

namespace obscura {

/// Must outlive the parsing of the flags it was added to.
struct SceneFlags {
    std::string scene, size;
    std::vector<std::string> overrides, allowed;
    bool allow_missing = false;
    std::int64_t samples = 0, memory_mib = 0;  ///< 0 = what the scene says

    /// Adds SCENE and the flags that change what it says.
    void add_to(Flags& flags);
    /// All changes as "key=value", -D first, so that a flag of its own wins.
    std::vector<std::string> all_overrides() const;
    std::vector<std::filesystem::path> allowed_paths() const {
        return folder_values("--allow-path", allowed);
    }
};

/// The flags of every command that renders a scene. Must outlive their parsing, too.
struct RunFlags {
    SceneFlags scene;
    SceneRun run;
    std::string isa = "auto", stats;
    std::int64_t threads = 0;

    /// --overwrite and --frames.
    void add_frames_to(Flags& flags);
    /// How to execute and what to say; `statistics`: what --stats-json writes.
    void add_execution_to(Flags& flags, const std::string& statistics);
    /// The values, but for `exec`: a command judges its own flags before that.
    SceneRun value() const;
    Exec exec() const;
};

}  // namespace obscura
