#include "bench/shadows/wrong_picture.h"

#include <algorithm>

namespace obscura {
namespace {

/// By Okabe and Ito, in the order of Wrong.
constexpr Rgb8 kind_color[wrong_kinds] = {{230, 159, 0},  {0, 114, 178},  {213, 94, 0},  {204, 121, 167},
                                          {240, 228, 66}, {86, 180, 233}, {0, 158, 115}, {0, 0, 0}};
constexpr Rgb8 background{250, 250, 250};

/// Grey of every pixel, in [0, 1]; -1 where nothing is seen.
std::vector<float> greys(const TrueShadows& scene) {
    const VisiblePoints& points = *scene.points;
    const Vec3f light = to_float(scene.to_light);
    std::vector<float> grey(scene.truth.size(), -1.0f);
    for (std::size_t b = 0; b < points.blocks.size(); ++b) {
        const SurfaceBlock& s = points.blocks[b];
        for (int at = 0; at < block_samples; ++at) {
            if (!is_covered(s, at)) continue;
            const std::size_t pixel = points.pixel(b, at);
            const float sun = std::max(dot(Vec3f{s.gx[at], s.gy[at], s.gz[at]}, light), 0.0f);
            // Some light from above keeps faces apart in the shade.
            const float sky = 0.30f + 0.10f * s.gy[at] + 0.05f * s.gx[at];
            grey[pixel] = sky + (scene.truth[pixel] == Truth::lit ? 0.5f * sun : 0.0f);
        }
    }
    return grey;
}

}  // namespace

Image<Rgb8> wrong_picture(const TrueShadows& scene, const std::vector<std::uint8_t>& kinds) {
    const std::vector<float> grey = greys(scene);
    const int width = scene.points->width;
    Image<Rgb8> picture(width / 2, scene.points->height / 2);
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            float sum = 0;
            std::uint8_t kind = 0;
            for (int i = 0; i < 4; ++i) {
                const auto p = static_cast<std::size_t>(2 * y + i / 2) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(2 * x + i % 2);
                sum += grey[p] < 0 ? static_cast<float>(background.r) / 255.0f : grey[p];
                kind = std::max(kind, kinds[p]);
            }
            const auto level =
                static_cast<std::uint8_t>(std::floor(std::clamp(sum * 0.25f, 0.0f, 1.0f) * 255.0f + 0.5f));
            picture(x, y) = kind == 0 ? Rgb8{level, level, level} : kind_color[kind - 1];
        }
    }
    return picture;
}

}  // namespace obscura
