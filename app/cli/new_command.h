#pragma once
// obscura new FILE: a scene to begin with.

#include <filesystem>
#include <span>
#include <string>

#include "app/cli/command.h"
#include "core/file_output.h"

namespace obscura {

/// A commented scene that needs no other file.
struct Starter {
    const char* name;
    const char* summary;
    const char* text;
    bool stereo;  ///< is for `obscura stereo`
};

/// In the order of the help; the first is what `new` writes without further words.
std::span<const Starter> starters();

struct NewOptions {
    std::filesystem::path file;  ///< ".toml" is added where it does not end so
    std::string kind = "place";
    Existing existing = Existing::refuse;
};

/// Writes the scene and says how to render it. Throws UsageError for an unknown kind, OutputError.
int new_command(const NewOptions& options);

/// The command line of it.
int run_new(const Arguments& arguments);

}  // namespace obscura
