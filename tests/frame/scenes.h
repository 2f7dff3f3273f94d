#pragma once
// Small scenes for the tests of frames.

#include "app/frame/render_frame.h"
#include "app/frame/scene_light.h"
#include "core/num.h"
#include "core/topology.h"
#include "scenes/shapes.h"
#include "tests/frame/one_picture.h"

namespace obscura::frame_scenes {

/// Appends `part`, moved by `at`, as one object of one material.
inline void add(Scene& scene, Mesh part, std::uint32_t material, Vec3f at = {}) {
    for (Vec3f& p : part.positions)
        p = p + at;
    part.material.assign(part.triangles.size(), material);
    part.object.assign(part.triangles.size(), 0);
    part.objects.assign(1, Object{"part", true});
    analyse_topology(part);
    append_mesh(scene.mesh, part);
}

/// Matt white, no sky.
inline Scene empty_scene(int width, int height, int samples = 1) {
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].base_color = {1, 1, 1};
    scene.materials[0].roughness = 1.0f;
    scene.sky.zenith = scene.sky.horizon = scene.sky.ground = {0, 0, 0};
    scene.sky.ambient = 0;
    scene.render.width = width;
    scene.render.height = height;
    scene.render.samples = samples;
    return scene;
}

inline SceneLight directional(Vec3d direction, Vec3f irradiance, int filter_px = 3, int resolution = 512) {
    SceneLight light;
    light.light.kind = LightKind::directional;
    light.light.direction = normalize(direction);
    light.light.color = irradiance;
    light.shadow.method = ShadowMethod::map;
    light.shadow.filter_px = filter_px;
    light.shadow.resolution = resolution;
    return light;
}

inline SceneLight at_point(LightKind kind, Vec3d position, Vec3d direction, Vec3f intensity) {
    SceneLight light;
    light.light.kind = kind;
    light.light.position = position;
    light.light.direction = normalize(direction);
    light.light.color = intensity;
    light.light.range_m = 30;
    light.shadow.method = ShadowMethod::map;
    light.shadow.resolution = 256;
    return light;
}

/// A checkerboard of black and white squares, size x size texels of `square` each, with its mip chain by
/// hand.
inline Texture checkerboard(int size, int square) {
    Texture texture;
    texture.name = "checkerboard";
    texture.levels.emplace_back(size, size);
    Image<Vec3f>& top = texture.levels[0];
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const float v = ((x / square) + (y / square)) % 2 == 0 ? 1.0f : 0.0f;
            top(x, y) = {v, v, v};
        }
    }
    for (int side = size / 2; side >= 1; side /= 2) {
        const Image<Vec3f>& finer = texture.levels.back();
        Image<Vec3f> level(side, side);
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                level(x, y) = ((finer(2 * x, 2 * y) + finer(2 * x + 1, 2 * y)) +
                               (finer(2 * x, 2 * y + 1) + finer(2 * x + 1, 2 * y + 1))) *
                              0.25f;
            }
        }
        texture.levels.push_back(std::move(level));
    }
    return texture;
}

/// Everything at once: solids and sheets, smooth and flat, metal, thin, textured, lights of every kind.
inline Scene everything(int samples, bool orthographic = false) {
    Scene scene = empty_scene(200, 130, samples);
    scene.sky = Sky{};
    scene.materials.resize(5);
    scene.materials[1] = {"clay", {0.7f, 0.2f, 0.15f}, 0.35f, 0.0f, {0, 0, 0}, -1, 0.0f};
    scene.materials[2] = {"gold", {0.9f, 0.7f, 0.3f}, 0.2f, 1.0f, {0, 0, 0}, -1, 0.0f};
    scene.materials[3] = {"leaf", {0.2f, 0.5f, 0.1f}, 0.6f, 0.0f, {0.01f, 0, 0}, -1, 0.4f};
    scene.materials[4] = {"tiles", {0.9f, 0.9f, 0.8f}, 0.5f, 0.0f, {0, 0, 0}, 0, 0.0f};
    scene.textures.push_back(checkerboard(64, 8));
    add(scene, plane(12, 12, 5, 5), 4);
    add(scene, box({1, 1.5, 1}), 1, {-1.2f, 0.75f, 0});
    add(scene, sphere(0.8, 24, 12), 2, {1.0f, 0.8f, 0.3f});
    add(scene, torus(0.6, 0.2, 20, 10), 0, {0.f, 0.2f, 2.f});
    add(scene, plane(1.5, 1.0, 3, 2), 3, {0.1f, 1.5f, 1.0f});
    scene.camera.eye = {2, 2.5, 6};
    scene.camera.look_at = {0, 0.5, 0};
    if (orthographic) {
        scene.camera.kind = CameraKind::orthographic;
        scene.camera.height_m = 6;
    }
    scene.lights.push_back(directional({-0.5, -1, -0.4}, {2, 1.9f, 1.8f}, 3));
    scene.lights.push_back(at_point(LightKind::point, {-2.5, 1.5, 2}, {0, -1, 0}, {4, 3, 2}));
    scene.lights.push_back(at_point(LightKind::spot, {3, 4, 1}, {-2, -3, -1}, {20, 25, 30}));
    scene.lights[1].shadow.filter_px = 1;
    scene.lights[2].shadow.filter_px = 5;
    scene.lights[2].shadow.receivers = Receivers::static_only;
    return scene;
}

inline Vec3f pixel(const Frame& frame, int x, int y) {
    return frame.radiance.view()(x, y);
}

}  // namespace obscura::frame_scenes
