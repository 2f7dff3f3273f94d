// Sources are taken out of the picture first, kernel by kernel, in row order; then each kernel's sources are
// convolved channel by channel over their bounding box and added back. Every pixel is written by one thread,
// sums are added row by row, so no bit depends on threads.

#include "optics/glare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel.h"
#include "filters/convolution.h"
#include "optics/glare_bloom.h"
#include "optics/psf_memory.h"

namespace obscura {
namespace {

constexpr float Vec3f::*channels[] = {&Vec3f::x, &Vec3f::y, &Vec3f::z};

struct Source {
    int x = 0, y = 0;
    Vec3f light;
};

/// Bounding box [x0, x1) x [y0, y1).
struct Box {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
};

/// Share of a pixel's light that glares: a smooth step from 0 at the clip level to 1 at twice as much.
float glaring_share(float largest, double clip) {
    const double t = std::clamp((static_cast<double>(largest) - clip) / clip, 0.0, 1.0);
    return static_cast<float>(t * t * (3 - 2 * t));
}

/// Moves what glares of the pixels above the clip level out of the picture, one list per kernel. Negative
/// channels are no light and stay.
std::vector<std::vector<Source>> take_sources(ImageView<Vec3f> picture, const GlareKernels& kernels,
                                              double clip) {
    std::vector<std::vector<Source>> sources(kernels.kernels.size());
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            Vec3f& p = picture(x, y);
            const float largest = std::max({p.x, p.y, p.z});
            const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
            if (!finite || !(static_cast<double>(largest) > clip)) continue;
            const std::size_t k = kernels.choice.data == nullptr ? 0 : kernels.choice(x, y);
            CHECK(k < sources.size(), "a pixel chose a kernel that is not there");
            // What has a kernel of its own (a lamp partly hidden or out of focus) passes through that as a
            // whole.
            const float share = k == 0 ? glaring_share(largest, clip) : 1.0f;
            const Vec3f light = Vec3f{std::max(p.x, 0.0f), std::max(p.y, 0.0f), std::max(p.z, 0.0f)} * share;
            sources[k].push_back({x, y, light});
            p = p - light;
        }
    }
    return sources;
}

Box box_of(const std::vector<Source>& sources) {
    Box box{sources.front().x, sources.front().y, sources.front().x + 1, sources.front().y + 1};
    for (const Source& s : sources) {
        box = {std::min(box.x0, s.x), std::min(box.y0, s.y), std::max(box.x1, s.x + 1),
               std::max(box.y1, s.y + 1)};
    }
    return box;
}

Image<float> plane_of(ImageView<const Vec3f> image, float Vec3f::*channel) {
    Image<float> plane(image.width, image.height);
    for (int y = 0; y < image.height; ++y) {
        std::transform(image.row(y), image.row(y) + image.width, plane.row(y),
                       [=](const Vec3f& p) { return p.*channel; });
    }
    return plane;
}

/// One channel of the sources, in units of a power of two: 1, but for light so bright that the sums of
/// transforms would overflow.
struct Light {
    Box box;
    Image<float> plane;
    double unit = 1;
};

Light light_of(const std::vector<Source>& sources, const Box& box, float Vec3f::*channel) {
    Light light{box, Image<float>(box.width(), box.height()), 1};
    float most = 0;
    for (const Source& s : sources)
        most = std::max(most, s.light.*channel);
    if (most > 0x1p64f) light.unit = std::ldexp(1.0, std::ilogb(most));
    const auto scale = static_cast<float>(1 / light.unit);
    for (const Source& s : sources)
        light.plane(s.x - box.x0, s.y - box.y0) = s.light.*channel * scale;
    return light;
}

double sum_of(const std::vector<float>& values) {
    double sum = 0;
    for (const float v : values)
        sum += static_cast<double>(v);
    return sum;
}

