#include "app/cli/diff_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "app/cli/flags.h"
#include "app/scene/file_access.h"
#include "core/error.h"
#include "core/image_io.h"
#include "filters/metrics.h"

namespace obscura {
namespace {

using Picture = std::variant<Image<Rgba8>, FloatImage>;

Picture read_picture(const std::filesystem::path& path) {
    const std::string bytes = read_file(path, ImageFileLimits{}.max_bytes);
    if (is_png(bytes)) return decode_png(bytes, path.string());
    if (bytes.starts_with("PF") || bytes.starts_with("Pf")) return decode_pfm(bytes, path.string());
    throw InputError(path.string(), "neither a PNG nor a PFM file");
}

bool is_opaque(const Image<Rgba8>& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(), [](Rgba8 p) { return p.a == 255; });
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

Comparable read_both(const DiffOptions& options) {
    const Picture a = read_picture(options.a), b = read_picture(options.b);
    if (a.index() != b.index()) {
        throw InputError(options.b.string(), fmt::format("is a {} file, but {} is not: nothing to compare",
                                                         b.index() == 0 ? "PNG" : "PFM", options.a.string()));
    }
    Comparable both;
    if (const auto* png = std::get_if<Image<Rgba8>>(&a)) {
        const auto& other = std::get<Image<Rgba8>>(b);
        const bool alpha = !is_opaque(*png) || !is_opaque(other);
        both = {split_channels(png->view(), alpha), split_channels(other.view(), alpha), 255.0,
                "codes 0..255"};
    } else {
        both = {split_channels(std::get<FloatImage>(a)), split_channels(std::get<FloatImage>(b)), 1.0,
                "linear"};
        both.peak = value_range(both.a);
    }
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

void print(const Comparable& both, const ImageDifference& d, double threshold) {
    const double pixels = static_cast<double>(both.a[0].pixels.size());
    fmt::print("size    {}, {}\n", shape(both.a), both.unit);
    fmt::print("max     {:.6g}", d.max_error);
    if (d.max_error > 0) fmt::print(" at pixel {},{}", d.max_x, d.max_y);
    fmt::print("\nmean    {:.6g}\n", d.mean_error);
    fmt::print("psnr    {:.4f} dB\n", d.psnr_db);
    fmt::print("ssim    {:.6f}\n", d.ssim);
    fmt::print("differ  {} pixels above {:g} ({:.4f} %)", d.pixels_over, threshold,
               100.0 * static_cast<double>(d.pixels_over) / pixels);
    if (d.first_x >= 0) fmt::print(", first at {},{}", d.first_x, d.first_y);
    if (d.not_finite > 0)
        fmt::print("\ninf     {} values are not finite: mean, psnr and ssim leave them out", d.not_finite);
    fmt::print("\n");
}

}  // namespace

int diff_command(const DiffOptions& options) {
    check_amount("--threshold", options.threshold);
    if (options.fail) check_amount("--fail", *options.fail);
    if (!options.picture.empty()) check_writable(options.picture, options.existing);

    const Comparable both = read_both(options);
    const ImageDifference difference =
        compare_images(both.a, both.b, {both.peak, options.threshold}, options.exec);
    if (!options.picture.empty()) {
        const double scale = std::isfinite(difference.max_error) ? difference.max_error : both.peak;
        const Image<Rgb8> picture = difference_picture(both.a, both.b, scale > 0 ? scale : 1.0);
        write_file_atomically(options.picture, encode_png(picture.view()), options.existing);
    }
    print(both, difference, options.threshold);
    const bool beyond = options.fail && difference.max_error > *options.fail;
    return static_cast<int>(beyond ? ExitCode::images_differ : ExitCode::ok);
}

int run_diff(const Arguments& arguments) {
    Flags flags("diff [options] A B",
                "Compares two PNG or two PFM files of the same size: prints the largest and mean difference, "
                "PSNR, SSIM and how many pixels differ. Differences are in codes 0 to 255 (PNG) or in the "
                "values of the file (PFM).");
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
    options.a = a;
    options.b = b;
    options.picture = picture;
    if (fail >= 0) options.fail = fail;
    options.existing = overwrite ? Existing::replace : Existing::refuse;
    return diff_command(options);
}

}  // namespace obscura
