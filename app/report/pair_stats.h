#pragma once
// What stereo pairs took and came to, for machines: obscura stereo --stats-json FILE. The schema is in
// README.md.

#include <cstdint>
#include <string>
#include <vector>

#include "app/pair/pair.h"
#include "app/report/run_stats.h"
#include "app/scene/stereo_settings.h"

namespace obscura {

struct StereoWritten {
    std::string file, role;
    std::int64_t bytes = 0;
};

/// Numbers of one frame's pair.
struct StereoFrameReport {
    int frame = 0;
    StereoTimes times;
    double write_s = 0, compare_s = 0;
    int margin_px = 0, map_scale = 1;
    SolverMethod solver = SolverMethod::multigrid;
    bool warm = false;
    SolveReport solve;
    std::vector<Conflict> conflicts;
    ReprojectStats reprojection;
    DisparityError realised, left, right;
    std::optional<DisparityError> temporal;
    std::int64_t cracks = 0, bytes = 0;
    std::int64_t warp_holes = 0;
    std::vector<std::string> notes;
    std::vector<StereoWritten> files;
};

struct StereoReport {
    RunReport run;  ///< width and height: of one eye's picture
    std::string layout;
    bool swapped_eyes = false, preview = false;
    std::vector<StereoFrameReport> frames;
};

StereoFrameReport frame_report(int frame, const StereoPair& pair, const StereoSettings& settings);

std::string stereo_stats_json(const StereoReport& report);

}  // namespace obscura
