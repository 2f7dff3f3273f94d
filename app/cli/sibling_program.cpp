#include "app/cli/sibling_program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "core/error.h"

namespace obscura {
namespace {

/// The file of this name in the folder of this executable, behind any links to it; empty where that cannot be
/// known.
std::filesystem::path beside_this(const std::string& name) {
    std::error_code unreadable;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", unreadable);
    return unreadable ? std::filesystem::path() : self.parent_path() / name;
}

}  // namespace

void become_sibling(const std::string& command, const Arguments& arguments) {
    std::string name = "obscura-" + command;
    Arguments line = arguments;
    std::vector<char*> argv{name.data()};
    for (std::string& argument : line)
        argv.push_back(argument.data());
    argv.push_back(nullptr);

    ::execv(beside_this(name).c_str(), argv.data());
    const int beside = errno;
    ::execvp(name.c_str(), argv.data());
    const int reason = beside == ENOENT ? errno : beside;
    throw UsageError(
        fmt::format("'obscura {0}' is a program of its own, {1}, which cannot be started from the folder of "
                    "this one or from PATH: {2}; in the source folder './obscura {0}' builds it",
                    command, name, std::strerror(reason)));
}

}  // namespace obscura
