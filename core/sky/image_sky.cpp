// Equirectangular pictures as skies.

#include "core/sky/image_sky.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/num.h"

namespace obscura {

namespace {

bool is_light(Vec3f c) {
    const auto good = [](float v) { return v >= 0 && v <= largest_sky_radiance; };
    return good(c.x) && good(c.y) && good(c.z);
}

Image<Vec3f> in_colour(const FloatImage& decoded) {
    if (const auto* colour = std::get_if<Image<Vec3f>>(&decoded)) return *colour;
    const auto& grey = std::get<Image<float>>(decoded);
    Image<Vec3f> image(grey.width, grey.height);
    std::transform(grey.pixels.begin(), grey.pixels.end(), image.pixels.begin(), [](float v) {
        return Vec3f{v, v, v};
    });
    return image;
}

}  // namespace

ImageSky image_sky(std::string_view pfm_bytes, const std::string& name, double scale,
                   const ImageFileLimits& limits) {
    CHECK(scale > 0);
    ImageSky sky;
    sky.pixels = in_colour(decode_pfm(pfm_bytes, name, limits));
    const Image<Vec3f>& image = sky.pixels;
    if (image.width != 2 * image.height)
        throw InputError(name,
                         fmt::format("an equirectangular sky is twice as wide as high, not {} x {} pixels",
                                     image.width, image.height));
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        Vec3f& pixel = sky.pixels.pixels[i];
        pixel = pixel * static_cast<float>(scale);
        if (is_light(pixel)) continue;
        const auto width = static_cast<std::size_t>(image.width);
        throw InputError(
            name,
            fmt::format("pixel {}, {} of the sky{} is not from 0 to {:g} W/(m2 sr)", i % width, i / width,
                        scale == 1 ? "" : fmt::format(", times {:g},", scale), largest_sky_radiance));
    }
    return sky;
}

Vec3f sky_radiance(const ImageSky& sky, Vec3d direction) {
    const Image<Vec3f>& image = sky.pixels;
    const double azimuth = num::atan2(direction.x, -direction.z) * (180 / num::pi);
    const double turn = (azimuth - sky.left_edge_azimuth_deg) / 360;
    const double x = (turn - std::floor(turn)) * image.width - 0.5;
    const double y = num::acos(std::clamp(direction.y, -1.0, 1.0)) / num::pi * image.height - 0.5;
    const double left = std::floor(x), top = std::floor(y);
    const auto column = [&](double c) { return (static_cast<int>(c) + image.width) % image.width; };
    const auto row = [&](double r) { return std::clamp(static_cast<int>(r), 0, image.height - 1); };
    const auto u = static_cast<float>(x - left), v = static_cast<float>(y - top);
    const auto across = [&](int r) {
        return image(column(left), r) * (1 - u) + image(column(left + 1), r) * u;
    };
    return across(row(top)) * (1 - v) + across(row(top + 1)) * v;
}

}  // namespace obscura
