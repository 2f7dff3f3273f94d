#pragma once
// What a render has to say for itself, for people.

#include <string>
#include <vector>

#include "app/report/render_stats.h"

namespace obscura {

/// What will be rendered on what, and the memory it takes: lines, each with its end.
std::string plan_text(const RenderReport& report, std::size_t frames);

/// "frame 1 in 0.15 s: a.pfm, a.depth.png (0 = 7.08 m, 65534 = 8.88 m)"; with a verbosity above 0 also what
/// each stage took. Lines, each with its end.
std::string frame_text(const FrameReport& report, int verbosity);

/// What is right to ask for but often a mistake: nothing to see, a sun that has set.
std::vector<std::string> scene_notes(const Scene& scene, int frame);

}  // namespace obscura
