#pragma once
// The picture that a sensor takes of a point of light: the coloured far field of the lens's aperture, at its
// true size in pixels.

#include "core/image.h"
#include "core/isa.h"
#include "core/vec.h"
#include "optics/aperture.h"
#include "optics/far_field.h"
#include "optics/spectrum.h"

namespace obscura {

/// How wavelengths are added up (thesis, equations 3.16 and 3.17).
enum class SpectralMethod {
    exact,   ///< every wavelength's pattern is computed on its own grid
    lookup,  ///< the paper's full mode: one pattern, looked up at 60 scales
    batch,   ///< the paper's batch mode: 4 scales gathered first, then 15 lookups of four
};

struct PsfParams {
    double focal_length_m = 0.05;
    double f_number = 8;
    double pixel_m = 18.75e-6;
    int radius_px = 256;  ///< the kernel has 2 radius + 1 pixels a side
    LightSpectrum light;
    int wavelengths = 0;      ///< 0: chosen from radius and tolerance
    double tolerance = 0.01;  ///< relative error of the colours that this choice aims at
    SpectralMethod method = SpectralMethod::exact;
};

/// Rows top to bottom as on the picture: the image is inverted in both axes, as lenses do.
struct Psf {
    /// Linear sRGB, side 2 radius + 1, the point at the centre; sums to the light's colour of luminance 1
    /// (white for D65), so spreading light by it keeps its energy.
    Image<Vec3f> kernel;
    /// Share of the light through the aperture that the kernel's square catches; the rest falls farther out
    /// and is counted in by scaling.
    double captured = 0;
    int wavelengths = 0;
    double cycles_per_px = 0;  ///< step of the grid at the mean wavelength, in cycles per aperture diameter
};

/// The aperture's mask spans the entrance pupil's diameter, focal_length / f_number, with its width.
Psf far_field_psf(const Aperture& aperture, const PsfParams& params, const Exec& exec);

/// The coloured far field alone: pixel (x, y) shows frequency grid(x, y) at reference_nm, all wavelengths
/// added (equation 3.16). Linear sRGB, luminance 1 at the centre of the pattern.
Image<Vec3f> far_field_colour(const Aperture& aperture, const FrequencyGrid& grid, double reference_nm,
                              const PsfParams& params, const Exec& exec);

}  // namespace obscura
