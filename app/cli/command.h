#pragma once
// A command of the program: it reads its flags and hands over to the function that does the work.

#include <string>
#include <vector>

namespace obscura {

/// What stands behind the command's name on the command line.
using Arguments = std::vector<std::string>;

/// Returns the exit code and throws what core/error.h lists, or Interrupted.
using RunCommand = int (*)(const Arguments& arguments);

}  // namespace obscura
