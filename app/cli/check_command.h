#pragma once
// obscura check SCENE: reads, loads and validates everything, says what rendering would compute, renders and
// writes nothing.

#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/command.h"

namespace obscura {

struct CheckOptions {
    std::filesystem::path scene;
    std::vector<std::string> overrides;                ///< -D key=value
    std::vector<std::filesystem::path> allowed_paths;  ///< --allow-path DIR
    bool allow_missing = false;                        ///< --allow-missing
};

/// The report as text. Throws InputError, LimitError.
std::string check_report(const CheckOptions& options);

/// Prints the report. Returns the exit code.
int check_command(const CheckOptions& options);

/// The command line of it.
int run_check(const Arguments& arguments);

}  // namespace obscura
