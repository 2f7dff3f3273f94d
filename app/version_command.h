#pragma once
// obscura version: what this program is made of and what it runs on here.

#include <string>

namespace obscura {

/// "obscura 0.1.0".
std::string program_version();

/// Prints version, compiler, build type, instruction sets, threads and library versions. Returns an exit
/// code.
int version_command();

}  // namespace obscura
