#pragma once
// obscura version: what this program is made of and what it runs on here.

namespace obscura {

/// Prints version, compiler, build type, instruction sets, threads and library versions. Returns an exit
/// code.
int version_command();

}  // namespace obscura
