#pragma once
// How failures travel: files and flags throw one of the types below, caught once in main; broken
// preconditions end the process through CHECK. Exit codes: see ExitCode.

#include <stdexcept>
#include <string>

namespace obscura {

enum class ExitCode : int {
    ok = 0,
    internal = 1,
    usage = 2,
    bad_input = 3,
    limit = 4,
    output = 5,
    images_differ = 10,
    signal_base = 128,
};

/// A file the user gave is wrong. line and column are 1-based; 0 = unknown.
/// what() is "file:line:column: message" with the unknown parts left out.
struct InputError : std::runtime_error {
    InputError(std::string file_, int line_, int column_, std::string message_);
    InputError(std::string file_, std::string message_)
        : InputError(std::move(file_), 0, 0, std::move(message_)) {}
    std::string file;
    int line = 0, column = 0;
    std::string message;
};

/// A flag or argument is wrong (exit 2).
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A stated limit would be exceeded (exit 4): says which one, the value wanted and the setting that raises
/// it.
struct LimitError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A result could not be written (exit 5).
struct OutputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

[[noreturn]] void check_failed(const char* expression, const char* file, int line, const std::string& values);

}  // namespace obscura

/// Precondition, always on. Further arguments are text for the message: CHECK(a < b, fmt::format("a={}", a)).
#define CHECK(expression, ...)                                                                    \
    do {                                                                                          \
        if (!(expression))                                                                        \
            ::obscura::check_failed(#expression, __FILE__, __LINE__, ::std::string{__VA_ARGS__}); \
    } while (false)
