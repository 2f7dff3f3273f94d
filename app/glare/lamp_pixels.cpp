#include "app/glare/lamp_pixels.h"

#include <algorithm>

#include "app/glare/lens.h"
#include "raster/camera_rays.h"

namespace obscura {
namespace {

/// Objects with a material whose own light clips.
std::vector<bool> lamps_of(const Scene& scene, double clip) {
    std::vector<bool> lamps(scene.mesh.objects.size(), false);
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
        const Vec3f e = scene.materials[scene.mesh.material[t]].emission;
        if (static_cast<double>(std::max({e.x, e.y, e.z})) > clip) lamps[scene.mesh.object[t]] = true;
    }
    return lamps;
}

/// The nearest pixel, at most one away, whose first sample shows a lamp; itself first.
bool lamp_near(const LitPicture& picture, const std::vector<bool>& lamps, int& x, int& y) {
    const auto shows = [&](int i, int j) {
        if (i < 0 || j < 0 || i >= picture.width() || j >= picture.height()) return false;
        const std::uint32_t object = picture.object(i, j);
        return object != no_object && lamps[object];
    };
    constexpr int near[9][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    for (const auto& step : near) {
        if (!shows(x + step[0], y + step[1])) continue;
        x += step[0];
        y += step[1];
        return true;
    }
    return false;
}

}  // namespace

bool clips(const LitPicture& picture, int x, int y, double clip) {
    const Vec3f p = picture.radiance(x, y);
    return static_cast<double>(std::max({p.x, p.y, p.z})) > clip;
}

std::map<std::uint32_t, std::vector<LampPixel>> lamp_pixels(const Scene& scene, const LitPicture& picture,
                                                            double clip) {
    std::map<std::uint32_t, std::vector<LampPixel>> found;
    const std::vector<bool> lamps = lamps_of(scene, clip);
    const CameraRays rays =
        camera_rays(scene.camera, picture.width() + 2 * picture.x0, picture.height() + 2 * picture.y0);
    for (int y = 0; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x) {
            int i = x, j = y;
            if (!clips(picture, x, y, clip) || !lamp_near(picture, lamps, i, j)) continue;
            // The lamp's depth in the pixel's own direction.
            const double z = static_cast<double>(picture.depth_m(i, j)),
                         X = picture.x0 + x + 0.5 + picture.shift_at(i, j), Y = picture.y0 + y + 0.5;
            const auto along = [&](int k) {
                return rays.eye[k] + z * (rays.dir0[k] + X * rays.dir_x[k] + Y * rays.dir_y[k]);
            };
            found[picture.object(i, j)].push_back({x, y, {along(0), along(1), along(2)}});
        }
    }
    return found;
}

std::int64_t lamp_count(const Scene& scene) {
    if (!scene.optics.enabled) return 0;
    const std::vector<bool> lamps = lamps_of(scene, glare_params(scene.optics, scene.render).clip);
    return std::count(lamps.begin(), lamps.end(), true);
}

}  // namespace obscura
