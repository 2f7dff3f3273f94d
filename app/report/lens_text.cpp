#include "app/report/lens_text.h"

#include <fmt/format.h>

#include "app/glare/glare_margin.h"
#include "app/glare/lens.h"
#include "core/count_text.h"
#include "core/stopwatch.h"
#include "optics/aperture_dirt.h"

namespace obscura {
namespace {

constexpr double mean_wavelength_m = 550e-9;

std::string duration(double ms) {
    return ms < 1000 ? fmt::format("{:.2g} ms", ms) : duration_text(1e-3 * ms);
}

std::string aperture_text(const OpticsSettings& o) {
    const char* dirt = has_dirt(o.dirt) ? ", not clean" : "";
    if (o.from_file) return fmt::format("mask of {} x {} texels{}", o.mask.width, o.mask.height, dirt);
    const char* name = aperture_kind_name(o.shape.kind);
    if (o.shape.kind == ApertureKind::iris || o.shape.kind == ApertureKind::whirl)
        return fmt::format("{} of {} blades{}", name, o.shape.blades, dirt);
    return fmt::format("{}{}", name, dirt);
}

}  // namespace

std::string lens_text(const OpticsSettings& o, const RenderSettings& render, int margin_px) {
    if (!o.enabled) return "";
    const PsfParams params = psf_params(o, render);
    const double cycles = params.pixel_m / (mean_wavelength_m * params.f_number);
    std::string out = fmt::format(
        "optics    {}, {:.4g} mm at f/{:.4g} (pupil {:.4g} mm), sensor {:.4g} x {:.4g} mm, pixels of {:.4g} "
        "um\n",
        aperture_text(o), o.focal_length_mm, o.f_number, 1e3 * pupil_m(o),
        o.sensor_height_mm * render.width / render.height, o.sensor_height_mm, 1e6 * params.pixel_m);
    const int side = kernel_side(o);
    out += fmt::format(
        "glare     above {:.4g} after exposure: {} x {} pixels, {:.4g} cycles of the pupil a pixel "
        "(550 nm), {} light\n",
        o.clip, side, side, cycles, light_source_name(o.light.source));
    const PsfPlan plan = plan_far_field_psf(lens_aperture(o), params);
    out += fmt::format(
        "          its pattern: {} at {:.4g} million frequencies, {} wavelengths, about {} on one thread\n",
        far_field_method_name(plan.method), 1e-6 * static_cast<double>(plan.frequencies), plan.wavelengths,
        duration(plan.cost_ms));
    const RenderSettings wide = widened(render, margin_px);
    if (margin_px > 0) {
        out += fmt::format("          light from {} around the picture: {} x {} are rendered\n",
                           count_text(margin_px, "pixel"), wide.width, wide.height);
    }
    const GlareCost cost = most_glare(wide.width, wide.height, side, glare_params(o, render));
    return out + fmt::format(
                     "          at most {:.4g} ms and {:.4g} MiB to spread it (one thread, every pixel "
                     "bright); nothing when none is\n",
                     cost.ms, mib(cost.bytes));
}

}  // namespace obscura
