#pragma once
// What a render took, for machines: obscura render --stats-json FILE. The schema is in README.md.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/frame/frame.h"
#include "app/frame/memory.h"
#include "app/report/picture_file.h"
#include "app/scene/scene.h"
#include "core/isa.h"

namespace obscura {

struct WrittenFile {
    std::string file;
    Aov aov = Aov::beauty;
    std::int64_t bytes = 0;
    std::optional<DepthRange> depth;
};

struct FrameReport {
    int frame = 0;
    FrameStats stats;
    double write_s = 0;  ///< encoding and writing all files
    std::vector<WrittenFile> files;
};

struct RenderReport {
    std::string scene;
    Exec exec;
    int width = 0, height = 0, samples = 0;  ///< of the pictures that are written
    MemoryEstimate memory;
    std::int64_t limit_mib = 0;
    double load_s = 0, total_s = 0;
    std::vector<FrameReport> frames;
};

/// Most memory this process ever held, bytes.
std::int64_t peak_resident_bytes();

std::string stats_json(const RenderReport& report);

}  // namespace obscura
