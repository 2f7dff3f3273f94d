#pragma once
// From surfaces to radiance: materials, lights and sky as the shading stages read them. POD: kernels include
// this.
//
// The surface model is glTF's metallic-roughness (Khronos, glTF 2.0, Appendix B): a microfacet lobe with
//   D: GGX (Walter, Marschner, Li, Torrance, "Microfacet Models for Refraction through Rough Surfaces", EGSR
//      2007, eq. 33), alpha = roughness^2 (Burley, "Physically-Based Shading at Disney", 2012);
//   G: Smith, height-correlated (Heitz, "Understanding the Masking-Shadowing Function", JCGT 2014, eq. 99);
//   F: Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", Eurographics 1994;
// over Lambert. Different from glTF: what Fresnel takes from the diffuse light is (1 - F'(n.l)) (1 - F'(n.v))
// (after Ashikhmin and Shirley, "An Anisotropic Phong BRDF Model", JGT 2000), not 1 - F(h.v): it is
// reciprocal too and never gives back more light than came in (tests/frame/shade_test.cpp integrates it). F'
// rises from 4 % to no more than the gloss, 1 - roughness, as the sky's specular term does (after Lagarde,
// "Adopting a physically based shading model", 2011): the facets of a rough surface are not grazed when the
// surface is, and with the full F a white wall seen along itself would give back a sixth of its light and
// look black.

#include <cstdint>

#include "raster/gbuffer.h"

namespace obscura {

/// A material, ready: 64 bytes.
struct ShadeMaterial {
    float base[3];  ///< linear, times the texture
    float alpha2;   ///< roughness^4
    float metallic;
    float alpha;  ///< roughness^2
    float gloss;  ///< 1 - roughness
    float translucency;
    float emission[3];
    std::int32_t texture;  ///< -1: none
    float sharpness;  ///< of the horizon's mirror image: it is smeared over +-0.5 / sharpness in direction y
    float unused[3];
};

/// patch: a small piece of a surface that shines, at a point.
enum class ShadeLightKind : std::int32_t { directional, point, spot, patch };

/// A light, relative to the eye.
struct ShadeLight {
    ShadeLightKind kind = ShadeLightKind::directional;
    float to_light[3] = {0, 1, 0};  ///< directional: unit, against the light's way; spot: against its axis;
                                    ///< patch: against its normal
    float position[3] = {0, 0, 0};  ///< all but directional
    float color[3] = {0, 0,
                      0};  ///< irradiance (directional) or radiant intensity, a patch's along its normal
    float inv_range2 = 0;  ///< all but directional: 1 / range_m^2
    float cos_outer = -1, inv_cone = 1;  ///< spot: smoothstep over (cos - cos_outer) * inv_cone
    /// patch: radius^2 of a disc as large. On its axis a disc of radiance L sends pi L R^2 / (r^2 + R^2),
    /// which is never more than pi L, however near (J. H. Lambert, "Photometria", 1760; R. Siegel and J.
    /// Howell, "Thermal Radiation Heat Transfer", configuration C-21); off it, about its cosine of that.
    float radius2 = 0;
    float two_sided = 0;  ///< patch: 1 shines both ways, 0 along its normal alone
};

/// Sky radiance by direction: ground below, a straight mix from horizon to zenith above.
struct ShadeSky {
    float zenith[3], horizon[3], ground[3];
    float ambient;     ///< scale of the light it sheds on surfaces, as if nothing stood before it
    float diffuse;     ///< 1; 0: its parts shed that light, and only what is mirrored is left
    float background;  ///< 1: seen behind everything; 0: black
};

/// What every light needs to know of a sample, and the sum so far.
struct alignas(64) ShadeBlock {
    float vx[block_samples], vy[block_samples], vz[block_samples];  ///< unit, to the viewer
    float nv[block_samples];                                        ///< n . v, at least 1e-4
    float veil[block_samples];                                      ///< max(gloss - 4 %, 0)
    float smith_v[block_samples];                                   ///< sqrt(nv^2 (1 - alpha2) + alpha2)
    float alpha2[block_samples];
    float diffuse_r[block_samples], diffuse_g[block_samples],
        diffuse_b[block_samples];  ///< reflected, with 1 / pi and the viewer's Fresnel term
    float through_r[block_samples], through_g[block_samples],
        through_b[block_samples];  ///< transmitted, with 1 / pi; only where block.thin
    float f0_r[block_samples], f0_g[block_samples], f0_b[block_samples];
    float r[block_samples], g[block_samples], b[block_samples];  ///< radiance, W / (m^2 sr)
    // With parts of the sky alone:
    float mirror_x[block_samples], mirror_y[block_samples], mirror_z[block_samples];  ///< the view mirrored
    float mirrored_r[block_samples], mirrored_g[block_samples],
        mirrored_b[block_samples];  ///< what is mirrored of the sky, over the weights of all parts
    float mirrors_r[block_samples], mirrors_g[block_samples],
        mirrors_b[block_samples];  ///< the share that is mirrored of anything, over the same weights
};

/// A part of the sky that sheds its light from one direction.
struct ShadeSkyPart {
    float to_light[3];  ///< unit
    float color[3];     ///< irradiance on a facing surface
    float per_sr = 0;   ///< 1 / its solid angle, which ShadeSent's light comes from
};

/// What surfaces send from where they hide a part of the sky: irradiance on a facing surface, by sample.
struct alignas(64) ShadeSent {
    float r[block_samples], g[block_samples], b[block_samples];
};

constexpr float dielectric_f0 = 0.04f;

/// Weights in what is mirrored of the sky, beside a cosine to the eighth: of any part that the surface faces;
/// and of one that it does not.
constexpr float mirror_floor = 0x1p-12f, unseen_weight = 0x1p-34f;
constexpr float inv_pi = 0.318309886183790672f;

/// shade_begin: fills `shade`; radiance = emission + ambient light, or the sky where nothing is covered.
/// shade_light: adds one light; visibility in [0, 1] per sample, null = 1 everywhere.
/// shade_sky_begin, after shade_begin: what surfaces mirror of `sky`, of which shade_sky_part takes away a
/// share for each of the parts that does not reach them. All parts that a sample asks must be told at once. A
/// part's share is its weight max(mirrored view . part, 0)^8 of the sum of all: approximate, since mirrors
/// show one direction and few parts stand for all. shade_sky_part also adds the part's diffuse light, and,
/// where it is hidden, both of what hides it (`sent`, null: nothing).
#define OBSCURA_SHADE_BLOCK                                                                                \
    void shade_begin(const SurfaceBlock& surface, const ShadeMaterial* materials, const ShadeSky& sky,     \
                     const CameraRays& rays, ShadeBlock& shade) noexcept;                                  \
    void shade_light(const SurfaceBlock& surface, const ShadeLight& light, const float* visibility,        \
                     ShadeBlock& shade) noexcept;                                                          \
    void shade_sky_begin(const SurfaceBlock& surface, const ShadeMaterial* materials, const ShadeSky& sky, \
                         const ShadeSkyPart* parts, std::int32_t count, ShadeBlock& shade) noexcept;       \
    void shade_sky_part(const SurfaceBlock& surface, const ShadeSkyPart& part, const float* visibility,    \
                        const ShadeSent* sent, ShadeBlock& shade) noexcept;
namespace ref {
OBSCURA_SHADE_BLOCK
}
namespace sse2 {
OBSCURA_SHADE_BLOCK
}
namespace avx2 {
OBSCURA_SHADE_BLOCK
}
namespace avx512bw {
OBSCURA_SHADE_BLOCK
}
#undef OBSCURA_SHADE_BLOCK

}  // namespace obscura
