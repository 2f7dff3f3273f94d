#include "app/frame/glare.h"

#include <algorithm>

#include "app/frame/glare_margin.h"
#include "app/frame/glare_memory.h"
#include "app/frame/lens.h"
#include "app/frame/source_kernels.h"
#include "core/stopwatch.h"

namespace obscura {
namespace {

/// The settings that the kernel depends on.
OpticsSettings of_the_kernel(OpticsSettings optics) {
    const OpticsSettings d;
    optics.clip = d.clip;
    optics.bloom_scale = d.bloom_scale;
    optics.margin_px = d.margin_px;
    optics.visibility = d.visibility;
    optics.visibility_samples = d.visibility_samples;
    optics.neighbourhood_px = d.neighbourhood_px;
    optics.focus_m = d.focus_m;
    optics.focus_steps = d.focus_steps;
    optics.sensor_height_mm = d.sensor_height_mm;  // the size of a pixel says what matters of it
    return optics;
}

std::int64_t count_bright(ImageView<const Vec3f> radiance, double clip) {
    std::int64_t bright = 0;
    for (int y = 0; y < radiance.height; ++y) {
        const Vec3f* row = radiance.row(y);
        bright += std::count_if(row, row + radiance.width, [=](const Vec3f& p) {
            return static_cast<double>(std::max({p.x, p.y, p.z})) > clip;
        });
    }
    return bright;
}

struct Cancelled {};

void prepare_psf(const Scene& scene, const FrameOptions& options, const Exec& exec,
                 std::optional<KeptPsf>& kept, GlareStats& stats) {
    const OpticsSettings lens = of_the_kernel(scene.optics);
    const double pixel = pixel_m(scene.optics, scene.render);
    stats.kept = kept && kept->lens == lens && kept->pixel_m == pixel;
    if (stats.kept) return;
    const Stopwatch watch;
    const Psf psf = far_field_psf(lens_aperture(scene.optics), psf_params(scene.optics, scene.render), exec,
                                  [&](double share) {
                                      if (options.cancel && options.cancel->load(std::memory_order_relaxed))
                                          throw Cancelled{};
                                      if (options.progress) options.progress(share);
                                  });
    kept = KeptPsf{
        lens, pixel, unit_kernel(psf.kernel), psf.plan.cycles_per_px, psf.captured, psf.plan.wavelengths};
    stats.psf_s = watch.seconds();
}

template <class Pixels>
void crop_channel(const Region& crop, Pixels& channel) {
    if (channel.width == 0) return;
    Pixels part(crop.width, crop.height);
    const auto from = std::as_const(channel).view().crop(crop.x0, crop.y0, crop.width, crop.height);
    const auto to = part.view();
    for (int y = 0; y < crop.height; ++y)
        std::copy_n(from.row(y), crop.width, to.row(y));
    channel = std::move(part);
}

}  // namespace

void add_frame_glare(const Scene& scene, const FrameOptions& options, const Exec& exec,
                     std::optional<KeptPsf>& kept, Frame& frame) {
    if (!scene.optics.enabled) return;
    const Stopwatch watch;
    GlareStats& stats = frame.stats.glare.emplace();
    const GlareParams params = glare_params(scene.optics, scene.render);
    stats.margin_px = -frame.x0;
    dim_margin(stats.margin_px, frame.radiance.view());
    const std::int64_t bright = count_bright(frame.radiance.view(), params.clip);
    if (bright == 0) {
        // Without a kernel: none is needed to find that there is nothing to do.
        const Image<Vec3f> point(1, 1);
        GlareReport report;
        spread_glare(frame.radiance.view(), {{&point, 1}, {}}, params, exec, &report);
        stats.reason = report.reason;
        stats.total_s = watch.seconds();
        return;
    }
    check_bright_pixels(scene, bright);
    try {
        prepare_psf(scene, options, exec, kept, stats);
    } catch (const Cancelled&) {
        frame.complete = false;
        return;
    }
    GlareReport report;
    if (wants_source_kernels(scene.optics)) {
        const Stopwatch own;
        const SourceKernels own_kernels =
            source_kernels(scene, frame, params.clip, lens_aperture(scene.optics), kept->kernel, exec);
        stats.psf_s += own.seconds();
        stats.kernels = static_cast<int>(own_kernels.kernels.size());
        stats.own_kernel_sources = own_kernels.hidden_sources;
        spread_glare(frame.radiance.view(), {own_kernels.kernels, own_kernels.choice.view()}, params, exec,
                     &report);
    } else {
        stats.kernels = 1;
        spread_glare(frame.radiance.view(), {{&kept->kernel, 1}, {}}, params, exec, &report);
    }
    stats.sources = report.sources;
    stats.fft = report.fft;
    stats.spread = report.spread;
    stats.lost = report.lost;
    stats.blocked = report.blocked;
    stats.reason = report.reason;
    stats.wavelengths = kept->wavelengths;
    stats.cycles_per_px = kept->cycles_per_px;
    stats.captured = kept->captured;
    stats.total_s = watch.seconds();
}

void crop_frame(const Region& crop, Frame& frame) {
    if (crop.width == frame.width && crop.height == frame.height) return;
    const Region part{crop.x0 - frame.x0, crop.y0 - frame.y0, crop.width, crop.height};
    crop_channel(part, frame.radiance);
    crop_channel(part, frame.depth_m);
    crop_channel(part, frame.normal);
    crop_channel(part, frame.albedo);
    crop_channel(part, frame.object);
    crop_channel(part, frame.shift_px);
    crop_channel(part, frame.shadow);
    frame.x0 = crop.x0;
    frame.y0 = crop.y0;
    frame.width = crop.width;
    frame.height = crop.height;
}

}  // namespace obscura
