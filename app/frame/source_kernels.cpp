// Sources are put into few classes whose patterns are computed. Hidden lenses: every source's own visible
// pupil is rasterized at low resolution and classed by how much of it is hidden and where the hidden part
// lies; a class takes the pattern of its most typical source, at the mask's full resolution. Out of focus:
// classes are steps of vergence.

#include "app/frame/source_kernels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "app/frame/lens.h"
#include "app/frame/visible_pupil.h"
#include "core/error.h"
#include "core/parallel.h"
#include "optics/aperture_extent.h"
#include "optics/near_field_colour.h"
#include "raster/camera_rays.h"

namespace obscura {
namespace {

constexpr int survey_texels = 32;  // of the visible pupils that sources are classed by
constexpr int defocus_wavelengths = 24;

/// A pixel that clips and the point of its lamp that it shows.
struct LampPixel {
    int x = 0, y = 0;
    Vec3d point;
};

// A list that grows is there twice, and half of it may be empty.
static_assert(3 * sizeof(LampPixel) + 2 * sizeof(double) * 3 <= bytes_per_lamp_pixel);

bool clips(const Frame& frame, int x, int y, double clip) {
    const Vec3f p = frame.radiance.view()(x, y);
    return static_cast<double>(std::max({p.x, p.y, p.z})) > clip;
}

/// Objects with a material whose own light clips.
std::vector<bool> lamps_of(const Scene& scene, double clip) {
    std::vector<bool> lamps(scene.mesh.objects.size(), false);
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
        const Vec3f e = scene.materials[scene.mesh.material[t]].emission;
        if (static_cast<double>(std::max({e.x, e.y, e.z})) > clip) lamps[scene.mesh.object[t]] = true;
    }
    return lamps;
}

/// The nearest pixel, at most one away, whose first sample shows a lamp; itself first.
bool lamp_near(const Frame& frame, const std::vector<bool>& lamps, int& x, int& y) {
    const auto shows = [&](int i, int j) {
        if (i < 0 || j < 0 || i >= frame.width || j >= frame.height) return false;
        const std::uint32_t object = frame.object(i, j);
        return object != no_object && lamps[object];
    };
    constexpr int near[9][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    for (const auto& step : near) {
        if (!shows(x + step[0], y + step[1])) continue;
        x += step[0];
        y += step[1];
        return true;
    }
    return false;
}

/// Pixels that clip, lamp by lamp.
std::map<std::uint32_t, std::vector<LampPixel>> lamp_pixels(const Scene& scene, const Frame& frame,
                                                            double clip) {
    std::map<std::uint32_t, std::vector<LampPixel>> found;
    const std::vector<bool> lamps = lamps_of(scene, clip);
    const CameraRays rays = camera_rays(scene.camera, frame.width, frame.height);
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            int i = x, j = y;
            if (!clips(frame, x, y, clip) || !lamp_near(frame, lamps, i, j)) continue;
            // The lamp's depth in the pixel's own direction.
            const double z = static_cast<double>(frame.depth_m(i, j)), X = x + 0.5 + frame.shift_at(i, j),
                         Y = y + 0.5;
            const auto along = [&](int k) {
                return rays.eye[k] + z * (rays.dir0[k] + X * rays.dir_x[k] + Y * rays.dir_y[k]);
            };
            found[frame.object(i, j)].push_back({x, y, {along(0), along(1), along(2)}});
        }
    }
    return found;
}

/// The cheap form (3.4.4): the square of pixels around the source stands for the pupil; what does not clip
/// there hides it.
Image<std::uint8_t> neighbour_pupil(const Frame& frame, const LampPixel& pixel, int radius_px, double clip,
                                    int size) {
    Image<std::uint8_t> open(size, size, 1);
    for (int row = 0; row < size; ++row) {
        for (int column = 0; column < size; ++column) {
            const auto offset = [&](int i) {
                return static_cast<int>(std::floor(((i + 0.5) / size - 0.5) * (2 * radius_px + 1) + 0.5));
            };
            const int x = pixel.x + offset(column), y = pixel.y + offset(row);
            const bool inside = x >= 0 && y >= 0 && x < frame.width && y < frame.height;
            if (inside && !clips(frame, x, y, clip)) open(column, row) = 0;
        }
    }
    return open;
}

/// What of the open aperture stays: its share, and the way the rest lies from the middle (pupil sides).
struct Visible {
    double share = 1, x = 0, y = 0;
};

Visible summary(const Image<std::uint8_t>& open, const Image<float>& coarse) {
    double all = 0, left = 0, x = 0, y = 0;
    for (int row = 0; row < open.height; ++row) {
        for (int column = 0; column < open.width; ++column) {
            const auto light = static_cast<double>(coarse(column, row));
            all += light;
            if (open(column, row) != 0) {
                left += light;
                x += light * ((column + 0.5) / open.width - 0.5);
                y += light * ((row + 0.5) / open.height - 0.5);
            }
        }
    }
    return left > 0 ? Visible{left / all, x / left, y / left} : Visible{0, 0, 0};
}

