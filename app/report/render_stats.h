#pragma once
// What a render took, for machines: obscura render --stats-json FILE. The schema is in README.md.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/frame/frame.h"
#include "app/frame/memory.h"
#include "app/report/picture_file.h"
#include "app/report/run_stats.h"
#include "app/scene/scene.h"

namespace obscura {

struct WrittenFile {
    std::string file;
    Aov aov = Aov::beauty;
    std::int64_t bytes = 0;
    std::optional<PictureDepths> depth;
};

struct FrameReport {
    int frame = 0;
    FrameStats stats;
    double write_s = 0;  ///< encoding and writing all files
    std::vector<WrittenFile> files;
};

struct RenderReport {
    RunReport run;
    MemoryEstimate memory;
    std::vector<FrameReport> frames;
};

std::string stats_json(const RenderReport& report);

}  // namespace obscura
