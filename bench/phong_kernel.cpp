// Loops over 16 lanes that the compiler turns into vector code; one object file per instruction set.

#include "bench/phong.h"

namespace obscura::OBSCURA_ISA {
namespace {

float positive(float x) {
    return x > 0.0f ? x : 0.0f;
}

void surface(const PhongScene& scene, PhongPacket& p) noexcept {
    for (int i = 0; i < 16; ++i) {
        const bool hit = p.triangle[i] != no_hit;
        const float* n = scene.normals + (hit ? p.triangle[i] : 0u) * std::uint64_t{9};
        const float u = p.u[i], v = p.v[i], w = 1.0f - u - v;
        const float x = w * n[0] + u * n[3] + v * n[6];
        const float y = w * n[1] + u * n[4] + v * n[7];
        const float z = w * n[2] + u * n[5] + v * n[8];
        const float scale = 1.0f / __builtin_sqrtf(x * x + y * y + z * z + 1e-20f);
        p.normal_x[i] = x * scale;
        p.normal_y[i] = y * scale;
        p.normal_z[i] = z * scale;
    }
    for (int i = 0; i < 16; ++i) {
        const float dot = p.normal_x[i] * scene.to_light[0] + p.normal_y[i] * scene.to_light[1] +
                          p.normal_z[i] * scene.to_light[2];
        p.n_dot_l[i] = p.triangle[i] != no_hit ? positive(dot) : 0.0f;
        p.shadow_x[i] = scene.eye[0] + p.t[i] * p.dir_x[i] + scene.offset_m * p.normal_x[i];
        p.shadow_y[i] = scene.eye[1] + p.t[i] * p.dir_y[i] + scene.offset_m * p.normal_y[i];
        p.shadow_z[i] = scene.eye[2] + p.t[i] * p.dir_z[i] + scene.offset_m * p.normal_z[i];
    }
}

void shade(const PhongScene& scene, PhongPacket& p) noexcept {
    for (int i = 0; i < 16; ++i) {
        // Mirror the light about the normal and compare with the way back to the eye.
        const float twice = 2.0f * p.n_dot_l[i];
        const float rx = twice * p.normal_x[i] - scene.to_light[0];
        const float ry = twice * p.normal_y[i] - scene.to_light[1];
        const float rz = twice * p.normal_z[i] - scene.to_light[2];
        const float dx = p.dir_x[i], dy = p.dir_y[i], dz = p.dir_z[i];
        const float inverse_length = 1.0f / __builtin_sqrtf(dx * dx + dy * dy + dz * dz);
        float shine = positive(-(rx * dx + ry * dy + rz * dz) * inverse_length);
        shine *= shine;
        shine *= shine;
        shine *= shine;
        shine *= shine;
        shine *= shine;
        const bool facing = p.n_dot_l[i] > 0.0f;
        const float diffuse = p.lit[i] * p.n_dot_l[i];
        const float glint = facing ? p.lit[i] * scene.specular * shine : 0.0f;
        const float seen = p.triangle[i] != no_hit ? 1.0f : 0.0f;
        p.r[i] =
            seen * (scene.albedo[0] * (scene.ambient[0] + scene.sun[0] * diffuse) + scene.sun[0] * glint);
        p.g[i] =
            seen * (scene.albedo[1] * (scene.ambient[1] + scene.sun[1] * diffuse) + scene.sun[1] * glint);
        p.b[i] =
            seen * (scene.albedo[2] * (scene.ambient[2] + scene.sun[2] * diffuse) + scene.sun[2] * glint);
    }
}

}  // namespace

extern const PhongKernels phong;
const PhongKernels phong{surface, shade};

}  // namespace obscura::OBSCURA_ISA
