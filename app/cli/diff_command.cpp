#include "app/cli/diff_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "app/cli/flags.h"
#include "app/cli/messages.h"
#include "app/cli/targets.h"
#include "app/models/file_access.h"
#include "app/report/output_plan.h"
#include "core/error.h"
#include "core/image_io.h"
#include "filters/metrics.h"

namespace obscura {
namespace {

using Picture = std::variant<Image<Rgba8>, Image<Rgba16>, FloatImage>;

std::string read_bytes(const std::filesystem::path& path) {
    std::string bytes = read_file(path, ImageFileLimits{}.max_bytes);
    if (is_png(bytes) || bytes.starts_with("PF") || bytes.starts_with("Pf")) return bytes;
    throw InputError(path.string(), "neither a PNG nor a PFM file");
}

/// `deep`: a PNG as 16-bit codes, so that nothing of either picture is lost.
Picture decode(const std::string& bytes, const std::filesystem::path& path, bool deep) {
    if (!is_png(bytes)) return decode_pfm(bytes, path.string());
    if (!deep) return decode_png(bytes, path.string());
    ImageFileLimits limits;
    limits.max_bytes *= 2;
    return decode_png16(bytes, path.string(), limits);
}

template <class Pixel>
bool is_opaque(const Image<Pixel>& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(), [](Pixel p) { return p.a == Pixel{}.a; });
}

/// Both pictures as channels that can be compared one by one.
struct Comparable {
    Planes a, b;
    double peak = 255.0;
    const char* unit = "";
};

std::string shape(const Planes& planes) {
    return fmt::format("{} x {} pixels, {} channel{}", planes[0].width, planes[0].height, planes.size(),
                       planes.size() == 1 ? "" : "s");
}

/// Two pictures of integer codes.
template <class Pixel>
Comparable code_planes(const Image<Pixel>& a, const Image<Pixel>& b, const char* unit) {
    const bool alpha = !is_opaque(a) || !is_opaque(b);
    return {split_channels(a.view(), alpha), split_channels(b.view(), alpha), double{Pixel{}.a}, unit};
}

Comparable planes_of(const Picture& a, const Picture& b) {
    if (const auto* png = std::get_if<Image<Rgba8>>(&a))
        return code_planes(*png, std::get<Image<Rgba8>>(b), "codes 0..255");
    if (const auto* png = std::get_if<Image<Rgba16>>(&a))
        return code_planes(*png, std::get<Image<Rgba16>>(b), "codes 0..65535");
    Comparable both{split_channels(std::get<FloatImage>(a)), split_channels(std::get<FloatImage>(b)), 1.0,
                    "linear"};
    both.peak = value_range(both.a);
    return both;
}

Comparable read_both(const DiffOptions& options) {
    const std::string a = read_bytes(options.a), b = read_bytes(options.b);
    if (is_png(a) != is_png(b)) {
        throw InputError(options.b.string(), fmt::format("is a {} file, but {} is not: nothing to compare",
                                                         is_png(b) ? "PNG" : "PFM", options.a.string()));
    }
    const bool deep = has_16_bit_samples(a) || has_16_bit_samples(b);
    Comparable both = planes_of(decode(a, options.a, deep), decode(b, options.b, deep));
    const Image<float>&first = both.a[0], &second = both.b[0];
    if (both.a.size() != both.b.size() || first.width != second.width || first.height != second.height) {
        throw InputError(options.b.string(), fmt::format("has {}, but {} has {}", shape(both.b),
                                                         options.a.string(), shape(both.a)));
    }
    return both;
}

void check_amount(const char* flag, double value) {
    if (!(value >= 0)) throw UsageError(fmt::format("{} must be 0 or more, got {}", flag, value));
}

std::string difference_text(const Comparable& both, const ImageDifference& d, double threshold) {
    const double pixels = static_cast<double>(both.a[0].pixels.size());
    std::string out = fmt::format("size    {}, {}\nmax     {:.6g}", shape(both.a), both.unit, d.max_error);
    if (d.max_error > 0) out += fmt::format(" at pixel {},{}", d.max_x, d.max_y);
    out +=
        fmt::format("\nmean    {:.6g}\npsnr    {:.4f} dB\nssim    {:.6f}\n", d.mean_error, d.psnr_db, d.ssim);
    out += fmt::format("differ  {} pixels above {:g} ({:.4f} %)", d.pixels_over, threshold,
                       100.0 * static_cast<double>(d.pixels_over) / pixels);
    if (d.first_x >= 0) out += fmt::format(", first at {},{}", d.first_x, d.first_y);
    if (d.not_finite > 0) {
        out += fmt::format("\ninf     {} values are not finite: mean, psnr and ssim leave them out",
                           d.not_finite);
    }
    return out + '\n';
}

}  // namespace

int diff_command(const DiffOptions& options) {
    check_amount("--threshold", options.threshold);
    if (options.fail) check_amount("--fail", *options.fail);
    if (!options.picture.empty()) {
        ReadFiles read;
        read.add(options.a);
        read.add(options.b);
        check_targets({options.picture}, {}, options.existing, read);
    }

    const Comparable both = read_both(options);
    const ImageDifference difference =
        compare_images(both.a, both.b, {both.peak, options.threshold}, options.exec);
    if (!options.picture.empty()) {
        const double scale = std::isfinite(difference.max_error) ? difference.max_error : both.peak;
        const Image<Rgb8> picture = difference_picture(both.a, both.b, scale > 0 ? scale : 1.0);
        write_file_atomically(options.picture, encode_png(picture.view()), options.existing);
    }
    print(difference_text(both, difference, options.threshold));
    const bool beyond = options.fail && difference.max_error > *options.fail;
    return static_cast<int>(beyond ? ExitCode::images_differ : ExitCode::ok);
}

int run_diff(const Arguments& arguments) {
    Flags flags("diff [options] A B",
                "Compares two PNG or two PFM files of the same size: prints the largest and mean difference, "
                "PSNR, SSIM and how many pixels differ. Differences are in codes 0 to 255 (PNG), 0 to 65535 "
                "(when either PNG has 16 bits) or in the values of the file (PFM).");
    std::string a, b, picture;
    double fail = -1;
    bool overwrite = false;
    DiffOptions options;
    flags.positional("A", a, "The first picture.");
    flags.positional("B", b, "The second picture.");
    flags.group("Comparison");
    flags.number("--threshold", "DIFF", options.threshold, 0, 1e30, "Count the pixels that differ by more.",
                 "0");
    flags.number("--fail", "DIFF", fail, 0, 1e30, "Exit with 10 when the largest difference is above this.",
                 "never");
    flags.group("Output");
    flags.text("-o,--output", "FILE", picture, "Write a picture of the differences (.png).", "none");
    flags.on_off("--overwrite", overwrite, "Replace the picture when it exists.");
    if (!flags.parse(arguments)) return 0;
    if (!picture.empty() && file_kind(picture) != FileKind::png)
        throw UsageError(fmt::format("'{}': pictures of differences end in .png", picture));
    options.a = a;
    options.b = b;
    options.picture = picture;
    if (fail >= 0) options.fail = fail;
    options.existing = overwrite ? Existing::replace : Existing::refuse;
    return diff_command(options);
}

}  // namespace obscura
