// Shading, sixteen samples of a row at a time. See shade_ref.cpp for the meaning of each step.

#include "core/simd_vec.h"
#include "raster/shade.h"

namespace obscura::OBSCURA_ISA {
namespace {

OBSCURA_INLINE F32 one() {
    return splat(1.0f);
}
OBSCURA_INLINE F32 fifth_power(const F32& x) {
    const F32 x2 = x * x;
    return (x2 * x2) * x;
}
OBSCURA_INLINE F32 eighth_power(const F32& x) {
    const F32 x2 = x * x, x4 = x2 * x2;
    return x4 * x4;
}
OBSCURA_INLINE F32 schlick(const F32& f0, const F32& rest) {
    return f0 + (one() - f0) * rest;
}
OBSCURA_INLINE F32 let_in(const F32& veil, const F32& cosine) {
    return splat(1.0f - dielectric_f0) - veil * fifth_power(one() - cosine);
}

OBSCURA_INLINE Vec3x16 to_viewer(const SurfaceBlock& s, const CameraRays& rays, int at) {
    // The background is seen in its direction, from anywhere.
    const Vec3x16 viewer = select(mask_of(s.covered[at / 16]), splat3(rays.viewer), splat3(0.0f, 0.0f, 0.0f));
    Vec3x16 way = load3(s.px + at, s.py + at, s.pz + at) - viewer;
    if (!rays.perspective) {
        way = splat3(static_cast<float>(rays.dir0[0]), static_cast<float>(rays.dir0[1]),
                     static_cast<float>(rays.dir0[2]));
    }
    return way * (splat(-1.0f) / sqrt(dot(way, way)));
}

OBSCURA_INLINE Vec3x16 sky_radiance(const ShadeSky& sky, const F32& y) {
    return select(less(y, splat(0.0f)), splat3(sky.ground), mix(splat3(sky.horizon), splat3(sky.zenith), y));
}

OBSCURA_INLINE Vec3x16 smeared_radiance(const ShadeSky& sky, const F32& y, const F32& sharpness) {
    const F32 above = min(max(splat(0.5f) + y * sharpness, splat(0.0f)), one());
    const Vec3x16 upper = mix(splat3(sky.horizon), splat3(sky.zenith), max(y, splat(0.0f)));
    return mix(splat3(sky.ground), upper, above);
}

OBSCURA_INLINE Vec3x16 sky_irradiance(const ShadeSky& sky, const F32& y) {
    const F32 half_pi = splat(1.57079632679489662f);
    const F32 up = half_pi + half_pi * y, down = half_pi - half_pi * y;
    const F32 y2 = y * y;
    const F32 even = (((splat(0.0706682383f) * y2 - splat(0.0966529084f)) * y2 + splat(0.0817211211f)) * y2 +
                      splat(0.324321685f)) *
                         y2 +
                     splat(0.666902851f);
    const F32 rise = splat(1.04719755119659775f) * y + even;
    return (splat3(sky.horizon) * up + (splat3(sky.zenith) - splat3(sky.horizon)) * rise) +
           splat3(sky.ground) * down;
}

/// Values of the lanes' materials, read once per distinct material of the group.
struct MaterialLanes {
    Vec3x16 base, emission;
    F32 alpha2, metallic, alpha, gloss, translucency, sharpness;
};

OBSCURA_INLINE MaterialLanes read_materials(const ShadeMaterial* materials, const std::int32_t* material,
                                            std::uint32_t covered) {
    MaterialLanes v;
    const auto fill = [&](const ShadeMaterial& m) {
        return MaterialLanes{splat3(m.base), splat3(m.emission), splat(m.alpha2),       splat(m.metallic),
                             splat(m.alpha), splat(m.gloss),     splat(m.translucency), splat(m.sharpness)};
    };
    const I32 ids = load(material);
    // Lanes that nothing covers take any material's values.
    const std::int32_t first = material[__builtin_ctz(covered)];
    v = fill(materials[first]);
    std::uint32_t left = covered & ~bits(equal(ids, splat(first)));
    while (left != 0) {
        const std::int32_t id = material[__builtin_ctz(left)];
        const Mask m = equal(ids, splat(id));
        left &= ~bits(m);
        const MaterialLanes w = fill(materials[id]);
        v.base = select(m, w.base, v.base);
        v.emission = select(m, w.emission, v.emission);
        v.alpha2 = select(m, w.alpha2, v.alpha2);
        v.metallic = select(m, w.metallic, v.metallic);
        v.alpha = select(m, w.alpha, v.alpha);
        v.gloss = select(m, w.gloss, v.gloss);
        v.translucency = select(m, w.translucency, v.translucency);
        v.sharpness = select(m, w.sharpness, v.sharpness);
    }
    return v;
}

/// The share that a surface mirrors of what lies around the mirror direction.
OBSCURA_INLINE Vec3x16 mirrors(const MaterialLanes& m, const Vec3x16& f0, const F32& nv) {
    const F32 rest = fifth_power(one() - nv);
    const auto fresnel = [&](const F32& f) { return f + (max(m.gloss, f) - f) * rest; };
    return {fresnel(f0.x), fresnel(f0.y), fresnel(f0.z)};
}

/// What a surface mirrors of the sky, before its scale.
OBSCURA_INLINE Vec3x16 mirrored(const ShadeSky& sky, const MaterialLanes& m, const Vec3x16& f0, const F32& ny,
                                const F32& vy, const F32& nv) {
    const F32 mirror_y = (splat(2.0f) * nv) * ny - vy;
    const Vec3x16 seen = mix(smeared_radiance(sky, mirror_y, m.sharpness),
                             sky_irradiance(sky, mirror_y) * splat(inv_pi), m.alpha);
    return mirrors(m, f0, nv) * seen;
}

OBSCURA_INLINE Vec3x16 ambient(const ShadeSky& sky, const MaterialLanes& m, const Vec3x16& diffuse,
                               const Vec3x16& f0, const Vec3x16& n, const Vec3x16& v, const F32& nv) {
    return ((diffuse * sky_irradiance(sky, n.y)) * splat(sky.diffuse) + mirrored(sky, m, f0, n.y, v.y, nv)) *
           splat(sky.ambient);
}

Vec3x16 surface_radiance(const SurfaceBlock& s, const ShadeMaterial* materials, const ShadeSky& sky,
                         const Vec3x16& v, ShadeBlock& out, int at) {
    const int group = at / 16;
    const MaterialLanes m = read_materials(materials, s.material + at, s.covered[group]);
    Vec3x16 base = m.base;
    if (s.textured[group] != 0) {
        const Vec3x16 texel = load3(s.texel_r + at, s.texel_g + at, s.texel_b + at);
        base = select(mask_of(s.textured[group]), base * texel, base);
    }
    const Vec3x16 n = load3(s.nx + at, s.ny + at, s.nz + at);
    const F32 nv = max(dot(n, v), splat(1e-4f));
    const F32 veil = max(m.gloss - splat(dielectric_f0), splat(0.0f));
    store(out.nv + at, nv);
    store(out.veil + at, veil);
    store(out.alpha2 + at, m.alpha2);
    store(out.smith_v + at, sqrt((nv * nv) * (one() - m.alpha2) + m.alpha2));

    const Vec3x16 body = base * ((one() - m.metallic) * (let_in(veil, nv) * splat(inv_pi)));
    const Vec3x16 diffuse = body * (one() - m.translucency);
    const Vec3x16 f0 =
        mix(Vec3x16{splat(dielectric_f0), splat(dielectric_f0), splat(dielectric_f0)}, base, m.metallic);
    store3(out.diffuse_r + at, out.diffuse_g + at, out.diffuse_b + at, diffuse);
    store3(out.f0_r + at, out.f0_g + at, out.f0_b + at, f0);
    if (s.thin[group] != 0) {
        store3(out.through_r + at, out.through_g + at, out.through_b + at, body * m.translucency);
    }
    return m.emission + ambient(sky, m, diffuse, f0, n, v, nv);
}

struct Incident {
    Vec3x16 to_light;
    Vec3x16 irradiance;
};

template <ShadeLightKind kind>
OBSCURA_INLINE Incident incident_light(const ShadeLight& light, const Vec3x16& position) {
    if constexpr (kind == ShadeLightKind::directional) {
        return {splat3(light.to_light), splat3(light.color)};
    } else {
        const Vec3x16 d = splat3(light.position) - position;
        const F32 r2 = max(dot(d, d), splat(1e-12f));
        const F32 inv = one() / sqrt(r2);
        const Vec3x16 l = d * inv;
        const F32 q = r2 * splat(light.inv_range2);
        const F32 window = max(one() - q * q, splat(0.0f));
        F32 power = (inv * inv) * (window * window);
        if constexpr (kind == ShadeLightKind::patch) {
            const F32 facing = dot(l, splat3(light.to_light));
            const F32 back = (facing ^ splat(-0.0f)) * splat(light.two_sided);
            power = (max(facing, back) / (r2 + splat(light.radius2))) * (window * window);
        }
        if constexpr (kind == ShadeLightKind::spot) {
            const F32 cone =
                (dot(l, splat3(light.to_light)) - splat(light.cos_outer)) * splat(light.inv_cone);
            const F32 t = min(max(cone, splat(0.0f)), one());
            power = power * ((t * t) * (splat(3.0f) - splat(2.0f) * t));
        }
        return {l, splat3(light.color) * power};
    }
}

/// Reflected and transmitted light per unit of irradiance, cosine included.
OBSCURA_INLINE Vec3x16 response(const SurfaceBlock& s, const ShadeBlock& shade, const Vec3x16& n,
                                const Vec3x16& l, const F32& signed_nl, int at) {
    const Vec3x16 v = load3(shade.vx + at, shade.vy + at, shade.vz + at);
    const F32 nl = max(signed_nl, splat(0.0f)), nv = load(shade.nv + at), alpha2 = load(shade.alpha2 + at);
    const Vec3x16 h = l + v;
    const F32 square = dot(h, h);
    const F32 nh = dot(n, h);
    const Vec3x16 nxh = cross(n, h);
    const F32 spread = max(alpha2 * (nh * nh) + dot(nxh, nxh), splat(1e-12f));
    const F32 smith_l = sqrt((nl * nl) * (one() - alpha2) + alpha2);
    const F32 smith = nl * load(shade.smith_v + at) + nv * smith_l;
    const F32 lobe = (splat(0.5f * inv_pi) * (alpha2 * (square * square))) / ((spread * spread) * smith);
    const F32 rest = fifth_power(max(one() - splat(0.5f) * sqrt(square), splat(0.0f)));

    const F32 veil = load(shade.veil + at);
    const F32 in = let_in(veil, nl) * nl;
    const Vec3x16 diffuse = load3(shade.diffuse_r + at, shade.diffuse_g + at, shade.diffuse_b + at) * in;
    const Vec3x16 f0 = load3(shade.f0_r + at, shade.f0_g + at, shade.f0_b + at);
    const Vec3x16 fresnel = {schlick(f0.x, rest), schlick(f0.y, rest), schlick(f0.z, rest)};
    const Vec3x16 reflected = diffuse + fresnel * (lobe * nl);
    const std::uint32_t thin = s.thin[at / 16];
    if (thin == 0) return reflected;
    const F32 back = max(signed_nl ^ splat(-0.0f), splat(0.0f));
    const Vec3x16 through =
        load3(shade.through_r + at, shade.through_g + at, shade.through_b + at) * (let_in(veil, back) * back);
    return select(mask_of(thin), reflected + through, reflected);
}

template <ShadeLightKind kind>
void add_light(const SurfaceBlock& s, const ShadeLight& light, const float* visibility, ShadeBlock& shade) {
    for (int at = 0; at < block_samples; at += lanes) {
        const std::uint32_t covered = s.covered[at / 16];
        if (covered == 0) continue;
        const F32 seen = visibility != nullptr ? load(visibility + at) : one();
        const Mask lit = mask_of(covered) & less(splat(0.0f), seen);
        if (none(lit)) continue;
        const Incident in = incident_light<kind>(light, load3(s.px + at, s.py + at, s.pz + at));
        const Vec3x16 n = load3(s.nx + at, s.ny + at, s.nz + at);
        const F32 nl = dot(n, in.to_light);
        // What is dark or looks away gets nothing.
        const Mask reached = lit & (less(splat(0.0f), nl) | mask_of(s.thin[at / 16]));
        if (none(reached)) continue;
        const Vec3x16 add = response(s, shade, n, in.to_light, nl, at) * (in.irradiance * seen);
        const Vec3x16 sum = load3(shade.r + at, shade.g + at, shade.b + at);
        store3(shade.r + at, shade.g + at, shade.b + at, select(reached, sum + add, sum));
    }
}

/// Of a part of the sky in what is mirrored along r.
OBSCURA_INLINE F32 mirror_weight(const SurfaceBlock& s, const Vec3x16& r, const Vec3x16& l, int at) {
    const Mask asks =
        less(splat(0.0f), dot(load3(s.gx + at, s.gy + at, s.gz + at), l)) | mask_of(s.thin[at / 16]);
    return select(asks, eighth_power(max(dot(r, l), splat(0.0f))) + splat(mirror_floor),
                  splat(unseen_weight));
}

}  // namespace

void shade_begin(const SurfaceBlock& surface, const ShadeMaterial* materials, const ShadeSky& sky,
                 const CameraRays& rays, ShadeBlock& shade) noexcept {
    for (int at = 0; at < block_samples; at += lanes) {
        const std::uint32_t covered = surface.covered[at / 16];
        const Vec3x16 v = to_viewer(surface, rays, at);
        store3(shade.vx + at, shade.vy + at, shade.vz + at, v);
        Vec3x16 radiance = splat3(0.0f, 0.0f, 0.0f);
        if (covered != 0xffffu) {
            radiance = sky_radiance(sky, v.y ^ splat(-0.0f)) * splat(sky.background);
        }
        if (covered != 0) {
            radiance =
                select(mask_of(covered), surface_radiance(surface, materials, sky, v, shade, at), radiance);
        }
        store3(shade.r + at, shade.g + at, shade.b + at, radiance);
    }
}

void shade_light(const SurfaceBlock& surface, const ShadeLight& light, const float* visibility,
                 ShadeBlock& shade) noexcept {
    switch (light.kind) {
        case ShadeLightKind::directional:
            return add_light<ShadeLightKind::directional>(surface, light, visibility, shade);
        case ShadeLightKind::point:
            return add_light<ShadeLightKind::point>(surface, light, visibility, shade);
        case ShadeLightKind::spot:
            return add_light<ShadeLightKind::spot>(surface, light, visibility, shade);
        case ShadeLightKind::patch:
            return add_light<ShadeLightKind::patch>(surface, light, visibility, shade);
    }
}

void shade_sky_begin(const SurfaceBlock& surface, const ShadeMaterial* materials, const ShadeSky& sky,
                     const ShadeSkyPart* parts, std::int32_t count, ShadeBlock& shade) noexcept {
    for (int at = 0; at < block_samples; at += lanes) {
        const std::uint32_t covered = surface.covered[at / 16];
        if (covered == 0) continue;
        const MaterialLanes m = read_materials(materials, surface.material + at, covered);
        const Vec3x16 n = load3(surface.nx + at, surface.ny + at, surface.nz + at),
                      v = load3(shade.vx + at, shade.vy + at, shade.vz + at);
        const Vec3x16 f0 = load3(shade.f0_r + at, shade.f0_g + at, shade.f0_b + at);
        const F32 nv = load(shade.nv + at);
        const Vec3x16 r = n * (splat(2.0f) * nv) - v;
        F32 weights = splat(0.0f);
        for (std::int32_t i = 0; i < count; ++i)
            weights = weights + mirror_weight(surface, r, splat3(parts[i].to_light), at);
        store3(shade.mirror_x + at, shade.mirror_y + at, shade.mirror_z + at, r);
        const Vec3x16 seen = mirrored(sky, m, f0, n.y, v.y, nv) * splat(sky.ambient);
        store3(shade.mirrored_r + at, shade.mirrored_g + at, shade.mirrored_b + at, seen * (one() / weights));
        store3(shade.mirrors_r + at, shade.mirrors_g + at, shade.mirrors_b + at,
               mirrors(m, f0, nv) * (one() / weights));
    }
}

void shade_sky_part(const SurfaceBlock& surface, const ShadeSkyPart& part, const float* visibility,
                    const ShadeSent* sent, ShadeBlock& shade) noexcept {
    const Vec3x16 l = splat3(part.to_light), color = splat3(part.color);
    for (int at = 0; at < block_samples; at += lanes) {
        const std::uint32_t covered = surface.covered[at / 16];
        if (covered == 0) continue;
        const F32 seen = load(visibility + at), hidden = one() - seen;
        const Vec3x16 n = load3(surface.nx + at, surface.ny + at, surface.nz + at);
        const F32 signed_nl = dot(n, l), nl = max(signed_nl, splat(0.0f)), veil = load(shade.veil + at);
        Vec3x16 out =
            load3(shade.diffuse_r + at, shade.diffuse_g + at, shade.diffuse_b + at) * (let_in(veil, nl) * nl);
        const std::uint32_t thin = surface.thin[at / 16];
        if (thin != 0) {
            const F32 back = max(signed_nl ^ splat(-0.0f), splat(0.0f));
            const Vec3x16 through = load3(shade.through_r + at, shade.through_g + at, shade.through_b + at) *
                                    (let_in(veil, back) * back);
            out = select(mask_of(thin), out + through, out);
        }
        const Vec3x16 r = load3(shade.mirror_x + at, shade.mirror_y + at, shade.mirror_z + at);
        const F32 weight = mirror_weight(surface, r, l, at) * hidden;
        const Vec3x16 taken =
            load3(shade.mirrored_r + at, shade.mirrored_g + at, shade.mirrored_b + at) * weight;
        Vec3x16 arriving = (out * color) * seen;
        if (sent != nullptr) {
            const Vec3x16 instead = load3(sent->r + at, sent->g + at, sent->b + at);
            const Vec3x16 share = load3(shade.mirrors_r + at, shade.mirrors_g + at, shade.mirrors_b + at) *
                                  (weight * splat(part.per_sr));
            arriving = arriving + (out * hidden + share) * instead;
        }
        const Vec3x16 sum = load3(shade.r + at, shade.g + at, shade.b + at);
        const Vec3x16 next = (sum + arriving) - taken;
        store3(shade.r + at, shade.g + at, shade.b + at, select(mask_of(covered), next, sum));
    }
}

}  // namespace obscura::OBSCURA_ISA
