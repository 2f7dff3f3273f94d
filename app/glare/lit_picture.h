#pragma once
// A picture whose bright pixels glare, as glare sees it, and what it took.

#include <cstdint>
#include <string>

#include "core/image.h"
#include "core/vec.h"

namespace obscura {

constexpr std::uint32_t no_object = 0xffffffffu;

/// The whole picture with its margin, equal on opposite sides. What pixels show (of their first samples) is
/// asked only where kernels differ (wants_source_kernels()); else it may be empty.
struct LitPicture {
    int x0 = 0, y0 = 0;                     ///< its corner in the picture without the margin
    ImageView<Vec3f> radiance;              ///< linear, W / (m^2 sr)
    ImageView<const float> depth_m;         ///< metres along the view axis; infinity where nothing is
    ImageView<const std::uint32_t> object;  ///< index into Mesh::objects; no_object where nothing is
    /// How many pixels further right the scene's camera sees what this picture does; empty: 0 everywhere.
    ImageView<const float> shift_px;
    Vec3d lens_offset_m;  ///< where the picture's lens is, from the camera's eye

    int width() const { return radiance.width; }
    int height() const { return radiance.height; }
    double shift_at(int x, int y) const {
        return shift_px.width > 0 ? static_cast<double>(shift_px(x, y)) : 0.0;
    }
};

/// Glare of a picture whose scene has a lens.
struct GlareStats {
    double total_s = 0;                   ///< all of it, the next included
    double psf_s = 0;                     ///< the lens's patterns; 0 when kept
    bool kept = false;                    ///< patterns of an earlier frame served
    bool fft = false;                     ///< else splats
    int margin_px = 0;                    ///< rendered on every side for its light, and cropped
    std::int64_t sources = 0;             ///< pixels that clipped, the margin's too
    int kernels = 0;                      ///< patterns: of the open lens, and of sources with their own
    std::int64_t own_kernel_sources = 0;  ///< pixels that see the lens partly hidden, or are out of focus
    int wavelengths = 0;
    double cycles_per_px = 0;     ///< cycles of the pupil's diameter, at the mean wavelength
    double captured = 0;          ///< share of the light that the kernel's square catches
    double spread = 0, lost = 0;  ///< shares of the sources' light: left its pixel, left the margin, too
    double blocked = 0;           ///< share that what stands before the lens keeps from it
    std::string reason;
};

}  // namespace obscura
