#pragma once
// The flags of every command that reads a scene.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/flags.h"

namespace obscura {

/// Must outlive the parsing of the flags it was added to.
struct SceneFlags {
    std::string scene, size;
    std::vector<std::string> overrides, allowed;
    std::int64_t samples = 0, memory_mib = 0;  ///< 0 = what the scene says

    /// Adds SCENE and the flags that change what it says.
    void add_to(Flags& flags);
    /// All changes as "key=value", -D first, so that a flag of its own wins.
    std::vector<std::string> all_overrides() const;
    std::vector<std::filesystem::path> allowed_paths() const { return {allowed.begin(), allowed.end()}; }
};

}  // namespace obscura
