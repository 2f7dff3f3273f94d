#pragma once
// obscura version: what this program is made of and what it runs on here.

#include "app/cli/command.h"

namespace obscura {

/// Prints version, compiler, build type, instruction sets, threads and library versions. Returns an exit
/// code.
int version_command();

/// The command line of it.
int run_version(const Arguments& arguments);

}  // namespace obscura