/// Light: all of it, what stayed in the pixels it came from, what fell outside, what kernels do not pass on.
struct Balance {
    double light = 0, stayed = 0, lost = 0, blocked = 0;
};

/// Light is never negative, though rounding of transforms may leave it a little below 0: no pixel gets
/// darker than it was or than 0. The largest number is the brightest that there is.
float brightened(float before, double light) {
    const double after = static_cast<double>(before) + light;
    if (!std::isfinite(before)) return before;
    constexpr float most = std::numeric_limits<float>::max();
    return std::max(static_cast<float>(std::min(after, static_cast<double>(most))), std::min(before, 0.0f));
}

/// Adds value(x, y) units to every pixel of a rectangle of the picture. Returns the sum of what was added.
template <class Value>
double add_light(ImageView<Vec3f> picture, const Box& box, double unit, float Vec3f::*channel,
                 const Exec& exec, Value&& value) {
    const int x0 = std::max(box.x0, 0), x1 = std::min(box.x1, picture.width);
    const int y0 = std::max(box.y0, 0), y1 = std::min(box.y1, picture.height);
    if (x0 >= x1 || y0 >= y1) return 0;
    std::vector<double> row_sums(static_cast<std::size_t>(y1 - y0), 0.0);
    parallel_blocks(row_sums.size(), 16, exec, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const int y = y0 + static_cast<int>(i);
            Vec3f* row = picture.row(y);
            for (int x = x0; x < x1; ++x) {
                const double v = unit * static_cast<double>(value(x, y));
                row[x].*channel = brightened(row[x].*channel, v);
                row_sums[i] += v;
            }
        }
    });
    double sum = 0;
    for (const double s : row_sums)
        sum += s;
    return sum;
}

Image<float> convolve(const Image<float>& source, const Image<float>& kernel, bool fft, const Exec& exec) {
    return fft ? convolve_fft(source.view(), kernel.view(), exec)
               : convolve_splats(source.view(), kernel.view(), exec);
}

/// What is left of the sources' light outside the picture.
double add_full(ImageView<Vec3f> picture, const Light& source, const Image<float>& kernel, bool fft,
                float Vec3f::*channel, const Exec& exec) {
    const Image<float> light = convolve(source.plane, kernel, fft, exec);
    const int x0 = source.box.x0 - kernel.width / 2, y0 = source.box.y0 - kernel.height / 2;
    const Box reach{x0, y0, x0 + light.width, y0 + light.height};
    const double inside = add_light(picture, reach, source.unit, channel, exec,
                                    [&](int x, int y) { return light(x - x0, y - y0); });
    return source.unit * sum_of(light.pixels) - inside;
}

/// The same, on a grid `scale` times as coarse.
double add_coarse(ImageView<Vec3f> picture, const Light& source, const Image<float>& kernel, int scale,
                  float Vec3f::*channel, const Exec& exec) {
    const Box& box = source.box;
    const Image<float> coarse = coarsened(source.plane.view(), scale);
    const auto bright =
        std::count_if(coarse.pixels.begin(), coarse.pixels.end(), [](float v) { return v != 0; });
    const bool fft = plan_convolution(bright, coarse.width, coarse.height, kernel.width, kernel.height).fft;
    const Image<float> light = convolve(coarse, kernel, fft, exec);
    const CoarsePlane plane{light.view(), 1 + kernel.width / 2, scale};
    const int reach = (kernel.width / 2 + 1) * scale;
    const Box around{box.x0 - reach, box.y0 - reach, box.x1 + reach, box.y1 + reach};
    const double inside = add_light(picture, around, source.unit, channel, exec, [&](int x, int y) {
        return static_cast<float>(plane.at(x - box.x0, y - box.y0));
    });
    return source.unit * sum_of(light.pixels) - inside;
}

