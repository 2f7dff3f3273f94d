#pragma once
// What a run of the shadow bench found, as plain rows; reports and charts read nothing else.

#include <cstdint>
#include <string>
#include <vector>

#include "bench/shadows/wrong_pixels.h"
#include "hierarchy/build.h"

namespace obscura {

inline constexpr const char* dense_name = "dense";
inline constexpr const char* compressed_name = "compressed";
inline constexpr const char* exact_name = "exact";
inline constexpr const char* embree_name = "Embree";

/// Shadows of one map against exact rays.
struct AccuracyRow {
    std::string scene;
    std::size_t triangles = 0;
    std::string method;
    int size = 0;  ///< texels a side
    std::int64_t bytes = 0;
    double build_s = 0;  ///< with all threads, once
    WrongPixels wrong;
    std::size_t worse = 0, better = 0;  ///< compressed: pixels wrong where the dense map of the same size is
                                        ///< right, and right where it is wrong
    bool has_dense = false;             ///< whether there is one
    double naive_steps = 0, shared_steps = 0;  ///< compressed: nodes visited per pixel for a kernel of 5x5
};

/// One timed job of one method.
struct TimeRow {
    std::string scene;
    std::size_t triangles = 0;
    std::string method;
    int size = 0;     ///< of the map; 0: rays
    std::string job;  ///< "build", "1 tap", "3x3" ...
    int threads = 1;
    std::size_t lookups = 0;  ///< pixels that face the light; 0: not a lookup
    std::int64_t bytes = 0;   ///< of the map, or of the rays' hierarchy
    std::vector<double> runs_ms;
    std::string version, problem;
    /// Millions of lookups per second and thread, by the median run; 0 without.
    double rate() const;
};

/// A tree's size and the work of building it.
struct SizeRow {
    std::string scene;
    std::size_t triangles = 0;
    int size = 0;
    MultiresCounts nodes;
    std::int64_t words24 = 0, words16 = 0, bytes16 = 0;  ///< bytes in each layout
    BuildStats stats;
    double build_s = 0, encode_s = 0;
    std::int64_t peak_bytes = 0;  ///< resident memory above what was there before
    std::string problem;
};

/// Top-down against bottom-up on the same intervals.
struct DirectionRow {
    std::string scene;
    int size = 0;
    MultiresCounts bottom_up, top_down;
    std::int64_t bottom_up_bytes = 0, top_down_bytes = 0;
    double bottom_up_s = 0, top_down_s = 0;  ///< from intervals to the tree
};

/// A shadow of a scene under one sun, as frames make it, against exact rays.
struct SweepRow {
    std::string scene;
    std::size_t triangles = 0;
    double elevation_deg = 0;
    std::string method;
    int asked = 0;             ///< compressed: texels a side; 0: auto
    double magnification = 1;  ///< auto: pixels that a texel may span at most
    int found = 0;             ///< what it came to
    std::uint64_t bytes = 0;
    double build_s = 0;
    WrongPixels wrong;
    std::string problem;  ///< why there is no result
};

struct ShadowResults {
    std::vector<AccuracyRow> accuracy;
    std::vector<SweepRow> sweep;
    std::vector<TimeRow> times;
    std::vector<SizeRow> sizes;
    std::vector<DirectionRow> directions;
};

}  // namespace obscura
