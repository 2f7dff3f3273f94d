#pragma once
// What `obscura render` settles before it loads the scene.

#include <optional>
#include <vector>

#include "app/cli/flag_values.h"
#include "app/cli/render_command.h"
#include "app/frame/render_frame.h"

namespace obscura {

struct RenderPlan {
    SceneDocument document;
    RenderSettings render;
    std::vector<int> frames;
    std::vector<PlannedOutput> outputs;
    FrameOptions frame_options;       ///< crop, and the channels that the files need
    std::optional<PixelPlace> pixel;  ///< to be explained instead of rendering
};

/// Reads the scene and holds the flags against it. Throws UsageError, InputError, LimitError.
RenderPlan plan_render(const RenderOptions& options);

/// The pictures of all frames.
std::vector<std::filesystem::path> result_files(const RenderPlan& plan);

}  // namespace obscura
