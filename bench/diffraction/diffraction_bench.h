#pragma once
// `obscura bench diffraction`: far and near fields of apertures by every strategy, beside FFTW.

#include <string>
#include <vector>

#include "bench/diffraction/results.h"
#include "bench/harness/options.h"

namespace obscura {

/// What a run measures.
struct DiffractionBenchPlan {
    std::vector<int> sizes;         ///< N of the far field and of the tables
    std::vector<int> window_sizes;  ///< N of the zoomed windows
    int window_px = 512;            ///< side of a window
    std::vector<int> near_sizes;    ///< M of the near field
    std::vector<int> padded_sizes;  ///< M at which FFTW convolves with 8-fold padding, too
    int control_size = 512;         ///< M of the sampled chirp
    int quality_size = 1024;        ///< N of SSIM and PSNR
    int most_samples = 256;         ///< per axis, of a true field too large to compute whole
    int most_near_samples = 512;    ///< the same for near fields
    int whole_size = 1024;          ///< largest N whose true far field is computed whole
    double longest_ms = 500;        ///< methods expected to take longer are left out
    TimingPlan timing;
};
DiffractionBenchPlan diffraction_bench_plan(bool quick, int rounds);

/// The whole bench: measures, writes diffraction*.csv, diffraction.md and, with gnuplot, charts into
/// options.out. options.scene chooses apertures. Returns an exit code. Throws OutputError.
int bench_diffraction(const BenchOptions& options);

// Its parts.

/// The half plane of N x (N / 2 + 1) frequencies, steps of 1 / (N / 2).
std::vector<DiffractionRow> measure_far(const DiffractionBenchPlan& plan, const BenchOptions& options);

/// Windows of window_px^2 frequencies at a quarter of that step, off the centre.
std::vector<DiffractionRow> measure_windows(const DiffractionBenchPlan& plan, const BenchOptions& options);

/// The plane of the mask's size at Fresnel number 10.
std::vector<DiffractionRow> measure_near(const DiffractionBenchPlan& plan, const BenchOptions& options);

/// Errors at Fresnel numbers 1, 10 and 50. Nothing without FFTW.
std::vector<ControlRow> measure_controls(const DiffractionBenchPlan& plan, const BenchOptions& options);

std::vector<QuadRow> measure_quads(const DiffractionBenchPlan& plan);
std::vector<CullRow> measure_culling(const DiffractionBenchPlan& plan);
std::vector<SpectralRow> measure_spectra(const DiffractionBenchPlan& plan);
std::vector<QualityRow> measure_quality(const DiffractionBenchPlan& plan, const BenchOptions& options);

/// The aperture names that options ask for.
std::vector<std::string> chosen_apertures(const BenchOptions& options);

}  // namespace obscura
