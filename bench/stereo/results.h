#pragma once
// What the stereo bench finds out.

#include <cstdint>
#include <string>
#include <vector>

namespace obscura {

// What a solve must reach to count as one.
constexpr double stereo_goal_max_px = 0.05, stereo_goal_rms_px = 0.02;

inline constexpr const char* multigrid_name = "multigrid";
inline constexpr const char* fmg_name = "full multigrid";
inline constexpr const char* vcycle_name = "V-cycles";
inline constexpr const char* cascade_name = "cascade";
inline constexpr const char* printed_name = "cascade, sign as printed";
inline constexpr const char* half_name = "cascade, 16-bit maps";
inline constexpr const char* cg_name = "Eigen CG, diagonal";
inline constexpr const char* cg_ic_name = "Eigen CG, incomplete Cholesky";
inline constexpr const char* ldlt_name = "Eigen SimplicialLDLT";
inline constexpr const char* cholmod_name = "CHOLMOD supernodal";

/// Against the truth, over valid pixels. Pixels of the map's resolution; infinite if anything is not finite.
struct MapError {
    double max_px = 0, rms_px = 0;
    bool within_goal() const { return max_px < stereo_goal_max_px && rms_px < stereo_goal_rms_px; }
};

/// A solve cut short.
struct CurvePoint {
    int step = 0;   ///< iterations; cascade: sweeps per level
    double ms = 0;  ///< from the call to here, everything included
    MapError error;
};

/// One method at one size on so many threads.
struct StereoRow {
    int width = 0, height = 0;
    std::string method;
    int threads = 1;
    bool peer = false;
    double whole_ms = 0;  ///< least time of the whole call, stopped by its own estimate (iterative peers:
                          ///< when the goal was reached); 0: not measured
    double kept_ms = 0;   ///< the same call when an earlier one left the levels of its matrix; 0: the same
    double setup_ms = 0, iterate_ms = 0;  ///< what the method says of the whole call's parts
    int iterations = 0;
    MapError error;  ///< of what the call returned
    double estimate_max_px = -1, estimate_rms_px = -1;
    std::vector<CurvePoint> curve;
    std::string note;
    std::string problem;  ///< why it was not measured, or did not finish
};

/// One pass over memory: 3 reads and 1 write of as many floats as there are unknowns.
struct PassRow {
    int width = 0, height = 0, threads = 1;
    double ms = 0;
};

/// The truth of one system.
struct TruthRow {
    std::string stereo_case;
    int width = 0, height = 0;
    std::string by;
    double residual = 0;  ///< largest |b - A x|, in double
};

/// One edited picture solved by multigrid.
struct CaseRow {
    std::string stereo_case;
    int width = 0, height = 0, sets = 0;
    int iterations = 0;  ///< until its own estimate stopped it
    int needed = -1;     ///< after which the goal is kept; -1: not within the most that were tried
    MapError start, error, cascade;
    double estimate_max_px = 0, estimate_rms_px = 0;
    double ms = 0;
};

inline constexpr const char* sampled_way = "edits on samples";
inline constexpr const char* summed_way = "reduced system";

/// Solved at 1:reduction, brought up to full size.
struct PreviewRow {
    int width = 0, height = 0, reduction = 1, threads = 1;
    std::string way;      ///< one of the above; empty: the full system
    double ms = 0;        ///< all of what follows
    double build_ms = 0;  ///< reduced system: out of the full one
    double solve_ms = 0, upsample_ms = 0;
    MapError error = {};  ///< against the truth at full resolution
};

struct StereoResults {
    std::vector<StereoRow> rows;
    std::vector<PassRow> passes;
    std::vector<TruthRow> truths;
    std::vector<CaseRow> cases;
    std::vector<PreviewRow> previews;
    std::string cholmod, eigen;  ///< versions; empty: absent
};

}  // namespace obscura
