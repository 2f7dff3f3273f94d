// Sixteen pixels through Phong's formula; one object file per instruction set.

#include "bench/raster/phong.h"
#include "core/simd.h"

namespace obscura::OBSCURA_ISA {
namespace {

/// Sixteen vectors.
struct Vec16 {
    F32 x, y, z;
};

OBSCURA_INLINE Vec16 splat3(const float* v) {
    return {splat(v[0]), splat(v[1]), splat(v[2])};
}

OBSCURA_INLINE F32 dot(const Vec16& a, const Vec16& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

OBSCURA_INLINE Mask hits(const PhongPacket& p) {
    return not_negative(load(reinterpret_cast<const std::int32_t*>(p.triangle)));
}

/// Vertex normals weighted by the hit's barycentric coordinates; one component.
OBSCURA_INLINE F32 blend(const float* normals, const I32& index, const F32& w, const F32& u, const F32& v) {
    return w * gather(normals, index) + u * gather(normals + 3, index) + v * gather(normals + 6, index);
}

void surface(const PhongScene& scene, PhongPacket& p) noexcept {
    // Background lanes read the first triangle and are blanked below.
    const Mask hit = hits(p);
    const I32 triangle = select(hit, load(reinterpret_cast<const std::int32_t*>(p.triangle)), splat(0));
    const I32 index = shift_left<3>(triangle) + triangle;
    const F32 u = load(p.u), v = load(p.v), w = splat(1.0f) - u - v;
    Vec16 n{blend(scene.normals, index, w, u, v), blend(scene.normals + 1, index, w, u, v),
            blend(scene.normals + 2, index, w, u, v)};
    const F32 scale = splat(1.0f) / sqrt(dot(n, n) + splat(1e-20f));
    n = {n.x * scale, n.y * scale, n.z * scale};
    store(p.normal_x, n.x);
    store(p.normal_y, n.y);
    store(p.normal_z, n.z);
    store(p.n_dot_l, select(hit, max(dot(n, splat3(scene.to_light)), splat(0.0f)), splat(0.0f)));

    const F32 t = load(p.t), offset = splat(scene.offset_m);
    store(p.shadow_x, splat(scene.eye[0]) + t * load(p.dir_x) + offset * n.x);
    store(p.shadow_y, splat(scene.eye[1]) + t * load(p.dir_y) + offset * n.y);
    store(p.shadow_z, splat(scene.eye[2]) + t * load(p.dir_z) + offset * n.z);
}

void shade(const PhongScene& scene, PhongPacket& p) noexcept {
    // Mirror the light about the normal and compare with the way back to the eye.
    const Vec16 n{load(p.normal_x), load(p.normal_y), load(p.normal_z)};
    const Vec16 dir{load(p.dir_x), load(p.dir_y), load(p.dir_z)};
    const Vec16 light = splat3(scene.to_light);
    const F32 n_dot_l = load(p.n_dot_l), zero = splat(0.0f);
    const F32 twice = n_dot_l + n_dot_l;
    const Vec16 mirrored{twice * n.x - light.x, twice * n.y - light.y, twice * n.z - light.z};
    F32 shine = max(zero - dot(mirrored, dir) / sqrt(dot(dir, dir)), zero);
    for (int i = 0; i < 5; ++i)
        shine = shine * shine;

    const F32 lit = load(p.lit);
    const F32 diffuse = lit * n_dot_l;
    const F32 glint = select(less(zero, n_dot_l), lit * splat(scene.specular) * shine, zero);
    const Mask hit = hits(p);
    float* const out[3] = {p.r, p.g, p.b};
    for (int c = 0; c < 3; ++c) {
        const F32 sun = splat(scene.sun[c]);
        const F32 color = splat(scene.albedo[c]) * (splat(scene.ambient[c]) + sun * diffuse) + sun * glint;
        store(out[c], select(hit, color, zero));
    }
}

}  // namespace

extern const PhongKernels phong;
const PhongKernels phong{surface, shade};

}  // namespace obscura::OBSCURA_ISA
