#pragma once
// Phong shading for Embree's packets: 16 pixels at a time, built once per instruction set so that the peer is
// not held back by baseline code around its rays. Phong, "Illumination for computer generated pictures",
// 1975, with the exponent 32 by five squarings; the GLSL of peer_llvmpipe.cpp computes the same. Plain data
// only: kernels include this (see core/rooms.cmake).

#include <cstdint>

namespace obscura {

/// Constants of a frame, world space, linear RGB.
struct PhongScene {
    const float* normals = nullptr;  ///< per triangle three vertex normals, nine floats
    float eye[3] = {};
    float to_light[3] = {};  ///< unit
    float albedo[3] = {};
    float sun[3] = {};  ///< irradiance / pi of the directional light
    float ambient[3] = {};
    float specular = 0.2f;
    float offset_m = 0;  ///< shadow rays start this far off the surface along the normal
};

inline constexpr std::uint32_t no_hit = 0xffffffffu;

/// Sixteen pixels on their way through shading, one array per quantity.
struct alignas(64) PhongPacket {
    float dir_x[16], dir_y[16], dir_z[16];  ///< primary ray, any length
    float t[16], u[16], v[16];              ///< hit
    std::uint32_t triangle[16];             ///< no_hit = background
    float normal_x[16], normal_y[16], normal_z[16];
    float shadow_x[16], shadow_y[16], shadow_z[16];  ///< start of the shadow ray
    float n_dot_l[16];
    float lit[16];  ///< 1 lit, 0 in shadow
    float r[16], g[16], b[16];
};

/// Steps of one packet: surface() fills normal, shadow start and n_dot_l (0 on background), then the caller
/// traces shadow rays and fills lit, then shade() fills r, g, b (0 on background).
struct PhongKernels {
    void (*surface)(const PhongScene&, PhongPacket&) noexcept;
    void (*shade)(const PhongScene&, PhongPacket&) noexcept;
};

namespace sse2 {
extern const PhongKernels phong;
}
namespace avx2 {
extern const PhongKernels phong;
}
namespace avx512bw {
extern const PhongKernels phong;
}

}  // namespace obscura
