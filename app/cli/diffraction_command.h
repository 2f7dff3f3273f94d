#pragma once
// obscura diffraction: the pattern that light makes behind an aperture, on its own.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/command.h"
#include "app/report/output_plan.h"
#include "core/file_output.h"
#include "core/isa.h"
#include "optics/aperture_shapes.h"
#include "optics/far_field.h"
#include "optics/field/field.h"
#include "optics/lens_dirt.h"
#include "optics/near_field.h"
#include "optics/near_field_colour.h"
#include "optics/pattern_view.h"
#include "optics/psf.h"
#include "optics/spectrum.h"

namespace obscura {

/// A pattern before it is written: power for one wavelength, else colours; amplitudes when asked for.
struct DiffractionPattern {
    Image<float> power;
    Image<Vec3f> colour;
    Field amplitude;
};

struct DiffractionOptions {
    std::string aperture;             ///< as given
    std::filesystem::path mask_file;  ///< empty: the shape
    ApertureShape shape;
    int mask_px = 1024;  ///< side of a shape's mask
    /// Of a shape, which takes 0.9 of its mask; of what a file leaves open.
    std::optional<double> diameter_m;
    std::optional<double> pitch_m;  ///< of a texel; neither: 5 mm
    LensDirt dirt;
    int finest_level = 0;  ///< masks are reduced by 2^level first, to 0 and 1

    std::optional<double> near_m;  ///< distance; none: far field
    std::optional<LightSpectrum> spectrum;
    double wavelength_nm = 550;
    int wavelengths = 0;  ///< of a spectrum; 0: the program chooses
    SpectralMethod far_colour = SpectralMethod::exact;
    NearFieldColour near_colour = NearFieldColour::exact;

    int size_px = 1024;
    double zoom = 0;  ///< 0: far, 56 to 112 fringes on either side; near, 1
    Vec2d centre;     ///< far: cycles per longer side of the mask; near: such sides
    FarFieldParams far;
    NearFieldMethod near_method = NearFieldMethod::automatic;

    PatternView view;
    bool amplitude = false;  ///< also NAME.re.pfm and NAME.im.pfm beside the first file
    std::vector<std::string> outputs;
    Existing existing = Existing::refuse;
    bool plan_only = false;
    std::filesystem::path stats_json;  ///< empty: none; "-": standard output, and words go to standard error
    std::int64_t memory_mib = 4096;
    Exec exec;
};

/// Prints the plan, computes, writes. PNG: the view; PFM: power relative to the far field's centre (that of
/// the whole opening), or to the unobstructed wave (near field); of a spectrum linear sRGB.
int diffraction_command(const DiffractionOptions& options);

/// The command line of it.
int run_diffraction(const Arguments& arguments);

}  // namespace obscura