using ClassKey = std::tuple<int, int, int>;

ClassKey key_of(const Visible& v, double steps) {
    const auto step = [&](double value, double scale) {
        return static_cast<int>(std::floor(value * scale * steps + 0.5));
    };
    return {step(v.share, 1), step(v.x, 2), step(v.y, 2)};
}

/// The aperture averaged onto the survey's texels.
Image<float> survey_of(const Image<float>& mask) {
    Image<float> coarse(survey_texels, survey_texels), count(survey_texels, survey_texels);
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            const int i = x * survey_texels / mask.width, j = y * survey_texels / mask.height;
            coarse(i, j) += mask(x, y);
            count(i, j) += 1;
        }
    }
    for (std::size_t i = 0; i < coarse.pixels.size(); ++i)
        coarse.pixels[i] = count.pixels[i] > 0 ? coarse.pixels[i] / count.pixels[i] : 0.0f;
    return coarse;
}

/// Sources of one lamp by class, at most `most` of them; sources that see all of the lens, or nothing of it
/// (what the picture shows beside the centre ray), are left out.
std::map<ClassKey, std::vector<std::size_t>> classes_of(const std::vector<Visible>& seen, int most) {
    for (double steps = 12;; steps *= 0.7) {
        std::map<ClassKey, std::vector<std::size_t>> classes;
        for (std::size_t i = 0; i < seen.size(); ++i) {
            if (seen[i].share > 0 && seen[i].share < 1 - 1e-6) classes[key_of(seen[i], steps)].push_back(i);
        }
        if (classes.size() <= static_cast<std::size_t>(most)) return classes;
    }
}

/// The member nearest to the class's mean.
std::size_t typical(const std::vector<std::size_t>& members, const std::vector<Visible>& seen) {
    Visible mean{0, 0, 0};
    const double share = 1.0 / static_cast<double>(members.size());
    for (const std::size_t i : members)
        mean = {mean.share + share * seen[i].share, mean.x + share * seen[i].x, mean.y + share * seen[i].y};
    std::size_t best = members.front();
    double least = 1e300;
    for (const std::size_t i : members) {
        const double d = (seen[i].share - mean.share) * (seen[i].share - mean.share) +
                         (seen[i].x - mean.x) * (seen[i].x - mean.x) +
                         (seen[i].y - mean.y) * (seen[i].y - mean.y);
        if (d < least) {
            least = d;
            best = i;
        }
    }
    return best;
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
    HiddenLamps(const Scene& scene, const Frame& frame, double clip, const Aperture& aperture,
                const Exec& exec)
        : scene_(scene),
          frame_(frame),
          clip_(clip),
          aperture_(aperture),
          exec_(exec),
          pupil_(pupil_plane(scene.camera, pupil_m(scene.optics), frame.lens_offset_m)),
          survey_(survey_of(aperture.mask)) {}

    void add(const std::vector<LampPixel>& pixels, SourceKernels& to) const {
        const std::vector<std::uint32_t> near = candidates(pixels);
        std::vector<Visible> seen(pixels.size());
        parallel_blocks(pixels.size(), 16, exec_, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                seen[i] = summary(visible(pixels[i], near, survey_texels), survey_);
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
        return neighbour_pupil(frame_, pixel, scene_.optics.neighbourhood_px, clip_, size);
    }

    const Scene& scene_;
    const Frame& frame_;
    double clip_;
    const Aperture& aperture_;
    const Exec& exec_;
    PupilPlane pupil_;
    Image<float> survey_;
};

/// Radius in pixels of the disc that a point shows at this vergence.
double blur_px(const OpticsSettings& optics, const RenderSettings& render, double vergence_per_m) {
    const double radians_per_px = pixel_m(optics, render) / (1e-3 * optics.focal_length_mm);
    return 0.5 * pupil_m(optics) * std::fabs(vergence_per_m) / radians_per_px;
}

/// Sources by steps of vergence; those that are blurred by less than half a pixel stay with the lens in
/// focus.
void add_defocus(const Scene& scene, const Frame& frame, double clip, const Aperture& aperture,
                 const Exec& exec, SourceKernels& to) {
    const OpticsSettings& o = scene.optics;
    const auto vergence = [&](int x, int y) {
        const auto z = static_cast<double>(frame.depth_m(x, y));
        return (std::isfinite(z) ? 1 / z : 0.0) - 1 / o.focus_m;
    };
    double low = 1e300, high = -1e300;
    const auto blurred = [&](int x, int y) {
        return clips(frame, x, y, clip) && blur_px(o, scene.render, vergence(x, y)) >= 0.5;
    };
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            if (!blurred(x, y)) continue;
            low = std::min(low, vergence(x, y));
            high = std::max(high, vergence(x, y));
        }
    }
    if (low > high) return;
    const auto steps = static_cast<double>(o.focus_steps);
    std::map<int, std::pair<double, std::int64_t>> sums;
    const auto step_of = [&](double v) {
        return high > low
                   ? static_cast<int>(std::min(std::floor((v - low) / (high - low) * steps), steps - 1))
                   : 0;
    };
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            if (!blurred(x, y)) continue;
            auto& [sum, count] = sums[step_of(vergence(x, y))];
            sum += vergence(x, y);
            ++count;
        }
    }
    std::map<int, std::uint16_t> kernel_of;
    for (const auto& [step, sum] : sums) {
        const double mean = sum.first / static_cast<double>(sum.second);
        if (blur_px(o, scene.render, mean) < 0.5) continue;
        kernel_of[step] = add_kernel(defocus_kernel(aperture, o, scene.render, mean, exec), to);
    }
    for (int y = 0; y < frame.height; ++y) {
        for (int x = 0; x < frame.width; ++x) {
            if (!blurred(x, y)) continue;
            const auto found = kernel_of.find(step_of(vergence(x, y)));
            if (found == kernel_of.end()) continue;
            to.choice(x, y) = found->second;
            ++to.hidden_sources;
        }
    }
}

}  // namespace

