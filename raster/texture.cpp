#include "raster/texture.h"

#include <bit>
#include <cmath>

#include "core/scalar_lanes.h"

namespace obscura {
namespace {

/// The two texels around a coordinate and the weight of the second.
struct Neighbours {
    int first, second;
    float weight;
};

Neighbours neighbours(float coordinate, int size) {
    // Wrap first: what is left lies in [0, 1], whatever came in.
    const float wrapped = lane_min(lane_max(coordinate - std::floor(coordinate), 0.0f), 1.0f);
    const float x = wrapped * static_cast<float>(size) - 0.5f;
    const float below = std::floor(x);
    const int i = static_cast<int>(below);
    return {i < 0 ? size - 1 : i, i + 1 >= size ? 0 : i + 1, x - below};
}

Vec3f mix(Vec3f a, Vec3f b, float t) {
    return a + (b - a) * t;
}

}  // namespace

float fast_log2(float x) {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    const float exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
    const float t = std::bit_cast<float>((bits & 0x007fffffu) | 0x3f800000u) - 1.0f;
    // log2(1 + t) on [0, 1], exact at both ends.
    return exponent + (t + (t * (1.0f - t)) * (0.438073245f + t * (-0.236693417f + t * 0.0803073039f)));
}

float mip_level(const Texture& texture, const UvFootprint& footprint) {
    const auto width = static_cast<float>(texture.levels[0].width);
    const auto height = static_cast<float>(texture.levels[0].height);
    const auto square = [&](Vec2f d) {
        const float x = d.x * width, y = d.y * height;
        return x * x + y * y;
    };
    // The square of the side; NaN and infinity (a surface seen edge-on) become the coarsest level.
    const float side = lane_min(lane_max(square(footprint.per_x), square(footprint.per_y)), 1e30f);
    const float level = 0.5f * fast_log2(lane_max(side, 1.0f));
    return lane_min(level, static_cast<float>(texture.levels.size() - 1));
}

Vec3f sample_level(const Texture& texture, int level, Vec2f uv) {
    const Image<Vec3f>& image = texture.levels[static_cast<std::size_t>(level)];
    const Neighbours x = neighbours(uv.x, image.width);
    const Neighbours y = neighbours(1.0f - uv.y, image.height);
    const Vec3f* upper = image.row(y.first);
    const Vec3f* lower = image.row(y.second);
    return mix(mix(upper[x.first], upper[x.second], x.weight), mix(lower[x.first], lower[x.second], x.weight),
               y.weight);
}

Vec3f sample_trilinear(const Texture& texture, Vec2f uv, float level) {
    const int finer = static_cast<int>(level);
    const float weight = level - static_cast<float>(finer);
    const Vec3f fine = sample_level(texture, finer, uv);
    if (weight == 0.0f) return fine;
    return mix(fine, sample_level(texture, finer + 1, uv), weight);
}

void sample_textures(SurfaceBlock& block, std::span<const ShadeMaterial> materials,
                     std::span<const Texture> textures) {
    for (int group = 0; group < block_groups; ++group) {
        for (std::uint32_t left = block.textured[group]; left != 0; left &= left - 1) {
            const int at = 16 * group + std::countr_zero(left);
            const ShadeMaterial& material = materials[static_cast<std::size_t>(block.material[at])];
            const Texture& texture = textures[static_cast<std::size_t>(material.texture)];
            const float level =
                mip_level(texture, {{block.ux[at], block.vx[at]}, {block.uy[at], block.vy[at]}});
            const Vec3f texel = sample_trilinear(texture, {block.u[at], block.v[at]}, level);
            block.texel_r[at] = texel.x;
            block.texel_g[at] = texel.y;
            block.texel_b[at] = texel.z;
        }
    }
}

}  // namespace obscura
