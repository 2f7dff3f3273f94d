#pragma once
// The part "soft" of the shadow bench: all points of a light with a size for every sample of a frame, beside
// as many of Embree's rays.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/harness/options.h"
#include "bench/shadows/scenes.h"

namespace obscura {

/// A light with a size, put in the place of a scene's sun.
struct SoftSubject {
    const char* name;
    std::function<void(const Scene&, Light&)> shape;
};
const std::vector<SoftSubject>& soft_subjects();

struct SoftRow {
    std::string scene, light;
    std::size_t triangles = 0, covered = 0;  ///< covered: samples that see a surface
    int points = 0, threads = 1;
    std::vector<double> order_ms, lookup_ms, hierarchy_ms, packets_ms;
    std::int64_t pairs = 0,
                 apart = 0;  ///< of sample and point that both ask; where they differ; with 1 thread
    std::string problem;
    double ours_ms() const;  ///< order and lookups, medians; 0 when not measured
    double rays_ms() const;
    /// Rays over ours: above 1 ours is faster. Of rays alone, as if their hierarchy were kept; with it.
    double kept_ratio() const;
    double ratio() const;
};

/// Writes shadows_soft.csv and .md, and with gnuplot shadows_soft.svg. Returns an exit code. Throws
/// UsageError when options.scene is in no scene's name.
int bench_soft(const BenchOptions& options);

}  // namespace obscura
