#pragma once
// obscura dump SCENE: the effective scene as TOML, defaults and overrides included.
// obscura dump --format: the description of the scene format.

#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/command.h"

namespace obscura {

struct DumpOptions {
    std::filesystem::path scene;
    std::vector<std::string> overrides;  ///< -D key=value
    bool format = false;                 ///< print the format's description instead; needs no scene
};

/// Prints to standard output. Returns the exit code. Throws InputError, LimitError.
int dump_command(const DumpOptions& options);

/// The command line of it.
int run_dump(const Arguments& arguments);

}  // namespace obscura
