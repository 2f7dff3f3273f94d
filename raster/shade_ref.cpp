// Shading, one sample at a time.

#include <cmath>

#include "core/scalar_lanes.h"
#include "core/vec_arrays.h"
#include "raster/shade.h"
#include "raster/shade_terms.h"

namespace obscura::ref {
namespace {

float fifth_power(float x) {
    const float x2 = x * x;
    return (x2 * x2) * x;
}

float eighth_power(float x) {
    const float x2 = x * x, x4 = x2 * x2;
    return x4 * x4;
}

/// Schlick: f0 at normal incidence, 1 at grazing; `rest` = (1 - cos)^5.
float schlick(float f0, float rest) {
    return f0 + (1.0f - f0) * rest;
}

/// Share of diffuse light that the surface of a dielectric lets in (or out) at this cosine; `veil` = what a
/// grazing view loses more than a frontal one.
float let_in(float veil, float cosine) {
    return (1.0f - dielectric_f0) - veil * fifth_power(1.0f - cosine);
}

Vec3f to_viewer(const SurfaceBlock& s, const CameraRays& rays, int at) {
    // The background is seen in its direction, from anywhere.
    const bool covered = (s.covered[at / 16] >> (at & 15) & 1u) != 0;
    const Vec3f viewer = covered ? vec(rays.viewer) : Vec3f{0, 0, 0};
    const Vec3f way = rays.perspective
                          ? Vec3f{s.px[at], s.py[at], s.pz[at]} - viewer
                          : Vec3f{static_cast<float>(rays.dir0[0]), static_cast<float>(rays.dir0[1]),
                                  static_cast<float>(rays.dir0[2])};
    return way * (-1.0f / std::sqrt(dot(way, way)));
}

Vec3f mix(Vec3f a, Vec3f b, float t) {
    return a + (b - a) * t;
}

/// sky_radiance() with its horizon smeared, as a rough mirror shows it.
Vec3f smeared_radiance(const ShadeSky& sky, float y, float sharpness) {
    const float above = lane_min(lane_max(0.5f + y * sharpness, 0.0f), 1.0f);
    return mix(vec(sky.ground), mix(vec(sky.horizon), vec(sky.zenith), lane_max(y, 0.0f)), above);
}

/// The share that a surface mirrors of what lies around the mirror direction.
Vec3f mirrors(const ShadeMaterial& m, const ShadeBlock& shade, int at) {
    const float rest = fifth_power(1.0f - shade.nv[at]);
    const auto fresnel = [&](float f0) { return f0 + (lane_max(m.gloss, f0) - f0) * rest; };
    return {fresnel(shade.f0_r[at]), fresnel(shade.f0_g[at]), fresnel(shade.f0_b[at])};
}

/// What a surface mirrors of the sky, before its scale: the radiance from the mirror direction, blurred
/// towards the mean as alpha grows.
Vec3f mirrored(const ShadeSky& sky, const ShadeMaterial& m, const ShadeBlock& shade, Vec3f n, Vec3f v,
               int at) {
    const float nv = shade.nv[at];
    const float mirror_y = (2.0f * nv) * n.y - v.y;
    const Vec3f seen =
        mix(smeared_radiance(sky, mirror_y, m.sharpness), sky_irradiance(sky, mirror_y) * inv_pi, m.alpha);
    return mirrors(m, shade, at) * seen;
}

/// Light of the sky without occlusion: its irradiance over the diffuse part, and what is mirrored.
Vec3f ambient(const ShadeSky& sky, const ShadeMaterial& m, const ShadeBlock& shade, Vec3f n, Vec3f v,
              int at) {
    const Vec3f diffuse = {shade.diffuse_r[at], shade.diffuse_g[at], shade.diffuse_b[at]};
    return ((diffuse * sky_irradiance(sky, n.y)) * sky.diffuse + mirrored(sky, m, shade, n, v, at)) *
           sky.ambient;
}

void begin_sample(const SurfaceBlock& s, const ShadeMaterial* materials, const ShadeSky& sky,
                  const CameraRays& rays, ShadeBlock& out, int at) {
    const std::uint32_t bit = 1u << (at & 15);
    const int group = at / 16;
    const Vec3f v = to_viewer(s, rays, at);
    out.vx[at] = v.x;
    out.vy[at] = v.y;
    out.vz[at] = v.z;
    Vec3f radiance;
    if ((s.covered[group] & bit) == 0) {
        radiance = sky_radiance(sky, -v.y) * sky.background;
    } else {
        const ShadeMaterial& m = materials[s.material[at]];
        Vec3f base = vec(m.base);
        if ((s.textured[group] & bit) != 0) {
            base = base * Vec3f{s.texel_r[at], s.texel_g[at], s.texel_b[at]};
        }
        const Vec3f n = {s.nx[at], s.ny[at], s.nz[at]};
        const float nv = lane_max(dot(n, v), 1e-4f);
        const float veil = lane_max(m.gloss - dielectric_f0, 0.0f);
        out.nv[at] = nv;
        out.veil[at] = veil;
        out.alpha2[at] = m.alpha2;
        out.smith_v[at] = std::sqrt((nv * nv) * (1.0f - m.alpha2) + m.alpha2);

        // Metals have no diffuse part; thin sheets hand part of theirs to the other side.
        const Vec3f body = base * ((1.0f - m.metallic) * (let_in(veil, nv) * inv_pi));
        const Vec3f diffuse = body * (1.0f - m.translucency);
        const Vec3f through = body * m.translucency;
        const Vec3f f0 = mix({dielectric_f0, dielectric_f0, dielectric_f0}, base, m.metallic);
        out.diffuse_r[at] = diffuse.x;
        out.diffuse_g[at] = diffuse.y;
        out.diffuse_b[at] = diffuse.z;
        out.through_r[at] = through.x;
        out.through_g[at] = through.y;
        out.through_b[at] = through.z;
        out.f0_r[at] = f0.x;
        out.f0_g[at] = f0.y;
        out.f0_b[at] = f0.z;
        radiance = vec(m.emission) + ambient(sky, m, out, n, v, at);
    }
    out.r[at] = radiance.x;
    out.g[at] = radiance.y;
    out.b[at] = radiance.z;
}

/// Of a part of the sky in what is mirrored along r. Those that the surface faces, or lets through, have all
/// of it, some however far from r. Others, which it sees nothing of, only where there is no such part: they
/// count as hidden.
float mirror_weight(const SurfaceBlock& s, Vec3f r, Vec3f l, int at) {
    const bool thin = (s.thin[at / 16] >> (at & 15) & 1u) != 0;
    const bool asks = 0.0f < dot(Vec3f{s.gx[at], s.gy[at], s.gz[at]}, l) || thin;
    return asks ? eighth_power(lane_max(dot(r, l), 0.0f)) + mirror_floor : unseen_weight;
}

}  // namespace

Vec3f sky_radiance(const ShadeSky& sky, float y) {
    return y < 0.0f ? vec(sky.ground) : mix(vec(sky.horizon), vec(sky.zenith), y);
}

Vec3f sky_irradiance(const ShadeSky& sky, float y) {
    // Form factors of the upper and lower hemisphere: pi (1 +- y) / 2.
    constexpr float half_pi = 1.57079632679489662f;
    const float up = half_pi + half_pi * y, down = half_pi - half_pi * y;
    // The part that grows with height: the integral of max(w.y, 0) max(n.w, 0) over the sphere is
    // (pi / 3) y + (2 / 3) (sqrt(1 - y^2) + y asin(y)); the even part as a polynomial, to 2.4e-4.
    const float y2 = y * y;
    const float even =
        (((0.0706682383f * y2 - 0.0966529084f) * y2 + 0.0817211211f) * y2 + 0.324321685f) * y2 + 0.666902851f;
    const float rise = 1.04719755119659775f * y + even;
    return (vec(sky.horizon) * up + (vec(sky.zenith) - vec(sky.horizon)) * rise) + vec(sky.ground) * down;
}

Incident incident_light(const ShadeLight& light, Vec3f position) {
    if (light.kind == ShadeLightKind::directional) return {vec(light.to_light), vec(light.color)};
    const Vec3f d = vec(light.position) - position;
    // A surface at the light itself has no direction to it; it stays finite.
    const float r2 = lane_max(dot(d, d), 1e-12f);
    const float inv = 1.0f / std::sqrt(r2);
    const Vec3f l = d * inv;
    // Inverse square, windowed so that it ends at the range (Karis, "Real Shading in Unreal Engine 4", 2013).
    const float q = r2 * light.inv_range2;
    const float window = lane_max(1.0f - q * q, 0.0f);
    float power = (inv * inv) * (window * window);
    if (light.kind == ShadeLightKind::patch) {
        const float facing = dot(l, vec(light.to_light));
        power = (lane_max(facing, -facing * light.two_sided) / (r2 + light.radius2)) * (window * window);
    }
    if (light.kind == ShadeLightKind::spot) {
        const float t =
            lane_min(lane_max((dot(l, vec(light.to_light)) - light.cos_outer) * light.inv_cone, 0.0f), 1.0f);
        power = power * ((t * t) * (3.0f - 2.0f * t));
    }
    return {l, vec(light.color) * power};
}

LightTerms light_terms(const SurfaceBlock& s, const ShadeLight& light, const ShadeBlock& shade, int at) {
    LightTerms terms;
    terms.incident = incident_light(light, {s.px[at], s.py[at], s.pz[at]});
    const Vec3f l = terms.incident.to_light;
    const Vec3f n = {s.nx[at], s.ny[at], s.nz[at]}, v = {shade.vx[at], shade.vy[at], shade.vz[at]};
    terms.nl = dot(n, l);
    const float nl = lane_max(terms.nl, 0.0f), nv = shade.nv[at], alpha2 = shade.alpha2[at];

    // The half vector is never normalised: with h = l + v, |h|^2 = s, the quotients below are those of unit
    // vectors. 1 - (n.h)^2 is taken as |n x h|^2, which stays exact in sharp highlights.
    const Vec3f h = l + v;
    const float square = dot(h, h);
    const float nh = dot(n, h);
    const Vec3f nxh = cross(n, h);
    const float spread = lane_max(alpha2 * (nh * nh) + dot(nxh, nxh), 1e-12f);
    const float smith_l = std::sqrt((nl * nl) * (1.0f - alpha2) + alpha2);
    const float smith = nl * shade.smith_v[at] + nv * smith_l;
    // D V = alpha2 |h|^4 / (pi spread^2) * 0.5 / smith.
    const float lobe = ((0.5f * inv_pi) * (alpha2 * (square * square))) / ((spread * spread) * smith);
    const float rest = fifth_power(lane_max(1.0f - 0.5f * std::sqrt(square), 0.0f));

    const float in = let_in(shade.veil[at], nl) * nl;
    terms.diffuse = Vec3f{shade.diffuse_r[at], shade.diffuse_g[at], shade.diffuse_b[at]} * in;
    const Vec3f fresnel = {schlick(shade.f0_r[at], rest), schlick(shade.f0_g[at], rest),
                           schlick(shade.f0_b[at], rest)};
    terms.specular = fresnel * (lobe * nl);
    if ((s.thin[at / 16] >> (at & 15) & 1u) != 0) {
        const float back = lane_max(-terms.nl, 0.0f);
        terms.through = Vec3f{shade.through_r[at], shade.through_g[at], shade.through_b[at]} *
                        (let_in(shade.veil[at], back) * back);
    }
    return terms;
}

void shade_begin(const SurfaceBlock& surface, const ShadeMaterial* materials, const ShadeSky& sky,
                 const CameraRays& rays, ShadeBlock& shade) noexcept {
    for (int at = 0; at < block_samples; ++at)
        begin_sample(surface, materials, sky, rays, shade, at);
}

void shade_light(const SurfaceBlock& surface, const ShadeLight& light, const float* visibility,
                 ShadeBlock& shade) noexcept {
    for (int at = 0; at < block_samples; ++at) {
        if ((surface.covered[at / 16] >> (at & 15) & 1u) == 0) continue;
        const float seen = visibility != nullptr ? visibility[at] : 1.0f;
        const bool thin = (surface.thin[at / 16] >> (at & 15) & 1u) != 0;
        const LightTerms terms = light_terms(surface, light, shade, at);
        // What is dark or looks away gets nothing.
        if (!(0.0f < seen) || !(0.0f < terms.nl || thin)) continue;
        const Vec3f reflected = (terms.diffuse + terms.specular) + terms.through;
        const Vec3f arriving = terms.incident.irradiance * seen;
        shade.r[at] = shade.r[at] + reflected.x * arriving.x;
        shade.g[at] = shade.g[at] + reflected.y * arriving.y;
        shade.b[at] = shade.b[at] + reflected.z * arriving.z;
    }
}

void shade_sky_begin(const SurfaceBlock& surface, const ShadeMaterial* materials, const ShadeSky& sky,
                     const ShadeSkyPart* parts, std::int32_t count, ShadeBlock& shade) noexcept {
    for (int at = 0; at < block_samples; ++at) {
        if ((surface.covered[at / 16] >> (at & 15) & 1u) == 0) continue;
        const Vec3f n{surface.nx[at], surface.ny[at], surface.nz[at]},
            v{shade.vx[at], shade.vy[at], shade.vz[at]};
        const Vec3f r = n * (2.0f * shade.nv[at]) - v;
        float weights = 0.0f;
        for (std::int32_t i = 0; i < count; ++i)
            weights = weights + mirror_weight(surface, r, vec(parts[i].to_light), at);
        const ShadeMaterial& m = materials[static_cast<std::size_t>(surface.material[at])];
        const Vec3f seen = (mirrored(sky, m, shade, n, v, at) * sky.ambient) * (1.0f / weights),
                    share = mirrors(m, shade, at) * (1.0f / weights);
        shade.mirror_x[at] = r.x;
        shade.mirror_y[at] = r.y;
        shade.mirror_z[at] = r.z;
        shade.mirrored_r[at] = seen.x;
        shade.mirrored_g[at] = seen.y;
        shade.mirrored_b[at] = seen.z;
        shade.mirrors_r[at] = share.x;
        shade.mirrors_g[at] = share.y;
        shade.mirrors_b[at] = share.z;
    }
}

void shade_sky_part(const SurfaceBlock& surface, const ShadeSkyPart& part, const float* visibility,
                    const ShadeSent* sent, ShadeBlock& shade) noexcept {
    const Vec3f l = vec(part.to_light), color = vec(part.color);
    for (int at = 0; at < block_samples; ++at) {
        if ((surface.covered[at / 16] >> (at & 15) & 1u) == 0) continue;
        const float seen = visibility[at], hidden = 1.0f - seen;
        const float signed_nl = dot(Vec3f{surface.nx[at], surface.ny[at], surface.nz[at]}, l),
                    nl = lane_max(signed_nl, 0.0f), veil = shade.veil[at];
        Vec3f out =
            Vec3f{shade.diffuse_r[at], shade.diffuse_g[at], shade.diffuse_b[at]} * (let_in(veil, nl) * nl);
        if ((surface.thin[at / 16] >> (at & 15) & 1u) != 0) {
            const float back = lane_max(-signed_nl, 0.0f);
            out = out + Vec3f{shade.through_r[at], shade.through_g[at], shade.through_b[at]} *
                            (let_in(veil, back) * back);
        }
        const Vec3f r{shade.mirror_x[at], shade.mirror_y[at], shade.mirror_z[at]};
        const float weight = mirror_weight(surface, r, l, at) * hidden;
        const Vec3f taken = Vec3f{shade.mirrored_r[at], shade.mirrored_g[at], shade.mirrored_b[at]} * weight;
        Vec3f arriving = (out * color) * seen;
        if (sent != nullptr) {
            const Vec3f instead{sent->r[at], sent->g[at], sent->b[at]},
                share = Vec3f{shade.mirrors_r[at], shade.mirrors_g[at], shade.mirrors_b[at]} *
                        (weight * part.per_sr);
            arriving = arriving + (out * hidden + share) * instead;
        }
        shade.r[at] = (shade.r[at] + arriving.x) - taken.x;
        shade.g[at] = (shade.g[at] + arriving.y) - taken.y;
        shade.b[at] = (shade.b[at] + arriving.z) - taken.z;
    }
}

}  // namespace obscura::ref
