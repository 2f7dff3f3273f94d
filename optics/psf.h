#pragma once
// The picture that a sensor takes of a point of light: the coloured far field of the lens's aperture, at its
// true size in pixels.

#include <cstdint>
#include <functional>

#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"
#include "optics/far_field.h"
#include "optics/field/aperture.h"
#include "optics/spectrum.h"

namespace obscura {

/// How far_field_colour() adds wavelengths up (thesis, equations 3.16 and 3.17).
enum class SpectralMethod {
    exact,   ///< every wavelength's pattern is computed on its own grid
    lookup,  ///< "full60", the paper's full mode: one pattern, looked up at 60 scales
    batch,   ///< "batch4", the paper's batch mode: 4 scales gathered first, then 15 lookups of four
};
const char* spectral_method_name(SpectralMethod method);

struct PsfParams {
    double focal_length_m = 0.05;
    double f_number = 8;
    double pixel_m = 18.75e-6;
    int radius_px = 256;  ///< the kernel has 2 radius + 1 pixels a side, [0, 4096]
    LightSpectrum light;
    int wavelengths = 0;      ///< 0: chosen from radius and tolerance
    double tolerance = 0.01;  ///< relative error of the colours that this choice aims at, in [1e-4, 0.5]
    SpectralMethod method = SpectralMethod::exact;  ///< far_field_colour() only
};

/// What far_field_psf() would do.
struct PsfPlan {
    int wavelengths = 0;
    double cycles_per_px = 0;  ///< of the diameter, at 550 nm: pixel / (lambda f-number)
    /// Highest frequency at the kernel's edge, of the shortest wavelength. A mask says little of its aperture
    /// beyond 0.25 (steps of its edges begin to show as false streaks along its axes) and nothing beyond 0.5;
    /// the kernel fades out from 0.3 to 0.5 (of blue, 440 nm) instead of showing the pattern of texels. Where
    /// the outline is known, it is exact in closed form (method polygon: no limit), or a mask as fine as
    /// needed, up to 4096 texels, is made of it, and this is about that one.
    double highest_cycles_per_texel = 0;
    FarFieldMethod method = FarFieldMethod::automatic;  ///< what computes the far field
    std::int64_t frequencies = 0;                       ///< at which it is computed
    double cost_ms = 0;                                 ///< estimate for one thread
};

/// Rows top to bottom as on the picture: the image is inverted in both axes, as lenses do (which cannot be
/// seen: the pattern of any real mask is its own reflection through the centre).
struct Psf {
    /// Linear sRGB, no channel negative, side 2 radius + 1, the point at the centre; sums to the light's
    /// colour of luminance 1 (white for D65), so spreading light by it keeps its energy.
    Image<Vec3f> kernel;
    /// Share of the luminance through the aperture that the kernel's square catches; the rest falls farther
    /// out and is counted in by scaling.
    double captured = 0;
    PsfPlan plan;
};

/// An outline, where there is one, must be that of the mask. The mask spans the entrance pupil's diameter,
/// focal_length / f_number, with its width. A pixel gathers the light on its whole square, of all wavelengths
/// (see optics/pixel_integrals.h). Throws InputError for parameters out of range, LimitError for far too many
/// frequencies, InputError for an aperture that lets nothing through.
/// `progress` hears in this thread, many times when there is much to do, which share is done; what it throws
/// ends the work.
Psf far_field_psf(const Aperture& aperture, const PsfParams& params, const Exec& exec,
                  const std::function<void(double)>& progress = {});

/// The same without computing it; throws as it does. Of an outline that wants a finer mask, that is made.
PsfPlan plan_far_field_psf(const Aperture& aperture, const PsfParams& params);

/// The coloured far field alone: pixel (x, y) shows frequency grid(x, y) at reference_nm, all wavelengths
/// added (equation 3.16). Linear sRGB, luminance 1 at frequency 0; single colours may lie outside the gamut
/// and have negative channels (see into_gamut()). Throws as above. `progress` hears in this thread, after
/// every wavelength of SpectralMethod::exact, which share is done.
Image<Vec3f> far_field_colour(const Aperture& aperture, const FrequencyGrid& grid, double reference_nm,
                              const PsfParams& params, const Exec& exec,
                              const std::function<void(double)>& progress = {});

/// What that would do; throws as it does.
struct ColourPlan {
    int wavelengths = 0;
    /// Plan of the wavelength in the middle, or of the one pattern that is looked up.
    FarFieldReport pattern;
    double cost_ms = 0;  ///< exact: of all, as if they were all like that, estimate for one thread; else 0
    /// Frequencies of that one pattern, held while it is, with its scaled copies.
    std::int64_t looked_up = 0;
};
ColourPlan plan_far_field_colour(const Aperture& aperture, const FrequencyGrid& grid, double reference_nm,
                                 const PsfParams& params);

}  // namespace obscura
