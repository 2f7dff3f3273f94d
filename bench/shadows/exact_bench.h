#pragma once
// The part "exact" of the shadow bench: exact shadows of one frame beside Embree's rays and hierarchy.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bench/harness/options.h"
#include "bench/shadows/exact_session.h"
#include "bench/shadows/scenes.h"
#include "bench/shadows/shadow_bench.h"

namespace obscura {

/// What a subject is measured for.
enum class ExactSeries { scenes, samples, triangles };
/// "scenes", "samples", "triangles".
const char* series_name(ExactSeries series);

/// A scene and the pictures of it that ask for shadows, `make` with lights whose shadows are wanted.
struct ExactSubject {
    std::string name;
    ExactSeries series = ExactSeries::scenes;
    std::vector<PictureSize> pictures;
    std::vector<int> samples;  ///< per pixel, 1 or 4: every picture with each
    std::function<Scene()> make;
};

/// Both methods on one picture.
struct ExactRow {
    std::string scene;
    ExactSeries series = ExactSeries::scenes;
    std::size_t triangles = 0, lights = 0;
    PictureSize picture;
    int samples = 1, threads = 1;
    std::size_t covered = 0;  ///< samples that see a surface
    ExactFindings ours, rays;
    std::vector<double> order_ms, lookup_ms, hierarchy_ms, packets_ms;
    std::string problem;
    double ours_ms() const;  ///< order and lookups, medians; 0 when not measured
    double rays_ms() const;  ///< hierarchy and packets
    double ratio() const;    ///< rays over ours: above 1 ours is faster; 0 without
};

/// Error and time of one way to make the shadows of a picture.
struct ErrorTimeRow {
    std::string scene, method;
    std::size_t triangles = 0;
    int size = 0;  ///< texels a side; 0: auto, or no map
    int found = 0;
    double build_s = 0, lookup_s = 0;  ///< of all pixels; with all threads
    std::size_t wrong = 0, covered = 0;
};

/// Scenes of the renderer's own that are in folder "scenes", those of shadow_recipes(), a town seen in
/// pictures of growing size, and towns of growing size.
std::vector<ExactSubject> exact_subjects(const BenchOptions& options);

/// Call before this process starts any thread.
std::vector<ExactRow> measure_exact(const ExactSubject& subject, const BenchOptions& options);

/// Dense maps, trees at "auto" and at most_map_resolution, exact shadows and Embree's rays. Only with Embree.
std::vector<ErrorTimeRow> measure_error_times(const ShadowRecipe& recipe, const ShadowBenchPlan& plan,
                                              const BenchOptions& options);

std::string exact_csv(const std::vector<ExactRow>& rows);
std::string error_time_csv(const std::vector<ErrorTimeRow>& rows);
std::string exact_markdown(const std::vector<ExactRow>& rows, const std::vector<ErrorTimeRow>& errors);

/// Writes shadows_exact.csv, shadows_error_time.csv, shadows_exact.md, and shadows_exact_samples.svg,
/// shadows_exact_triangles.svg, shadows_error_time.svg with gnuplot. Throws OutputError.
void write_exact_report(const std::vector<ExactRow>& rows, const std::vector<ErrorTimeRow>& errors,
                        const BenchOptions& options);

/// The whole part. Returns an exit code. Throws UsageError when options.scene is in no subject's name.
int bench_exact(const BenchOptions& options);

}  // namespace obscura
