#include "core/texture.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/color.h"

namespace obscura {
namespace {

struct Size {
    int width, height;
};

Size next_level(Size s) {
    return {std::max(1, s.width / 2), std::max(1, s.height / 2)};
}

/// One pixel of a shrunk axis covers `taps` source pixels (2, or 3 when the source is odd) with these
/// weights.
struct Taps {
    int first = 0, taps = 1;
    std::array<float, 3> weight{1, 0, 0};
};

/// Area means of `from` pixels shrunk to `to` = max(1, from / 2). The odd case is the polyphase box filter of
/// Guthe and Heckbert, "Non-power-of-two mipmapping", 2005.
Taps taps_of(int i, int from, int to) {
    if (from == 1) return {};
    if (from % 2 == 0) return {2 * i, 2, {0.5f, 0.5f, 0}};
    const double n = from, k = to;
    return {2 * i,
            3,
            {static_cast<float>((k - i) / n), static_cast<float>(k / n), static_cast<float>((i + 1) / n)}};
}

Image<Vec3f> halved(const Image<Vec3f>& from) {
    const Size size = next_level({from.width, from.height});
    Image<Vec3f> to(size.width, size.height);
    for (int y = 0; y < size.height; ++y) {
        const Taps ty = taps_of(y, from.height, size.height);
        for (int x = 0; x < size.width; ++x) {
            const Taps tx = taps_of(x, from.width, size.width);
            Vec3f sum{};
            for (int j = 0; j < ty.taps; ++j) {
                const Vec3f* row = from.row(ty.first + j) + tx.first;
                Vec3f row_sum{};
                for (int i = 0; i < tx.taps; ++i) {
                    row_sum = row_sum + row[i] * tx.weight[static_cast<std::size_t>(i)];
                }
                sum = sum + row_sum * ty.weight[static_cast<std::size_t>(j)];
            }
            to(x, y) = sum;
        }
    }
    return to;
}

/// srgb_decode() of every code of 16 bits.
const std::vector<float>& linear_of_srgb16() {
    static const std::vector<float> linear = [] {
        std::vector<float> all(65536);
        for (std::size_t code = 0; code < all.size(); ++code)
            all[code] = static_cast<float>(srgb_decode(static_cast<double>(code) / 65535.0));
        return all;
    }();
    return linear;
}

template <class Pixel, class Decode>
Texture texture_of(std::string name, ImageView<const Pixel> image, Decode decode) {
    CHECK(image.width > 0 && image.height > 0);
    Texture texture{std::move(name), {}};
    Image<Vec3f>& base = texture.levels.emplace_back(image.width, image.height);
    for (int y = 0; y < image.height; ++y)
        std::transform(image.row(y), image.row(y) + image.width, base.row(y), decode);
    while (texture.levels.back().width > 1 || texture.levels.back().height > 1) {
        texture.levels.push_back(halved(texture.levels.back()));
    }
    return texture;
}

}  // namespace

Texture make_texture(std::string name, ImageView<const Rgba8> image) {
    return texture_of(std::move(name), image, [](Rgba8 p) { return srgb8_to_linear(Rgb8{p.r, p.g, p.b}); });
}

Texture make_texture(std::string name, ImageView<const Rgba16> image) {
    const std::vector<float>& linear = linear_of_srgb16();
    return texture_of(std::move(name), image, [&](Rgba16 p) {
        return Vec3f{linear[p.r], linear[p.g], linear[p.b]};
    });
}

std::int64_t texture_bytes(int width, int height) {
    std::int64_t pixels = 0;
    for (Size s{width, height};; s = next_level(s)) {
        pixels += std::int64_t{s.width} * s.height;
        if (s.width == 1 && s.height == 1) return pixels * static_cast<std::int64_t>(sizeof(Vec3f));
    }
}

}  // namespace obscura
