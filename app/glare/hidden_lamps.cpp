#include "app/glare/hidden_lamps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/glare/lamp_pixels.h"
#include "app/glare/lens.h"
#include "app/glare/pupil_classes.h"
#include "app/glare/visible_pupil.h"
#include "core/parallel.h"
#include "optics/aperture_extent.h"

namespace obscura {
namespace {

// A list that grows is there twice, and half of it may be empty.
static_assert(3 * sizeof(LampPixel) + 2 * sizeof(SeenShare) <= bytes_per_lamp_pixel);

/// The cheap form (3.4.4): the square of pixels around the source stands for the pupil; what does not clip
/// there hides it.
Image<std::uint8_t> neighbour_pupil(const LitPicture& picture, const LampPixel& pixel, int radius_px,
                                    double clip, int size) {
    Image<std::uint8_t> open(size, size, 1);
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            const auto offset = [&](int i) {
                return static_cast<int>(std::floor(((i + 0.5) / size - 0.5) * (2 * radius_px + 1) + 0.5));
            };
            const int x = pixel.x + offset(column), y = pixel.y + offset(row);
            const bool inside = x >= 0 && y >= 0 && x < picture.width() && y < picture.height();
            if (inside && !clips(picture, x, y, clip)) open(column, row) = 0;
        }
    }
    return open;
}

/// The aperture less what the texels of `open` hide; only a mask is left of it.
Aperture hidden_aperture(const Aperture& aperture, const Image<std::uint8_t>& open) {
    Aperture part;
    part.pitch_m = aperture.pitch_m;
    part.mask = aperture.mask;
    for (int y = 0; y < part.mask.height; ++y) {
        for (int x = 0; x < part.mask.width; ++x) {
            if (open(x * open.width / part.mask.width, y * open.height / part.mask.height) == 0)
                part.mask(x, y) = 0;
        }
    }
    return part;
}

Image<Vec3f> dimmed(Image<Vec3f> kernel, double share) {
    for (Vec3f& p : kernel.pixels)
        p = p * static_cast<float>(share);
    return kernel;
}

class HiddenLamps {
  public:
    HiddenLamps(const Scene& scene, const LitPicture& picture, double clip, const Aperture& aperture,
                const Exec& exec)
        : scene_(scene),
          picture_(picture),
          clip_(clip),
          aperture_(aperture),
          exec_(exec),
          pupil_(pupil_plane(scene.camera, pupil_m(scene.optics), picture.lens_offset_m)),
          survey_(survey_of(aperture.mask)) {}

    void add(const std::vector<LampPixel>& pixels, SourceKernels& to) const {
        const std::vector<std::uint32_t> near = candidates(pixels);
        std::vector<SeenShare> seen(pixels.size());
        parallel_blocks(pixels.size(), 16, exec_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                seen[i] = seen_share(visible(pixels[i], near, survey_texels), survey_);
        });
        for (const auto& [key, members] : classes_of(seen, scene_.optics.visibility_samples)) {
            const LampPixel& sample = pixels[typical(members, seen)];
            const Aperture part = hidden_aperture(aperture_, visible(sample, near, aperture_.mask.width));
            if (!(open_area(part.mask.view()) > 0)) continue;
            const Psf psf = far_field_psf(part, psf_params(scene_.optics, scene_.render), exec_);
            const std::uint16_t kernel = add_kernel(dimmed(unit_kernel(psf.kernel), passed(part)), to);
            for (const std::size_t i : members)
                to.choice(pixels[i].x, pixels[i].y) = kernel;
            to.hidden_sources += static_cast<std::int64_t>(members.size());
        }
    }

  private:
    /// Share of the lens's light that the part gathers. What the picture says of a lamp's light is a
    /// pinhole's, all of it; what neighbours say of the lens is a guess of its shape, not of its light.
    double passed(const Aperture& part) const {
        if (scene_.optics.visibility != PupilVisibility::exact) return 1;
        return transmitted_power(part.mask.view()) / transmitted_power(aperture_.mask.view());
    }
    std::vector<std::uint32_t> candidates(const std::vector<LampPixel>& pixels) const {
        if (scene_.optics.visibility != PupilVisibility::exact) return {};
        Vec3d centre;
        for (const LampPixel& p : pixels)
            centre = centre + p.point * (1.0 / static_cast<double>(pixels.size()));
        double radius = 0;
        for (const LampPixel& p : pixels)
            radius = std::max(radius, length(p.point - centre));
        return between(scene_.mesh, pupil_, centre, radius);
    }
    Image<std::uint8_t> visible(const LampPixel& pixel, const std::vector<std::uint32_t>& near,
                                int size) const {
        if (scene_.optics.visibility == PupilVisibility::exact)
            return visible_pupil(scene_.mesh, near, pupil_, pixel.point, size);
        return neighbour_pupil(picture_, pixel, scene_.optics.neighbourhood_px, clip_, size);
    }

    const Scene& scene_;
    const LitPicture& picture_;
    double clip_;
    const Aperture& aperture_;
    const Exec& exec_;
    PupilPlane pupil_;
    Image<float> survey_;
};

}  // namespace

void add_hidden_lamps(const Scene& scene, const LitPicture& picture, double clip, const Aperture& aperture,
                      const Exec& exec, SourceKernels& to) {
    const HiddenLamps hidden(scene, picture, clip, aperture, exec);
    for (const auto& [object, pixels] : lamp_pixels(scene, picture, clip))
        hidden.add(pixels, to);
}

}  // namespace obscura
