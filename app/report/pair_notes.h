#pragma once
// What a stereo pair has to say for itself, in lines for people.

#include <string>
#include <vector>

#include "app/pair/pair.h"
#include "app/scene/stereo_settings.h"

namespace obscura {

/// Where the screen stands when nobody said so; edits without effect; conflicts, a line per kind; a solver
/// that stopped early; edits that were not satisfied, and what pulled the other way; cracks.
std::vector<std::string> stereo_notes(const StereoPair& pair, const StereoSettings& settings);

/// Sizes, iterations, triangles and times: lines, each with its end.
std::string stereo_details(const StereoPair& pair, const StereoSettings& settings);

/// "multigrid", ...
const char* solver_name(SolverMethod method);

}  // namespace obscura
