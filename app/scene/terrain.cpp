#include "app/scene/terrain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/texture.h"

namespace obscura {
namespace {

using Colour = std::array<double, 3>;  // sRGB codes

Colour mixed(const Colour& a, const Colour& b, double share) {
    const double t = std::clamp(share, 0.0, 1.0);
    return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

struct Stop {
    double height;  ///< 0 the lowest, 1 the highest
    Colour colour;
};
constexpr std::array<Stop, 6> heights{{{0.00, {104, 116, 70}},
                                       {0.20, {84, 100, 58}},
                                       {0.45, {120, 114, 78}},
                                       {0.70, {124, 116, 106}},
                                       {0.82, {150, 146, 142}},
                                       {0.90, {236, 239, 243}}}};
constexpr Colour rock{108, 99, 90}, water{44, 70, 92};
/// Tangents of slopes: rock begins to show, and nothing else is seen.
constexpr double some_rock = 0.55, all_rock = 1.1;

Colour colour_of_height(double share) {
    std::size_t i = 1;
    while (i + 1 < heights.size() && share > heights[i].height)
        ++i;
    const Stop &a = heights[i - 1], &b = heights[i];
    return mixed(a.colour, b.colour, (share - a.height) / (b.height - a.height));
}

/// Tangent of the slope at a sample, by its neighbours.
double slope_at(const HeightField& f, int x, int y) {
    const int left = std::max(0, x - 1), right = std::min(f.width() - 1, x + 1);
    const int up = std::max(0, y - 1), down = std::min(f.height() - 1, y + 1);
    const auto rise = [&](int x0, int y0, int x1, int y1) {
        return metres_of(f.height_q16(x1, y1)) - metres_of(f.height_q16(x0, y0));
    };
    const double dx = rise(left, y, right, y) / ((right - left) * f.cell_x_m);
    const double dy = rise(x, up, x, down) / ((down - up) * f.cell_y_m);
    return std::sqrt(dx * dx + dy * dy);
}

Texture terrain_picture(const std::string& name, const ElevationModel& model, const Limits& limits,
                        std::int64_t max_bytes) {
    const HeightField& f = model.field;
    int step = 1;
    while (std::max(f.width(), f.height()) / step > limits.texture_px ||
           texture_bytes(f.width() / step, f.height() / step) > max_bytes)
        ++step;
    const int width = std::max(1, f.width() / step), height = std::max(1, f.height() / step);
    Image<Rgba8> picture(width, height);
    const double range_m = std::max(model.greatest_m - model.least_m, 1e-9);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int i = std::min(f.width() - 1, x * step + step / 2),
                      j = std::min(f.height() - 1, y * step + step / 2);
            const double height_m = metres_of(f.height_q16(i, j)), slope = slope_at(f, i, j);
            const bool is_water = height_m <= 0 && slope == 0;
            const Colour level = is_water ? water : colour_of_height((height_m - model.least_m) / range_m);
            const Colour c = mixed(level, rock, (slope - some_rock) / (all_rock - some_rock));
            const auto code = [](double v) { return static_cast<std::uint8_t>(std::floor(v + 0.5)); };
            picture(x, y) = {code(c[0]), code(c[1]), code(c[2]), 255};
        }
    }
    return make_texture(name, picture.view());
}

}  // namespace

ElevationModel load_elevation(const std::filesystem::path& file, const std::string& named,
                              const FileAccess& access, const Limits& limits,
                              const ElevationOptions& options) {
    const std::string bytes = read_model_bytes(file, limits);
    std::optional<std::string> description;
    const std::string beside = sidecar_name(file.filename().string());
    if (!beside.empty()) {
        try {
            description = read_model_bytes(resolve_beside(access, file.parent_path(), beside), limits);
        } catch (const MissingFile&) {
            // Then the scene has to say what it would have said.
        }
    }
    ElevationModel model = decode_elevation(bytes, named, description, options);
    if (model.field.width() < 2 || model.field.height() < 2)
        throw InputError(named, "has no cell: a terrain has two samples or more both ways");
    return model;
}

std::uint32_t add_terrain_look(Scene& scene, const std::string& id, const ElevationModel& model,
                               std::int64_t max_bytes) {
    const std::int64_t half = (scene.limits.texture_mib << 20) / 2;
    Material look{.name = id + "/ground"};
    look.base_color = {1, 1, 1};
    look.roughness = 0.95f;
    look.texture = static_cast<std::int32_t>(scene.textures.size());
    scene.textures.push_back(terrain_picture(look.name, model, scene.limits, std::min(half, max_bytes)));
    scene.materials.push_back(std::move(look));
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

}  // namespace obscura