/// Spreads the sources of one kernel.
Balance spread(ImageView<Vec3f> picture, const std::vector<Source>& sources, const Image<Vec3f>& kernel,
               bool fft, int scale, const Exec& exec) {
    const Box box = box_of(sources);
    Balance total;
    for (float Vec3f::*const channel : channels) {
        const Light source = light_of(sources, box, channel);
        const double light = source.unit * sum_of(source.plane.pixels);
        if (light == 0) continue;
        const Image<float> taps = plane_of(kernel.view(), channel);
        const double centre = static_cast<double>(taps(taps.width / 2, taps.height / 2));
        total.light += light;
        total.stayed += light * centre;
        total.blocked += light * (1 - sum_of(taps.pixels));
        if (scale == 1) {
            total.lost += add_full(picture, source, taps, fft, channel, exec);
            continue;
        }
        const SplitKernel split = split_kernel(taps.view(), scale);
        total.lost += add_full(picture, source, split.core, false, channel, exec);
        total.lost += add_coarse(picture, source, split.outskirts, scale, channel, exec);
    }
    return total;
}

std::string reason_text(std::int64_t sources, std::size_t kernels, const ConvolutionPlan& plan, int side,
                        const GlareParams& params) {
    std::string text = fmt::format("{} pixel{} above {:.4g} spread{} by ", sources, sources == 1 ? "" : "s",
                                   params.clip, sources == 1 ? "s" : "");
    text += kernels == 1 ? "one kernel" : fmt::format("{} kernels", kernels);
    text += fmt::format(" of {} x {}: ", side, side);
    if (params.bloom_scale > 1) return text + fmt::format("at 1/{} of the resolution", params.bloom_scale);
    return text + (plan.fft
                       ? fmt::format("FFT (about {:.3g} ms; splats {:.3g} ms)", plan.fft_ms, plan.splat_ms)
                       : fmt::format("splats (about {:.3g} ms; FFT {:.3g} ms)", plan.splat_ms, plan.fft_ms));
}

}  // namespace

void spread_glare(ImageView<Vec3f> radiance, const GlareKernels& kernels, const GlareParams& params,
                  const Exec& exec, GlareReport* report) {
    CHECK(!kernels.kernels.empty(), "glare needs a kernel");
    const int s = params.bloom_scale;
    CHECK(s == 1 || s == 2 || s == 4 || s == 8, fmt::format("bloom_scale={}", s));
    for (const Image<Vec3f>& k : kernels.kernels)
        CHECK(k.width % 2 == 1 && k.width == k.height, fmt::format("kernel of {} x {}", k.width, k.height));
    GlareReport told;
    told.reason = fmt::format("no pixel is above {:.4g}: nothing is computed", params.clip);
    const auto sources = take_sources(radiance, kernels, params.clip);
    Balance total;
    ConvolutionPlan sum_of_plans;
    std::size_t used = 0;
    for (std::size_t k = 0; k < sources.size(); ++k) {
        if (sources[k].empty()) continue;
        const Image<Vec3f>& kernel = kernels.kernels[k];
        const Box box = box_of(sources[k]);
        const auto count = static_cast<std::int64_t>(sources[k].size());
        const ConvolutionPlan plan =
            plan_convolution(count, box.width(), box.height(), kernel.width, kernel.height);
        const Balance balance = spread(radiance, sources[k], kernel, plan.fft, s, exec);
        total.light += balance.light;
        total.stayed += balance.stayed;
        total.lost += balance.lost;
        total.blocked += balance.blocked;
        told.sources += count;
        told.fft = told.fft || plan.fft;
        told.cost_ms += 3 * (plan.fft ? plan.fft_ms : plan.splat_ms);
        sum_of_plans.fft = told.fft;
        sum_of_plans.fft_ms += 3 * plan.fft_ms;
        sum_of_plans.splat_ms += 3 * plan.splat_ms;
        ++used;
    }
    if (told.sources > 0) {
        told.reason = reason_text(told.sources, used, sum_of_plans, kernels.kernels[0].width, params);
    }
    if (total.light > 0) {
        told.lost = std::max(total.lost / total.light, 0.0);  // rounding may tip it
        const double blocked = total.blocked / total.light;
        told.blocked = blocked > 1e-5 ? blocked : 0;  // less is the rounding of taps
        told.spread = 1 - told.blocked - total.stayed / total.light;
    }
    if (report != nullptr) *report = told;
}

