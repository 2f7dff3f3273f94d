#include "bench/raster/phong_scene.h"

#include "core/error.h"

namespace obscura {
namespace {

void store(float (&to)[3], Vec3f from) {
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

/// World length of one texel of an orthographic light view.
double texel_m(const LightView& light) {
    const Vec4d step = inverse(light.to_map) * Vec4d{1, 0, 0, 0};
    return length(Vec3d{step.x, step.y, step.z});
}

}  // namespace

PhongScene phong_constants(const BenchScene& bench) {
    const Light& light = bench.scene.lights.at(0).light;
    const Material& material = bench.scene.materials.at(0);
    PhongScene phong;
    store(phong.eye, to_float(bench.scene.camera.eye));
    store(phong.to_light, to_float(-light.direction));
    store(phong.albedo, material.base_color);
    store(phong.sun, light.color * 0.318309886f);
    store(phong.ambient, bench.scene.sky.zenith * bench.scene.sky.ambient);
    phong.offset_m = static_cast<float>(1.5 * texel_m(bench.light));
    return phong;
}

std::vector<float> corner_normals(const Mesh& mesh) {
    CHECK(mesh.normals.size() == mesh.positions.size(), "bench scenes need vertex normals");
    std::vector<float> normals;
    normals.reserve(9 * mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t v : triangle.v) {
            const Vec3f n = mesh.normals[v];
            normals.insert(normals.end(), {n.x, n.y, n.z});
        }
    }
    return normals;
}

}  // namespace obscura
