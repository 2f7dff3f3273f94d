#pragma once
// What a run of the diffraction bench found, as plain rows; reports and charts read nothing else.

#include <cstdint>
#include <string>
#include <vector>

#include "bench/harness/interleave.h"

namespace obscura {

inline constexpr const char* fftw_image_name = "FFTW, image";    ///< F1: of the N^2 anti-aliased image
inline constexpr const char* fftw_mask_name = "FFTW, mask";      ///< F2: of the mask, our function
inline constexpr const char* fftw_padded_name = "FFTW, padded";  ///< of the mask, 4 times padded
inline constexpr const char* fftw_near_name = "FFTW, 2x padded";
inline constexpr const char* fftw_near8_name = "FFTW, 8x padded";
inline constexpr const char* automatic_name = "automatic";

inline constexpr const char* far_part = "far";
inline constexpr const char* window_part = "window";
inline constexpr const char* near_part = "near";

/// One method on one aperture.
struct DiffractionRow {
    std::string part;  ///< one of the above
    std::string aperture;
    bool convex = false;
    int size = 0;  ///< far, window: N, the image's side; the mask's is N / 2. near: M, side of mask and plane
    std::string method;
    int threads = 1;
    bool peer = false;
    bool same_function = true;  ///< false: the image's or the outline's transform, not the mask's
    bool one_call = false;  ///< far_field_into() as it is, which makes its tables in every call; otherwise
                            ///< what depends on sizes alone is kept, as FFTW keeps its plans
    double prepare_ms = 0;  ///< making what is kept, once
    Timing time;            ///< no calls: not timed, see problem
    /// Largest amplitude error, share of the open area (near: of the unit wave); -1 unknown.
    double error = -1;
    double log_psnr_db = -1;
    std::string note;     ///< automatic: what it chose
    std::string problem;  ///< why it was not measured
};

/// The sampled chirp, which needs far more padding than the integrated one, at one Fresnel number.
struct ControlRow {
    double fresnel_number = 0;
    int size = 0;
    double integrated_error = -1, sampled_error = -1;  ///< largest, of the unit wave
    double our_error = -1;
};

/// Number of quads at the finest and at the next coarser level (thesis, Table 3.1).
struct QuadRow {
    std::string aperture;
    int size = 0;
    std::int64_t finest = 0, aggressive = 0;
};

/// Culling and symmetry (Table 3.2): heptagon, whole plane, method edges.
struct CullRow {
    int size = 0;
    double plain_ms = 0, cull_ms = 0, symmetry_ms = 0, both_ms = 0;
    double active = 0;  ///< share of the blocks that culling keeps
};

/// The thesis's two ways to add up wavelengths (Table 3.3), from a given pattern.
struct SpectralRow {
    int size = 0;
    double full_ms = 0, batch_ms = 0;
};

/// A coarser mask against the image's own pattern (Figures 3.8 and 3.9).
struct QualityRow {
    std::string field;  ///< "far" or "near"
    std::string aperture;
    int size = 0;
    std::string level;  ///< "finest", "aggressive"
    double ssim = 0, psnr_db = 0;
    std::int64_t quads = 0;
};

struct DiffractionResults {
    std::vector<DiffractionRow> rows;
    std::vector<ControlRow> controls;
    std::vector<QuadRow> quads;
    std::vector<CullRow> culling;
    std::vector<SpectralRow> spectra;
    std::vector<QualityRow> quality;
};

}  // namespace obscura
