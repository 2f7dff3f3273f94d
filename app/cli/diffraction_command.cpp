#include "app/cli/diffraction_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

#include "app/cli/diffraction_grid.h"
#include "app/cli/messages.h"
#include "app/cli/progress.h"
#include "app/cli/targets.h"
#include "app/report/run_stats.h"
#include "app/scene/aperture_file.h"
#include "core/error.h"
#include "core/image_io.h"
#include "core/num.h"
#include "core/stopwatch.h"
#include "optics/aperture_dirt.h"
#include "optics/aperture_extent.h"

namespace obscura {
namespace {

constexpr double reference_nm = 550;
constexpr double default_diameter_m = 0.005;
constexpr int near_wavelengths = 40;
constexpr double far_fresnel_number = 0.1;
constexpr std::int64_t bytes_per_texel = 4 * 6;

/// What is computed, over which grid, and how.
struct Job {
    Aperture aperture;
    double open = 0;  ///< texels
    FrequencyGrid far_grid;
    PlaneGrid plane;
    NearFieldParams near;
    FarFieldReport far_plan;
    NearFieldReport near_plan;
    double fresnel_number = 0;  ///< near field: the opening's
    int wavelengths = 1;
    double total_ms = 0;  ///< of all wavelengths, one thread; 0: not known
};

/// Bytes that a pattern holds at most: numbers, the largest of its intermediate pictures, codes of the files.
/// The methods' own tables are small beside them.
std::int64_t pattern_bytes(const DiffractionOptions& options, std::int64_t texels) {
    const std::int64_t pixels = std::int64_t{options.size_px} * options.size_px;
    const std::int64_t amplitudes = options.amplitude || options.near_m ? 2 * 4 : 0;
    const std::int64_t numbers = (options.spectrum ? 4 + 12 + 24 : 2 * 4) + amplitudes;
    return pixels * (numbers + 3 * 3 + 12) + texels * bytes_per_texel;
}

/// `looked_up`: numbers of the patterns that a spectrum's colours are looked up in.
void check_limits(const DiffractionOptions& options, std::int64_t texels, std::int64_t looked_up = 0) {
    const std::int64_t bytes = pattern_bytes(options, texels) + 4 * looked_up;
    if (bytes <= options.memory_mib << 20) return;
    throw LimitError(fmt::format(
        "a pattern of {0} x {0} pixels behind a mask of {1:.4g} million texels needs about {2:.0f} MiB, more "
        "than --limit-memory {3}",
        options.size_px, 1e-6 * static_cast<double>(texels), static_cast<double>(bytes) / (1 << 20),
        options.memory_mib));
}

Aperture mask_from_file(const DiffractionOptions& options) {
    ImageFileLimits limits;
    limits.max_bytes = (options.memory_mib << 20) / bytes_per_texel * std::int64_t{sizeof(Rgba8)};
    limits.advice = " (--limit-memory raises it)";
    Image<float> mask = read_mask(options.mask_file, options.aperture, limits);
    check_limits(options, std::int64_t{mask.width} * mask.height);
    ApertureScale scale{options.pitch_m, options.diameter_m};
    if (!scale.pitch_m && !scale.diameter_m) scale.diameter_m = default_diameter_m;
    return scaled_aperture(std::move(mask), scale);
}

/// What the aperture is made of came by flags here: a parameter out of its range is a wrong flag.
template <class Make>
auto from_flags(Make&& make) {
    try {
        return make();
    } catch (const InputError& error) {
        throw UsageError(error.what());
    }
}

Aperture mask_from_shape(const DiffractionOptions& options) {
    check_limits(options, std::int64_t{options.mask_px} * options.mask_px);
    Aperture aperture = from_flags([&] {
        return make_aperture(options.shape, options.mask_px, options.diameter_m.value_or(default_diameter_m));
    });
    if (options.pitch_m) aperture.pitch_m = *options.pitch_m;
    return aperture;
}

Aperture load_aperture(const DiffractionOptions& options) {
    Aperture aperture = options.mask_file.empty() ? mask_from_shape(options) : mask_from_file(options);
    from_flags([&] { add_dirt(options.dirt, aperture); });
    if (options.finest_level > 0) aperture = reduce(aperture, options.finest_level, true);
    if (!(open_area(aperture.mask.view()) > 0)) {
        throw InputError(options.aperture,
                         options.finest_level > 0
                             ? fmt::format("the aperture is closed at --finest-level {} ({} x {} texels)",
                                           options.finest_level, aperture.mask.width, aperture.mask.height)
                             : "the aperture is closed: no texel lets light through");
    }
    return aperture;
}

/// What the cheapest method takes, beside a choice that may take a thousand times as long.
void compare_with_cheapest(Job& job, const DiffractionOptions& options) {
    const auto note = [](std::string& reason, const char* cheapest, double ms) {
        reason += fmt::format("; the cheapest, {}, takes about {:.3g} ms on one thread", cheapest, ms);
    };
    if (options.near_m && options.near_method != NearFieldMethod::automatic) {
        NearFieldParams any = job.near;
        any.method = NearFieldMethod::automatic;
        const NearFieldReport plan = plan_near_field(job.aperture, job.plane, any);
        note(job.near_plan.reason, near_field_method_name(plan.method), plan.cost_ms);
    } else if (!options.near_m && options.far.method != FarFieldMethod::automatic) {
        FarFieldParams any = options.far;
        any.method = FarFieldMethod::automatic;
        const FarFieldReport plan = plan_far_field(job.aperture, job.far_grid, any);
        note(job.far_plan.reason, far_field_method_name(plan.method), plan.cost_ms);
    }
}

PsfParams colour_params(const DiffractionOptions& options) {
    PsfParams params;
    params.light = *options.spectrum;
    params.wavelengths = options.wavelengths;
    params.method = options.far_colour;
    return params;
}

int near_count(const DiffractionOptions& options) {
    return options.wavelengths > 0 ? options.wavelengths : near_wavelengths;
}

/// How many wavelengths there are, and what they take together.
void plan_colours(Job& job, const DiffractionOptions& options) {
    if (options.spectrum && !options.near_m) {
        const ColourPlan plan =
            plan_far_field_colour(job.aperture, job.far_grid, reference_nm, colour_params(options));
        job.far_plan = plan.pattern;
        job.wavelengths = plan.wavelengths;
        job.total_ms = plan.cost_ms;
        const Image<float>& mask = job.aperture.mask;
        check_limits(options, std::int64_t{mask.width} * mask.height, plan.looked_up);
        return;
    }
    if (options.spectrum)
        job.wavelengths = static_cast<int>(spectral_samples(*options.spectrum, near_count(options)).size());
    const int fields = options.near_colour == NearFieldColour::scaled ? 1 : job.wavelengths;
    job.total_ms = fields * (options.near_m ? job.near_plan.cost_ms : job.far_plan.cost_ms);
}

Job plan_job(const DiffractionOptions& options) {
    Job job;
    job.aperture = load_aperture(options);
    job.open = open_area(job.aperture.mask.view());
    check_served(options, job.aperture);
    if (options.near_m) {
        job.plane = near_grid(options, job.aperture);
        job.near.wavelength_m = 1e-9 * (options.spectrum ? reference_nm : options.wavelength_nm);
        job.near.distance_m = *options.near_m;
        job.near.method = options.near_method;
        job.near.cull = options.far.cull;
        job.near_plan = plan_near_field(job.aperture, job.plane, job.near);
        job.fresnel_number = opening_fresnel_number(job.aperture, job.near);
    } else {
        job.far_grid = far_grid(options, job.aperture);
        job.far_plan = plan_far_field(job.aperture, job.far_grid, options.far);
    }
    compare_with_cheapest(job, options);
    plan_colours(job, options);
    return job;
}

std::string aperture_text(const DiffractionOptions& options, const Job& job) {
    const Image<float>& mask = job.aperture.mask;
    return fmt::format("aperture  {}: {} x {} texels of {:.4g} um ({:.4g} mm wide), {:.1f} % open\n",
                       options.aperture, mask.width, mask.height, job.aperture.pitch_m * 1e6,
                       job.aperture.pitch_m * 1e3 * mask.width,
                       100 * job.open / (static_cast<double>(mask.width) * mask.height));
}

std::string pattern_text(const DiffractionOptions& options, const Job& job) {
    const double nm = options.spectrum ? reference_nm : options.wavelength_nm;
    std::string out;
    if (options.near_m) {
        out = fmt::format(
            "pattern   near field at {:.6g} mm, Fresnel number {:.4g} at {:.4g} nm; {} x {} pixels "
            "of {:.4g} um\n",
            *options.near_m * 1e3, job.fresnel_number, nm, options.size_px, options.size_px,
            job.plane.step * job.aperture.pitch_m * 1e6);
    } else {
        const double radians = job.far_grid.step_u * nm * 1e-9 / job.aperture.pitch_m;
        out = fmt::format(
            "pattern   far field, {} x {} pixels of {:.4g} cycles per side of the mask, that is "
            "{:.4g} arc seconds at {:.4g} nm\n",
            options.size_px, options.size_px, job.far_grid.step_u * longer_side(job.aperture),
            radians * (180 / num::pi) * 3600, nm);
    }
    const std::string method = options.near_m ? near_field_method_name(job.near_plan.method)
                                              : far_field_method_name(job.far_plan.method);
    const std::string& reason = options.near_m ? job.near_plan.reason : job.far_plan.reason;
    out += fmt::format("method    {}\n", reason.empty() ? method : reason);
    if (!options.spectrum) return out;
    out += fmt::format("light     {} wavelengths", job.wavelengths);
    if (options.far_colour != SpectralMethod::exact) out += ", looked up in one pattern";
    if (options.near_colour != NearFieldColour::exact) out += ", scaled from one";
    if (job.total_ms > 0) out += fmt::format(", together about {:.3g} s on one thread", 1e-3 * job.total_ms);
    return out + "\n";
}

/// Power of one wavelength, relative to the open wave's (near) or the whole opening's (far).
void scale_to(Image<float>& image, double factor) {
    const auto f = static_cast<float>(factor);
    for (float& v : image.pixels)
        v *= f;
}

Image<float> power_of(const Field& field) {
    Image<float> power(field.re.width, field.re.height);
    for (std::size_t i = 0; i < power.pixels.size(); ++i)
        power.pixels[i] = field.re.pixels[i] * field.re.pixels[i] + field.im.pixels[i] * field.im.pixels[i];
    return power;
}

using Hear = std::function<void(double)>;

DiffractionPattern far_pattern(const DiffractionOptions& options, Job& job, const Hear& progress) {
    DiffractionPattern pattern;
    const double unit = 1 / job.open;
    if (options.amplitude) {
        pattern.amplitude = far_field(job.aperture, job.far_grid, options.far, options.exec, &job.far_plan);
        scale_to(pattern.amplitude.re, unit);
        scale_to(pattern.amplitude.im, unit);
        pattern.power = power_of(pattern.amplitude);
    } else if (!options.spectrum) {
        pattern.power = far_field_power(job.aperture, job.far_grid, options.far, options.exec, &job.far_plan);
        scale_to(pattern.power, unit * unit);
    }
    if (options.spectrum) {
        pattern.colour = far_field_colour(job.aperture, job.far_grid, reference_nm, colour_params(options),
                                          options.exec, progress);
    }
    return pattern;
}

DiffractionPattern near_pattern(const DiffractionOptions& options, Job& job, const Hear& progress) {
    DiffractionPattern pattern;
    if (options.amplitude) {
        pattern.amplitude = near_field(job.aperture, job.plane, job.near, options.exec, &job.near_plan);
        pattern.power = power_of(pattern.amplitude);
    } else if (!options.spectrum) {
        pattern.power = near_field_intensity(job.aperture, job.plane, job.near, options.exec, &job.near_plan);
    }
    // Every wavelength of the light has its own near field; their colours add up.
    if (options.spectrum) {
        pattern.colour = near_field_colour(job.aperture, job.plane, job.near, *options.spectrum,
                                           near_count(options), options.near_colour, options.exec, progress);
    }
    return pattern;
}

/// Tells how far colours are that take long enough to ask.
DiffractionPattern pattern_with_progress(const DiffractionOptions& options, Job& job) {
    constexpr double worth_telling_ms = 2000;
    Progress meter(stderr, Progress::style_for(
                               stderr, job.wavelengths == 1 ||
                                           job.total_ms < worth_telling_ms * thread_count(options.exec)));
    meter.begin(fmt::format("{} wavelengths", job.wavelengths), 0, 1);
    const Hear progress = [&](double share) { meter.update(share); };
    DiffractionPattern pattern =
        options.near_m ? near_pattern(options, job, progress) : far_pattern(options, job, progress);
    meter.finish();
    return pattern;
}

/// "a/b.png" and "re": "a/b.re.pfm".
std::filesystem::path part_path(const std::string& file, const char* part) {
    const std::filesystem::path p(file);
    return p.parent_path() / fmt::format("{}.{}.pfm", p.stem().string(), part);
}

void check_files(const DiffractionOptions& options) {
    std::vector<std::filesystem::path> files;
    for (const std::string& file : options.outputs) {
        file_kind(file);
        files.emplace_back(file);
    }
    if (options.amplitude) {
        for (const char* part : {"re", "im"})
            files.push_back(part_path(options.outputs.front(), part));
    }
    ReadFiles read;
    if (!options.mask_file.empty()) read.add(options.mask_file);
    check_targets(files, options.stats_json, options.existing, read);
}

/// Words about the run: on standard output, unless statistics go there.
void tell(const DiffractionOptions& options, const std::string& text) {
    is_standard_output(options.stats_json) ? say(text) : print(text);
}

void write_pattern(const DiffractionOptions& options, const DiffractionPattern& pattern) {
    const bool grey = pattern.colour.pixels.empty();
    for (const std::string& file : options.outputs) {
        std::string bytes;
        if (file_kind(file) == FileKind::png) {
            const Image<Rgb8> picture = grey ? view_power(pattern.power.view(), options.view, options.exec)
                                             : view_colour(pattern.colour.view(), options.view, options.exec);
            bytes = encode_png(picture.view());
        } else {
            bytes = grey ? encode_pfm(pattern.power.view()) : encode_pfm(pattern.colour.view());
        }
        write_file_atomically(file, bytes, options.existing);
        tell(options, file + "\n");
    }
    if (!options.amplitude) return;
    const Field& field = pattern.amplitude;
    for (const auto& [part, image] : {std::pair{"re", &field.re}, std::pair{"im", &field.im}}) {
        const std::filesystem::path file = part_path(options.outputs.front(), part);
        write_file_atomically(file, encode_pfm(image->view()), options.existing);
        tell(options, file.string() + "\n");
    }
}

std::string stats_text(const DiffractionOptions& options, const Job& job, double seconds) {
    JsonWriter json;
    json.begin_object().member("schema", 1).member("aperture", options.aperture);
    json.member("mask_width", job.aperture.mask.width).member("mask_height", job.aperture.mask.height);
    json.member("pitch_m", job.aperture.pitch_m).member("open_texels", job.open);
    json.member("size_px", options.size_px);
    put_execution(json, options.exec);
    const bool near = options.near_m.has_value();
    json.member("field", near ? "near" : "far");
    json.member("method", near ? near_field_method_name(job.near_plan.method)
                               : far_field_method_name(job.far_plan.method));
    json.member("reason", near ? job.near_plan.reason : job.far_plan.reason);
    json.member("wavelengths", job.wavelengths).member("planned_total_ms", job.total_ms);
    json.member("planned_ms", near ? job.near_plan.cost_ms : job.far_plan.cost_ms);
    json.member("quads", near ? job.near_plan.quads : job.far_plan.quads);
    json.member("edges", near ? job.near_plan.edges : job.far_plan.edges);
    if (near) {
        json.member("fresnel_number", job.fresnel_number);
    } else {
        json.member("active_blocks", job.far_plan.active_blocks).member("blocks", job.far_plan.blocks);
    }
    json.member("seconds", seconds);
    return json.end_object().finish();
}

}  // namespace

int diffraction_command(const DiffractionOptions& options) {
    if (options.amplitude && options.spectrum)
        throw UsageError("--amplitude is of one wavelength: give --wavelength-nm, not --spectrum");
    if (options.spectrum && !options.near_m &&
        (options.far.method != FarFieldMethod::automatic || options.far.cull > 0))
        throw UsageError(
            "--method and --cull are of one wavelength or of --near: give --wavelength-nm, not --spectrum");
    if (options.plan_only && is_standard_output(options.stats_json))
        throw UsageError("--stats-json -: --plan prints to standard output and has no statistics");
    if (!options.plan_only) check_files(options);
    Job job = plan_job(options);
    tell(options, aperture_text(options, job) + pattern_text(options, job));
    if (options.near_m && job.fresnel_number < far_fresnel_number)
        say_note("so far away the pattern is all but the far field's; see --far");
    if (options.plan_only) return 0;
    const Stopwatch watch;
    const DiffractionPattern pattern = pattern_with_progress(options, job);
    const double seconds = watch.seconds();
    write_pattern(options, pattern);
    write_stats(options.stats_json, stats_text(options, job, seconds), options.existing);
    return 0;
}

}  // namespace obscura
