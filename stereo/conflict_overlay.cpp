#include "stereo/conflict_overlay.h"

#include <algorithm>

#include "core/error.h"
#include "stereo/map_columns.h"

namespace obscura {
namespace {

constexpr std::uint8_t line_bits =
    static_cast<std::uint8_t>(conflict_bit(ConflictKind::depth_inversion) | conflict_bit(ConflictKind::fold));

Vec3f blend(Vec3f a, Vec3f b, float t) {
    return a + (b - a) * t;
}

/// Conflicts of every pixel of the picture.
Image<std::uint8_t> in_picture(const MiddleView& view, const Image<std::uint8_t>& conflict_pixels) {
    Image<std::uint8_t> bits(view.picture_width, view.picture_height);
    for (int y = 0; y < bits.height; ++y)
        for (int x = 0; x < bits.width; ++x)
            if (const auto p = map_pixel(view, {x + 0.5, y + 0.5})) bits(x, y) = conflict_pixels(p->x, p->y);
    return bits;
}

/// Lines of one pixel's width cannot be seen: each pixel gets the line bits of all within `radius` of it, one
/// way or the other.
Image<std::uint8_t> widened(const Image<std::uint8_t>& bits, int radius) {
    const auto spread = [&](const Image<std::uint8_t>& from, int dx, int dy) {
        Image<std::uint8_t> to = from;
        for (int y = 0; y < from.height; ++y) {
            for (int x = 0; x < from.width; ++x) {
                for (int k = -radius; k <= radius; ++k) {
                    const int i = x + k * dx, j = y + k * dy;
                    if (i >= 0 && j >= 0 && i < from.width && j < from.height)
                        to(x, y) = static_cast<std::uint8_t>(to(x, y) | (from(i, j) & line_bits));
                }
            }
        }
        return to;
    };
    return spread(spread(bits, 1, 0), 0, 1);
}

}  // namespace

Vec3f conflict_colour(ConflictKind kind) {
    // sRGB (213, 94, 0), (0, 114, 178), (240, 228, 66), (0, 158, 115) in linear light.
    switch (kind) {
        case ConflictKind::depth_inversion:
            return {0.665f, 0.112f, 0.0f};
        case ConflictKind::window_violation:
            return {0.0f, 0.168f, 0.445f};
        case ConflictKind::comfort:
            return {0.871f, 0.776f, 0.0545f};
        case ConflictKind::fold:
            return {0.0f, 0.342f, 0.171f};
    }
    return {};
}

Image<Vec3f> conflict_overlay(const Image<Vec3f>& beauty, const MiddleView& view,
                              const Image<std::uint8_t>& conflict_pixels) {
    CHECK(beauty.width == view.picture_width && beauty.height == view.picture_height &&
          conflict_pixels.width == view.width() && conflict_pixels.height == view.height());
    const Image<std::uint8_t> bits =
        widened(in_picture(view, conflict_pixels), std::max(1, beauty.height / 540));
    const int period = std::max(6, beauty.height / 60);

    Image<Vec3f> overlay(beauty.width, beauty.height);
    for (int y = 0; y < overlay.height; ++y) {
        for (int x = 0; x < overlay.width; ++x) {
            // Dimmed and nearly grey, so that the colours of conflicts are the only ones.
            const Vec3f c = beauty(x, y);
            const float grey = 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
            Vec3f pixel = blend({grey, grey, grey}, c, 0.2f) * 0.45f;

            const auto paint = [&](ConflictKind kind, float share) {
                if ((bits(x, y) & conflict_bit(kind)) != 0)
                    pixel = blend(pixel, conflict_colour(kind), share);
            };
            const bool rising = (x + y) % period < period / 2;
            const bool falling = (x - y + period * overlay.height) % period < period / 2;
            paint(ConflictKind::window_violation, rising ? 0.8f : 0.2f);
            paint(ConflictKind::comfort, falling ? 0.8f : 0.2f);
            paint(ConflictKind::fold, 1);
            paint(ConflictKind::depth_inversion, 1);
            overlay(x, y) = pixel;
        }
    }
    return overlay;
}

}  // namespace obscura
