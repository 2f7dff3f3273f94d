#include "app/scene/aperture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "app/models/file_access.h"
#include "core/error.h"
#include "core/png_container.h"
#include "core/pnm.h"
#include "optics/aperture_extent.h"

namespace obscura {
namespace {

constexpr std::int64_t largest_mask_file = std::int64_t{1} << 30;

Image<float> from_codes(const GreyCodes& grey) {
    Image<float> mask(grey.codes.width, grey.codes.height);
    const auto white = static_cast<float>(grey.white);
    std::transform(grey.codes.pixels.begin(), grey.codes.pixels.end(), mask.pixels.begin(),
                   [white](std::uint16_t code) { return static_cast<float>(code) / white; });
    return mask;
}

/// `#rrggbb`, two or four digits each.
template <class Pixel>
std::string colour_text(const Pixel& p) {
    const int digits = 2 * static_cast<int>(sizeof p.r);
    return fmt::format("#{:0{}x}{:0{}x}{:0{}x}", p.r, digits, p.g, digits, p.b, digits);
}

template <class Pixel>
Image<float> from_pixels(const Image<Pixel>& picture, const std::string& name) {
    constexpr auto white = std::numeric_limits<decltype(Pixel::r)>::max();
    Image<float> mask(picture.width, picture.height);
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        const Pixel p = picture.pixels[i];
        const auto place = [&] {
            const auto width = static_cast<std::size_t>(picture.width);
            return fmt::format("pixel ({}, {})", i % width, i / width);
        };
        if (p.a != white) {
            throw InputError(name, fmt::format("{} is transparent: it could mean open or closed. Flatten the "
                                               "picture, white = open, black = closed, and save it without "
                                               "alpha",
                                               place()));
        }
        if (p.r != p.g || p.g != p.b) {
            throw InputError(name,
                             fmt::format("{} has a colour ({}): a mask is grey, white = open, black = closed",
                                         place(), colour_text(p)));
        }
        mask.pixels[i] = static_cast<float>(p.r) / static_cast<float>(white);
    }
    return mask;
}

Image<float> from_png(std::string_view bytes, const std::string& name, ImageFileLimits limits) {
    const bool deep = has_16_bit_samples(bytes);
    if (deep) limits.max_bytes *= 2;  // of as many pixels
    const PngFile file = walk_png(bytes, name, limits);
    if (file.density_x != file.density_y) {
        throw InputError(name, fmt::format("pixels are not square: chunk pHYs has {} x {} per unit; resample "
                                           "the picture, or take the chunk out when it is wrong",
                                           file.density_x, file.density_y));
    }
    return deep ? from_pixels(decode_png16(bytes, name, limits), name)
                : from_pixels(decode_png(bytes, name, limits), name);
}

}  // namespace

bool names_mask_file(std::string_view text) {
    return text.find_first_of("./\\") != std::string_view::npos;
}

Image<float> decode_mask(std::string_view bytes, const std::string& name, const ImageFileLimits& limits) {
    if (!is_png(bytes) && !is_pnm(bytes))
        throw InputError(name, "a mask is a PNG, PBM or PGM file, and this is none by its first bytes");
    Image<float> mask =
        is_png(bytes) ? from_png(bytes, name, limits) : from_codes(decode_pnm(bytes, name, limits));
    if (std::all_of(mask.pixels.begin(), mask.pixels.end(), [](float v) { return v == 0; }))
        throw InputError(name, "the aperture is closed: no pixel lets light through (white = open)");
    return mask;
}

Image<float> read_mask(const std::filesystem::path& file, const std::string& name,
                       const ImageFileLimits& limits) {
    return decode_mask(read_file(file, largest_mask_file), name, limits);
}

Image<float> square_opening(ImageView<const float> mask) {
    int left = mask.width, right = -1, top = mask.height, bottom = -1;
    for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
            if (mask(x, y) == 0) continue;
            left = std::min(left, x);
            right = std::max(right, x);
            top = std::min(top, y);
            bottom = y;
        }
    }
    CHECK(right >= 0);
    const int width = right - left + 1, height = bottom - top + 1, side = std::max(width, height);
    Image<float> square(side, side);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
            square(x + (side - width) / 2, y + (side - height) / 2) = mask(left + x, top + y);
    }
    return square;
}

Aperture scaled_aperture(Image<float> mask, const ApertureScale& scale) {
    if (scale.pitch_m.has_value() == scale.diameter_m.has_value())
        throw UsageError("aperture: give the size of its texels or its diameter, one of the two");
    const double length = scale.pitch_m ? *scale.pitch_m : *scale.diameter_m;
    if (!std::isfinite(length) || length <= 0)
        throw UsageError(fmt::format("aperture: {} is {} m, must be positive",
                                     scale.pitch_m ? "pitch" : "diameter", length));
    const OpenExtent open = open_extent(mask.view());
    const int across = std::max(open.width, open.height);
    if (scale.diameter_m && across == 0) throw InputError("aperture", "nothing is open: it has no diameter");
    Aperture aperture;
    aperture.pitch_m = scale.pitch_m ? length : length / across;
    aperture.mask = std::move(mask);
    return aperture;
}

}  // namespace obscura
