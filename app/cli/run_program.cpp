#include "app/cli/run_program.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "app/cli/messages.h"
#include "app/cli/signals.h"
#include "core/error.h"
#include "core/file_output.h"

namespace obscura {
namespace {

/// Says the message, without asking for memory, and returns the code.
int report(ExitCode code, const std::string& message) {
    const bool colour = wants_colour(stderr);
    (void)std::fprintf(stderr, "obscura: %serror:%s %s\n", colour ? "\x1b[1;31m" : "",
                       colour ? "\x1b[0m" : "", message.c_str());
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

int run_and_report(RunCommand run, const Arguments& arguments) {
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
    } catch (const std::exception& e) {
        return report(ExitCode::internal, e.what());
    }
}

}  // namespace

int run_program(int argc, char** argv, RunCommand run) {
    install_signal_handlers();
    std::set_terminate(on_terminate);
    const Arguments arguments(argv + std::min(argc, 1), argv + argc);
    return flush_output(run_and_report(run, arguments));
}

}  // namespace obscura