std::uint16_t add_kernel(Image<Vec3f> kernel, SourceKernels& to) {
    if (to.kernels.size() >= most_kernels)
        throw LimitError(
            fmt::format("lamps that are partly hidden need more than {} patterns; fewer "
                        "optics.visibility_samples need less",
                        most_kernels));
    to.kernels.push_back(std::move(kernel));
    return static_cast<std::uint16_t>(to.kernels.size() - 1);
}

std::int64_t lamp_count(const Scene& scene) {
    if (!scene.optics.enabled) return 0;
    const std::vector<bool> lamps = lamps_of(scene, glare_params(scene.optics, scene.render).clip);
    return std::count(lamps.begin(), lamps.end(), true);
}

bool wants_source_kernels(const OpticsSettings& optics) {
    return optics.enabled && (optics.visibility != PupilVisibility::open || optics.focus_m > 0);
}

SourceKernels source_kernels(const Scene& scene, const Frame& frame, double clip, const Aperture& aperture,
                             const Image<Vec3f>& open, const Exec& exec) {
    SourceKernels result;
    result.kernels.push_back(open);
    result.choice = Image<std::uint16_t>(frame.width, frame.height);
    if (scene.optics.focus_m > 0) add_defocus(scene, frame, clip, aperture, exec, result);
    if (scene.optics.visibility == PupilVisibility::open) return result;
    const HiddenLamps hidden(scene, frame, clip, aperture, exec);
    for (const auto& [object, pixels] : lamp_pixels(scene, frame, clip))
        hidden.add(pixels, result);
    return result;
}

Image<Vec3f> defocus_kernel(const Aperture& aperture, const OpticsSettings& optics,
                            const RenderSettings& render, double vergence_per_m, const Exec& exec) {
    // A wave front of curvature 1 / d, seen through a lens focused on 1 / f, is a plane one at the distance
    // z = 1 / (1 / d - 1 / f) behind the same opening; a pixel at the angle a shows its point z a.
    const double z = 1 / std::fabs(vergence_per_m);
    const double metres_per_px = pixel_m(optics, render) / (1e-3 * optics.focal_length_mm) * z;
    const int side = kernel_side(optics);
    constexpr int finer = 3;  // samples along a pixel's side
    PlaneGrid plane;
    plane.width = plane.height = finer * side;
    plane.step = metres_per_px / (aperture.pitch_m * finer);
    plane.first_x = plane.first_y = -0.5 * (finer * side - 1) * plane.step;
    NearFieldParams params;
    params.distance_m = z;
    const PsfParams psf = psf_params(optics, render);
    const int count = optics.wavelengths > 0 ? optics.wavelengths : defocus_wavelengths;
    const Image<Vec3f> light =
        near_field_colour(aperture, plane, params, psf.light, count, NearFieldColour::exact, exec);
    Image<Vec3f> kernel(side, side);
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            Vec3d sum;
            for (int j = 0; j < finer; ++j) {
                for (int i = 0; i < finer; ++i)
                    sum = sum + into_gamut(to_double(light(finer * x + i, finer * y + j)));
            }
            // Points nearer than the focus have not crossed over yet: their picture is upside down.
            const bool turned = vergence_per_m > 0;
            kernel(turned ? side - 1 - x : x, turned ? side - 1 - y : y) = to_float(sum);
        }
    }
    return unit_kernel(kernel);
}

}  // namespace obscura
