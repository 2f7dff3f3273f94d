#pragma once
// The part "soft-error" of the shadow bench: how far from the light of thousands of points that of 16 to 1024
// is, and what it takes, by every way there is.

#include <cstdint>
#include <string>
#include <vector>

#include "bench/harness/options.h"
#include "bench/harness/panel_chart.h"
#include "bench/shadows/scenes.h"

namespace obscura {

inline constexpr const char* stack_name = "stack";

/// The share of a light that reaches each sample of a frame, by so many of its points.
struct SoftErrorRow {
    std::string scene, light, method;
    std::size_t triangles = 0, covered = 0;  ///< covered: samples that see a surface
    int points = 0;
    int texels = 0;                      ///< of a stack's maps, a side; 0: without maps
    double build_ms = 0, lookup_ms = 0;  ///< wall clock, of one run
    double rmse = 0;                     ///< of the share, in [0, 1], over the covered samples
    std::uint64_t bytes = 0;             ///< of the stack
};

/// How much is measured.
struct SoftErrorPlan {
    PictureSize picture{320, 180};
    std::vector<int> points{16, 64, 256, 1024};
    int reference_points = 4096;
    int texels = 512;  ///< of the stack's maps, a side
    /// Lights whose points have casters of their own take these for each: left out of larger meshes.
    std::size_t most_triangles = 20000;
};
SoftErrorPlan soft_error_plan(bool quick);

/// Ways: `exact` points one after the other, a stack of the same points' maps, and Embree's rays to them
/// where that is there. The reference is `exact` by plan.reference_points.
std::vector<SoftErrorRow> measure_soft_errors(const ShadowRecipe& recipe, const SoftErrorPlan& plan,
                                              const BenchOptions& options);

std::string soft_error_csv(const std::vector<SoftErrorRow>& rows);
std::string soft_error_markdown(const std::vector<SoftErrorRow>& rows, const SoftErrorPlan& plan);
PanelChart soft_error_chart(const std::vector<SoftErrorRow>& rows, const SoftErrorPlan& plan);

/// The whole part: writes shadows_soft_error.csv and .md, and with gnuplot .svg. Returns an exit code. Throws
/// UsageError when options.scene is in no scene's name.
int bench_soft_error(const BenchOptions& options);

}  // namespace obscura