Image<Vec3f> add_glare(ImageView<const Vec3f> radiance, const Image<Vec3f>& kernel, const GlareParams& params,
                       const Exec& exec, GlareReport* report) {
    Image<Vec3f> picture(radiance.width, radiance.height);
    for (int y = 0; y < radiance.height; ++y)
        std::copy_n(radiance.row(y), radiance.width, picture.row(y));
    spread_glare(picture.view(), {{&kernel, 1}, {}}, params, exec, report);
    return picture;
}

GlareCost most_glare(int width, int height, int kernel_side, const GlareParams& params) {
    const int s = params.bloom_scale;
    const int w = s == 1 ? width : width / s + 3, h = s == 1 ? height : height / s + 3;
    const int side = s == 1 ? kernel_side : 2 * (kernel_side / 2 / s + 1) + 1;
    const std::int64_t pixels = std::int64_t{width} * height;
    const ConvolutionPlan plan = plan_convolution(std::int64_t{w} * h, w, h, side, side);
    // Lists of sources (which may grow to twice their size), one channel of them, and the result.
    const std::int64_t result = std::int64_t{w + side - 1} * (h + side - 1) * std::int64_t{sizeof(float)};
    const std::int64_t lists = pixels * std::int64_t{2 * sizeof(Source) + sizeof(float)};
    const std::int64_t taps = std::int64_t{kernel_side} * kernel_side * std::int64_t{3 * sizeof(float)};
    return {3 * std::min(plan.fft_ms, plan.splat_ms), lists + result + taps + plan.fft_bytes};
}

std::int64_t spread_glare_bytes(std::int64_t sources, int width, int height, int kernel_side,
                                const GlareParams& params) {
    if (sources == 0) return 0;
    // Lists may grow to twice their size; then one channel of a kernel's sources and of the kernel at a time.
    const std::int64_t lists = sources * std::int64_t{2 * sizeof(Source)};
    const int s = params.bloom_scale;
    const int w = s == 1 ? width : width / s + 3, h = s == 1 ? height : height / s + 3;
    const int side = s == 1 ? kernel_side : 2 * (kernel_side / 2 / s + 1) + 1;
    const std::int64_t planes =
        (std::int64_t{width} * height + (s == 1 ? 0 : std::int64_t{w} * h)) * std::int64_t{sizeof(float)};
    const std::int64_t taps =
        std::int64_t{kernel_side} * kernel_side * std::int64_t{sizeof(float)} * (s == 1 ? 1 : 2);
    const ConvolutionPlan plan = plan_convolution(sources, w, h, side, side);
    const std::int64_t result = std::int64_t{w + side - 1} * (h + side - 1) * std::int64_t{sizeof(float)};
    return lists + planes + taps + (plan.fft ? plan.fft_bytes : result);
}

Image<Vec3f> unit_kernel(const Image<Vec3f>& kernel) {
    Vec3d sums;
    for (const Vec3f& p : kernel.pixels)
        sums = sums + to_double(p);
    const double all = sums.x + sums.y + sums.z;
    CHECK(all > 0, "the kernel is dark");
    Image<Vec3f> unit = kernel;
    for (Vec3f& p : unit.pixels) {
        const Vec3d from = to_double(p);
        const double shape = (from.x + from.y + from.z) / all;
        p = to_float(Vec3d{sums.x > 1e-3 * all ? from.x / sums.x : shape,
                           sums.y > 1e-3 * all ? from.y / sums.y : shape,
                           sums.z > 1e-3 * all ? from.z / sums.z : shape});
    }
    return unit;
}

}  // namespace obscura
