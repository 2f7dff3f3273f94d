#pragma once
// The lens of a scene, as far as it diffracts.

#include "core/image.h"
#include "optics/aperture_shapes.h"
#include "optics/lens_dirt.h"
#include "optics/spectrum.h"

namespace obscura {

/// How the aperture that light samples see is found: `open`: the lens's own, for all; `exact`: less what the
/// scene hides of it from the light; `neighbours`: less the pixels around the source that do not glare.
enum class PupilVisibility { open, exact, neighbours };

/// As many pixels as the lens and what is bright need (app/glare/glare_margin.h).
constexpr int auto_glare_margin = -1;

/// The camera's lens as far as it diffracts. A pinhole's picture is taken; what this adds is glare.
struct OpticsSettings {
    bool enabled = false;
    /// Fills the mask, whose side is the pupil's diameter.
    ApertureShape shape{.diameter = 1};
    bool from_file = false;  ///< the aperture is `mask` instead
    Image<float> mask;       ///< empty unless from_file
    int mask_px = 512;       ///< side of the shape's mask
    LensDirt dirt;
    // The lens. The camera's angle of view decides the size of the sensor.
    double focal_length_mm = 50, f_number = 8, sensor_height_mm = 24;
    double clip = 1;                    ///< exposed radiance above which a pixel glares
    LightSpectrum light;                ///< how its wavelengths are spread; colours stay the scene's
    int wavelengths = 0;                ///< 0: chosen from radius and tolerance
    double tolerance = 0.01;            ///< of colours
    int radius_px = 256;                ///< of the kernel
    int margin_px = auto_glare_margin;  ///< that the picture is rendered wider on every side; >= 0
    int bloom_scale = 1;
    PupilVisibility visibility = PupilVisibility::open;
    int visibility_samples = 8;  ///< kernels per lamp, most
    int neighbourhood_px = 4;    ///< neighbours: how far the pupil reaches around a source
    double focus_m = 0;          ///< bright points out of focus show their near field; 0: all is sharp
    int focus_steps = 8;         ///< depths that have kernels of their own, most
    friend bool operator==(const OpticsSettings&, const OpticsSettings&) = default;
};

}  // namespace obscura
