#pragma once
// The main of every program: from its arguments to an exit code.

#include "app/cli/command.h"

namespace obscura {

/// Handles signals, runs `run` on the arguments, turns what it throws into a message on standard error and
/// the exit code that core/error.h lists, and sends what standard output still holds. Exceptions that nobody
/// can catch, in threads of a library, end the process with the same messages and codes.
int run_program(int argc, char** argv, RunCommand run);

}  // namespace obscura
