#pragma once
// `obscura bench stereo`: our solvers of disparity systems beside sparse solvers of others.

#include <vector>

#include "bench/harness/options.h"
#include "bench/stereo/results.h"
#include "bench/stereo/scenes.h"
#include "bench/stereo/truth.h"

namespace obscura {

struct StereoSize {
    int width = 0, height = 0;
};

/// What a run measures.
struct StereoBenchPlan {
    std::vector<StereoSize> sizes;       ///< of the base case, by every method
    std::vector<StereoSize> case_sizes;  ///< of every case, by multigrid
    int rounds = 7;                      ///< turns of each of our jobs, the least time counts
    double budget_ms = 1000;             ///< a job that has spent this rests, after two turns
    int curve_iterations = 12;           ///< of error against time
    int case_iterations = 20;            ///< tried at most in search of the goal
    std::vector<int> cascade_sweeps = {1, 2, 5, 10, 20, 50, 100};
    double longest_cg_ms = 150e3;      ///< Eigen's CG is stopped then, goal or not
    double longest_cg_ic_ms = 45e3;    ///< the same with incomplete Cholesky
    int largest_ldlt = 480 * 270;      ///< unknowns that Eigen's factorisation is asked for
    int largest_repeated = 960 * 540;  ///< unknowns up to which CHOLMOD runs three times
};
StereoBenchPlan stereo_bench_plan(bool quick, int rounds);

/// The whole bench: measures, writes stereo*.csv, stereo.md and, with gnuplot, stereo.svg into options.out.
/// options.scene chooses the cases beside the base. Returns an exit code. Throws OutputError.
int bench_stereo(const BenchOptions& options);

// Its parts.

/// The base system of one size, and what it is measured against.
struct StereoSubject {
    StereoSize size;
    DisparitySystem system;
    StereoMatrix matrix;
    StereoTruth truth;
};
StereoSubject stereo_subject(StereoCase stereo_case, StereoSize size);

/// Ours by every method, and passes over memory between them.
void measure_methods(const StereoSubject& subject, const StereoBenchPlan& plan, const BenchOptions& options,
                     StereoResults& results);

/// Direct and iterative solvers of others, one thread.
std::vector<StereoRow> measure_peers(const StereoSubject& subject, const StereoBenchPlan& plan,
                                     const BenchOptions& options);

/// Every case that options choose at every case size.
void measure_cases(const StereoBenchPlan& plan, const BenchOptions& options, StereoResults& results);

/// Solves at 1:2, 1:4 and 1:8.
std::vector<PreviewRow> measure_previews(const StereoSubject& subject, const StereoBenchPlan& plan,
                                         const BenchOptions& options);

}  // namespace obscura
