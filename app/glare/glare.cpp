#include "app/glare/glare.h"

#include <algorithm>

#include "app/glare/glare_margin.h"
#include "app/glare/glare_memory.h"
#include "app/glare/lens.h"
#include "app/glare/source_kernels.h"
#include "core/parallel.h"
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

void prepare_psf(const Scene& scene, const GlareCall& call, const Exec& exec, std::optional<KeptPsf>& kept,
                 GlareStats& stats) {
    const OpticsSettings lens = of_the_kernel(scene.optics);
    const double pixel = pixel_m(scene.optics, scene.render);
    stats.kept = kept && kept->lens == lens && kept->pixel_m == pixel;
    if (stats.kept) return;
    const Stopwatch watch;
    const Psf psf = far_field_psf(lens_aperture(scene.optics), psf_params(scene.optics, scene.render), exec,
                                  [&](double share) {
                                      if (stopped(call.cancel)) throw Cancelled{};
                                      if (call.progress) call.progress(share);
                                  });
    kept = KeptPsf{
        lens, pixel, unit_kernel(psf.kernel), psf.plan.cycles_per_px, psf.captured, psf.plan.wavelengths};
    stats.psf_s = watch.seconds();
}

}  // namespace

std::optional<GlareStats> add_glare(const Scene& scene, const GlareCall& call, const Exec& exec,
                                    std::optional<KeptPsf>& kept, const LitPicture& picture) {
    const Stopwatch watch;
    GlareStats stats;
    const GlareParams params = glare_params(scene.optics, scene.render);
    stats.margin_px = -picture.x0;
    dim_margin(stats.margin_px, picture.radiance);
    const std::int64_t bright = count_bright(picture.radiance, params.clip);
    if (bright == 0) {
        // Without a kernel: none is needed to find that there is nothing to do.
        const Image<Vec3f> point(1, 1);
        GlareReport report;
        spread_glare(picture.radiance, {{&point, 1}, {}}, params, exec, &report);
        stats.reason = report.reason;
        stats.total_s = watch.seconds();
        return stats;
    }
    if (call.check_bright) call.check_bright(bright);
    try {
        prepare_psf(scene, call, exec, kept, stats);
    } catch (const Cancelled&) {
        return std::nullopt;
    }
    GlareReport report;
    if (wants_source_kernels(scene.optics)) {
        const Stopwatch own;
        SourceKernels own_kernels;
        if (call.free_bytes)
            own_kernels.most = static_cast<std::size_t>(kernels_that_fit(scene, call.free_bytes()));
        own_kernels.kernels.push_back(kept->kernel);
        add_source_kernels(scene, picture, params.clip, lens_aperture(scene.optics), exec, own_kernels);
        stats.psf_s += own.seconds();
        stats.kernels = static_cast<int>(own_kernels.kernels.size());
        stats.own_kernel_sources = own_kernels.hidden_sources;
        spread_glare(picture.radiance, {own_kernels.kernels, own_kernels.choice.view()}, params, exec,
                     &report);
    } else {
        stats.kernels = 1;
        spread_glare(picture.radiance, {{&kept->kernel, 1}, {}}, params, exec, &report);
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
    return stats;
}

}  // namespace obscura
