#include "app/report/picture_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/report/sun_hours_picture.h"
#include "core/color.h"
#include "core/error.h"
#include "core/image_io.h"
#include "filters/tonemap.h"

namespace obscura {
namespace {

constexpr std::uint16_t white16 = 65535;

/// A picture of the same size, pixel by pixel.
template <class To, class From, class Fn>
Image<To> mapped(ImageView<const From> from, Fn&& fn) {
    Image<To> to(from.width, from.height);
    for (int y = 0; y < from.height; ++y) {
        std::transform(from.row(y), from.row(y) + from.width, to.row(y), fn);
    }
    return to;
}

std::uint8_t code8(float v) {
    return static_cast<std::uint8_t>(std::floor(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f));
}

std::uint16_t code16(double v, std::uint16_t top) {
    return static_cast<std::uint16_t>(std::floor(std::clamp(v, 0.0, 1.0) * top + 0.5));
}

std::optional<PictureDepths> range_of(const Image<float>& depth) {
    PictureDepths range{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()};
    for (const float d : depth.pixels) {
        if (!std::isfinite(d)) continue;
        range.nearest_m = std::min(range.nearest_m, d);
        range.farthest_m = std::max(range.farthest_m, d);
    }
    if (range.nearest_m > range.farthest_m) return std::nullopt;
    return range;
}

PictureFile depth_png(const Image<float>& depth) {
    const std::optional<PictureDepths> range = range_of(depth);
    const double low = range ? range->nearest_m : 0.0;
    const double span = range ? double{range->farthest_m} - low : 0.0;
    const auto code = [=](float d) {
        if (!std::isfinite(d)) return white16;
        return code16(span > 0 ? (double{d} - low) / span : 0.0, farthest_code);
    };
    return {encode_png(mapped<std::uint16_t>(depth.view(), code).view()), range};
}

std::string png_bytes(const Frame& frame, Aov aov, const RenderSettings& render, const Exec& exec) {
    switch (aov) {
        case Aov::beauty:
            return encode_png(tonemap(frame.radiance.view(), {render.exposure_ev, render.tone}, exec).view());
        case Aov::normal:
            return encode_png(
                mapped<Rgb8>(frame.normal.view(), [](Vec3f n) {
                    return Rgb8{code8(0.5f + 0.5f * n.x), code8(0.5f + 0.5f * n.y), code8(0.5f + 0.5f * n.z)};
                }).view());
        case Aov::albedo: {
            const CodeTable& srgb = linear_to_srgb8_table();
            return encode_png(mapped<Rgb8>(frame.albedo.view(), [&](Vec3f a) {
                                  return Rgb8{srgb(a.x), srgb(a.y), srgb(a.z)};
                              }).view());
        }
        case Aov::object:
            return encode_png(mapped<Rgb8>(frame.object.view(), [](std::uint32_t object) {
                                  return object == no_object ? Rgb8{} : object_color(object);
                              }).view());
        case Aov::shadow:
            return encode_png(mapped<std::uint16_t>(frame.shadow.view(), [](float v) {
                                  return code16(v, white16);
                              }).view());
        case Aov::sun_hours:
            CHECK(frame.stats.sun_hours.has_value());
            return encode_png(sun_hours_picture(frame.sun_hours.view(), *frame.stats.sun_hours).view());
        case Aov::depth:
            break;
    }
    CHECK(false, "depth has a function of its own");
    return {};
}

std::string pfm_bytes(const Frame& frame, Aov aov) {
    switch (aov) {
        case Aov::beauty:
            return encode_pfm(frame.radiance.view());
        case Aov::depth:
            return encode_pfm(frame.depth_m.view());
        case Aov::normal:
            return encode_pfm(frame.normal.view());
        case Aov::albedo:
            return encode_pfm(frame.albedo.view());
        case Aov::object:
            return encode_pfm(mapped<float>(frame.object.view(), [](std::uint32_t object) {
                                  return object == no_object ? -1.0f : static_cast<float>(object);
                              }).view());
        case Aov::shadow:
            return encode_pfm(frame.shadow.view());
        case Aov::sun_hours:
            return encode_pfm(frame.sun_hours.view());
    }
    CHECK(false, "no such channel");
    return {};
}

}  // namespace

Rgb8 object_color(std::uint32_t object) {
    // A 32-bit finaliser (murmur3, A. Appleby) spreads neighbouring indices over the colours.
    std::uint32_t h = object + 1;
    h = (h ^ (h >> 16)) * 0x85ebca6bu;
    h = (h ^ (h >> 13)) * 0xc2b2ae35u;
    h ^= h >> 16;
    const auto channel = [&](int shift) {
        return static_cast<std::uint8_t>(64 + ((h >> shift) & 0xff) * 3 / 4);
    };
    return {channel(0), channel(8), channel(16)};
}

PictureFile encode_picture(const Frame& frame, Aov aov, FileKind kind, const RenderSettings& render,
                           const Exec& exec) {
    if (kind == FileKind::pfm) return {pfm_bytes(frame, aov), std::nullopt};
    if (aov == Aov::depth) return depth_png(frame.depth_m);
    return {png_bytes(frame, aov, render, exec), std::nullopt};
}

}  // namespace obscura
