#include "app/cli/scene_run.h"

#include <fmt/format.h>

#include <memory>

#include "app/cli/flag_values.h"
#include "app/scene/keyframes.h"
#include "app/scene/named_files.h"

namespace obscura {

FileAccess recording_access(const SceneRun& run, const SceneDocument& document) {
    FileAccess access{document.folder, run.allowed_paths, run.allow_missing, std::make_shared<ReadFiles>()};
    access.read->add(run.scene);
    // What is not read this time is as good as what is.
    for (const auto& file : named_files(document))
        access.read->add(file);
    return access;
}

std::vector<int> frames_of(const SceneRun& run, const SceneDocument& document) {
    const FrameRange range = scene_frames(document);
    if (!run.frames.empty()) return frame_values("--frames", run.frames, range);
    std::vector<int> frames;
    frames.reserve(static_cast<std::size_t>(range.count()));
    for (int i = 0; i < range.count(); ++i)
        frames.push_back(range.at(i));
    return frames;
}

void for_each_frame(const std::vector<int>& frames, Progress& progress,
                    const std::function<void(int)>& work) {
    const auto count = static_cast<double>(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const auto done = static_cast<double>(i);
        progress.begin(fmt::format("frame {} ({} of {})", frames[i], i + 1, frames.size()), done / count,
                       (done + 1) / count);
        work(frames[i]);
    }
}

}  // namespace obscura
