// The command line: finds the command, runs it, turns errors into messages and exit codes.

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "app/cli/commands.h"
#include "app/cli/progress.h"
#include "app/cli/signals.h"
#include "app/report/program_version.h"
#include "app/scene/schema.h"
#include "core/error.h"
#include "core/file_output.h"

namespace obscura {
namespace {

struct Command {
    const char* name;
    const char* summary;
    int (*run)(const Arguments&);
};

constexpr Command commands[] = {
    {"render", "Render a scene file to pictures", run_render},
    {"check", "Validate a scene and say what rendering it would take", run_check},
    {"dump", "Print the effective scene, or the description of the format", run_dump},
    {"info", "Print what a mesh file holds", run_info},
    {"diff", "Compare two pictures", run_diff},
    {"diffraction", "Compute the light behind an aperture: far field, near field, colours", run_diffraction},
    {"stereo", "Render a scene for two eyes, with edited disparity", run_stereo},
    {"bench", "Measure our methods beside their peers", run_bench},
    {"lesson", "Draw the picture of a lesson", run_lesson},
    {"version", "Print version, instruction sets and libraries", run_version},
};

std::string short_help() {
    std::string out =
        program_version() + ": renders scene files on the CPU\n\nUsage: obscura COMMAND [options]\n\n";
    for (const Command& c : commands)
        out += fmt::format("  {:<12}{}\n", c.name, c.summary);
    return out + "\n'obscura COMMAND --help' explains a command.\n";
}

std::vector<std::string> command_names() {
    std::vector<std::string> names;
    for (const Command& c : commands)
        names.emplace_back(c.name);
    return names;
}

int run(const Arguments& arguments) {
    if (arguments.empty()) {
        fmt::print(stderr, "{}", short_help());
        return static_cast<int>(ExitCode::usage);
    }
    const std::string& name = arguments.front();
    if (name == "-h" || name == "--help") {
        fmt::print("{}", short_help());
        return 0;
    }
    const Arguments rest(arguments.begin() + 1, arguments.end());
    if (name == "--version") return run_version(rest);
    const auto command = std::find_if(std::begin(commands), std::end(commands),
                                      [&](const Command& c) { return c.name == name; });
    if (command == std::end(commands)) {
        throw UsageError(
            fmt::format("unknown command '{}'{} (see 'obscura --help')", name, hint(name, command_names())));
    }
    return command->run(rest);
}

/// Prints the message and returns the code.
int report(ExitCode code, const std::string& message) {
    const bool colour = wants_colour(stderr);
    std::fprintf(stderr, "obscura: %serror:%s %s\n", colour ? "\x1b[1;31m" : "", colour ? "\x1b[0m" : "",
                 message.c_str());
    return static_cast<int>(code);
}

/// Exceptions that leave a thread of the library underneath (it could not start its threads, mostly) end up
/// here, with nobody left to catch them: the same message and code, without a core file.
[[noreturn]] void on_terminate() {
    static std::atomic_flag reporting = ATOMIC_FLAG_INIT;
    while (reporting.test_and_set()) {
        ::pause();  // another thread is telling the same story
    }
    remove_pending_outputs();
    ExitCode code = ExitCode::internal;
    std::string message = "ended by an unknown exception";
    try {
        if (const std::exception_ptr exception = std::current_exception()) std::rethrow_exception(exception);
    } catch (const std::bad_alloc&) {
        code = ExitCode::limit;
        message = "out of memory";
    } catch (const std::exception& e) {
        message = e.what();
        if (message.find("pthread_create") != std::string::npos) {
            code = ExitCode::limit;
            message = "out of memory or threads (fewer --threads need less): " + message;
        }
    } catch (...) {
    }
    ::_exit(report(code, message));
}

constexpr int closed_pipe = static_cast<int>(ExitCode::signal_base) + 13;  // as if SIGPIPE had ended us

/// Sends what is buffered; a reader that went away is a quiet end, anything else lost output.
int flush_output(int code) {
    const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (!failed) return code;
    struct stat status {};
    const bool pipe =
        ::fstat(STDOUT_FILENO, &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode));
    if (pipe) return code == 0 ? closed_pipe : code;
    if (code != 0) return code;
    return report(ExitCode::output, "standard output: cannot be written");
}

int run_and_report(const Arguments& arguments) {
    try {
        return run(arguments);
    } catch (const Interrupted& e) {
        return static_cast<int>(ExitCode::signal_base) + e.signal;
    } catch (const UsageError& e) {
        return report(ExitCode::usage, e.what());
    } catch (const InputError& e) {
        return report(ExitCode::bad_input, e.what());
    } catch (const LimitError& e) {
        return report(ExitCode::limit, e.what());
    } catch (const std::bad_alloc&) {
        return report(ExitCode::limit, "out of memory");
    } catch (const OutputError& e) {
        return report(ExitCode::output, e.what());
    } catch (const std::system_error& e) {
        // fmt throws this when standard output cannot be written; flush_output() tells why.
        if (std::ferror(stdout) == 0) return report(ExitCode::internal, e.what());
        return 0;
    } catch (const std::exception& e) {
        return report(ExitCode::internal, e.what());
    }
}

}  // namespace
}  // namespace obscura

int main(int argc, char** argv) {
    obscura::install_signal_handlers();
    std::set_terminate(obscura::on_terminate);
    const obscura::Arguments arguments(argv + std::min(argc, 1), argv + argc);
    return obscura::flush_output(obscura::run_and_report(arguments));
}
