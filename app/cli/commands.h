#pragma once
// The commands of the program: each reads its flags and hands over to the function that does the work.

#include <string>
#include <vector>

namespace obscura {

/// What stands behind the command's name on the command line.
using Arguments = std::vector<std::string>;

// Each returns the exit code and throws what core/error.h lists, or Interrupted.
int run_render(const Arguments& arguments);
int run_check(const Arguments& arguments);
int run_dump(const Arguments& arguments);
int run_info(const Arguments& arguments);
int run_diff(const Arguments& arguments);
int run_diffraction(const Arguments& arguments);
int run_stereo(const Arguments& arguments);
int run_bench(const Arguments& arguments);
int run_lesson(const Arguments& arguments);
int run_version(const Arguments& arguments);

}  // namespace obscura
