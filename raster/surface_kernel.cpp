// From depths and triangles to surfaces, sixteen samples of a row at a time. See surface_ref.cpp for the
// meaning of each step.
//
// Neighbouring samples mostly lie on few triangles, so a triangle's values are not gathered lane by lane:
// each distinct triangle of a group is read once and blended into its lanes.

#include "core/simd_vec.h"
#include "raster/depth_tile.h"
#include "raster/gbuffer.h"

namespace obscura::OBSCURA_ISA {
namespace {

struct Rays {
    Vec3x16 origin, dir;
};

/// What does not change within a block.
struct BlockRays {
    Vec3x16 origin_x, origin_y, dir_x, dir_y;
    Vec3x16 eye, eye_rest;
};

OBSCURA_INLINE Vec3x16 rounded(const double (&v)[3]) {
    return splat3(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
}
OBSCURA_INLINE Vec3x16 row_start(const double (&v0)[3], const double (&vy)[3], double Y) {
    return splat3(static_cast<float>(v0[0] + vy[0] * Y), static_cast<float>(v0[1] + vy[1] * Y),
                  static_cast<float>(v0[2] + vy[2] * Y));
}

OBSCURA_INLINE BlockRays block_rays(const CameraRays& rays) {
    BlockRays b;
    b.origin_x = rounded(rays.origin_x);
    b.origin_y = rounded(rays.origin_y);
    b.dir_x = rounded(rays.dir_x);
    b.dir_y = rounded(rays.dir_y);
    b.eye = rounded(rays.eye);
    double rest[3];
    for (int k = 0; k < 3; ++k)
        rest[k] = rays.eye[k] - static_cast<double>(static_cast<float>(rays.eye[k]));
    b.eye_rest = rounded(rest);
    return b;
}

OBSCURA_INLINE F32 zero() {
    return splat(0.0f);
}
OBSCURA_INLINE Vec3x16 zero3() {
    return {zero(), zero(), zero()};
}

/// Where the corners of the lanes' triangles are seen, when that is elsewhere than they are.
template <bool moved>
struct SeenLanes {};
template <>
struct SeenLanes<true> {
    Vec3x16 seen[3] = {zero3(), zero3(), zero3()};
};

/// Values of the lanes' triangles.
template <bool moved>
struct TriangleLanes : SeenLanes<moved> {
    Vec3x16 geometric = zero3();
    Vec3x16 corner[3] = {zero3(), zero3(), zero3()};
    Vec3x16 normal[3] = {zero3(), zero3(), zero3()};
    F32 u[3] = {zero(), zero(), zero()}, v[3] = {zero(), zero(), zero()};
    I32 material = splat(std::int32_t{0});
    std::uint32_t open = 0, textured = 0, thin = 0, smooth = 0;
};

OBSCURA_INLINE void blend3(const Mask& m, const float* xyz, Vec3x16& to) {
    to.x = select(m, splat(xyz[0]), to.x);
    to.y = select(m, splat(xyz[1]), to.y);
    to.z = select(m, splat(xyz[2]), to.z);
}

template <bool moved>
TriangleLanes<moved> read_triangles(const SurfaceMesh& mesh, const std::uint32_t* triangle,
                                    std::uint32_t covered) {
    TriangleLanes<moved> t;
    const I32 ids = load(reinterpret_cast<const std::int32_t*>(triangle));
    for (std::uint32_t left = covered; left != 0;) {
        const std::uint32_t id = triangle[__builtin_ctz(left)];
        const Mask m = equal(ids, splat(static_cast<std::int32_t>(id)));
        const std::uint32_t lane_bits = bits(m);
        left &= ~lane_bits;
        const SurfaceTriangle& s = mesh.triangles[id];
        blend3(m, s.normal, t.geometric);
        t.material = select(m, splat(static_cast<std::int32_t>(s.info & surface_material_mask)), t.material);
        t.open |= (s.info & surface_open) != 0 ? lane_bits : 0;
        t.thin |= (s.info & surface_thin) != 0 ? lane_bits : 0;
        if (!moved && (s.info & (surface_smooth | surface_textured)) == 0) continue;
        t.smooth |= (s.info & surface_smooth) != 0 ? lane_bits : 0;
        const std::uint32_t* corner = mesh.corners + 3 * static_cast<std::size_t>(id);
        for (int k = 0; k < 3; ++k) {
            const SurfaceVertex& vertex = mesh.vertices[corner[k]];
            blend3(m, vertex.position, t.corner[k]);
            blend3(m, vertex.normal, t.normal[k]);
            if constexpr (moved) blend3(m, mesh.seen + 3 * static_cast<std::size_t>(corner[k]), t.seen[k]);
        }
        if ((s.info & surface_textured) == 0) continue;
        t.textured |= lane_bits;
        for (int k = 0; k < 3; ++k) {
            const SurfaceVertex& vertex = mesh.vertices[corner[k]];
            t.u[k] = select(m, splat(vertex.uv[0]), t.u[k]);
            t.v[k] = select(m, splat(vertex.uv[1]), t.v[k]);
        }
    }
    return t;
}

/// Moeller and Trumbore's volumes.
struct RayTriangle {
    Vec3x16 e1, e2, a, b, c;
    F32 un, vn, inv, b1, b2;
};

OBSCURA_INLINE Vec3x16 relative_to_eye(const BlockRays& block, const Vec3x16& p) {
    return (p - block.eye) - block.eye_rest;
}

OBSCURA_INLINE RayTriangle ray_triangle(const Vec3x16 (&corner)[3], const BlockRays& block, const Rays& ray) {
    const Vec3x16 corner0 = relative_to_eye(block, corner[0]);
    RayTriangle m;
    m.e1 = relative_to_eye(block, corner[1]) - corner0;
    m.e2 = relative_to_eye(block, corner[2]) - corner0;
    const Vec3x16 s = ray.origin - corner0;
    m.a = cross(m.e2, s);
    m.b = cross(s, m.e1);
    m.c = cross(m.e2, m.e1);
    m.un = dot(ray.dir, m.a);
    m.vn = dot(ray.dir, m.b);
    m.inv = splat(1.0f) / dot(ray.dir, m.c);
    m.b1 = min(max(m.un * m.inv, zero()), splat(1.0f));
    m.b2 = min(max(m.vn * m.inv, zero()), splat(1.0f) - m.b1);
    return m;
}

struct Step {
    F32 b1, b2;
};
OBSCURA_INLINE Step step(const RayTriangle& m, const Vec3x16& dir, const Vec3x16& o, const Vec3x16& d) {
    const F32 un = dot(d, m.a) + dot(o, cross(dir, m.e2));
    const F32 vn = dot(d, m.b) + dot(o, cross(m.e1, dir));
    const F32 det = dot(d, m.c);
    return {(un - (m.un * m.inv) * det) * m.inv, (vn - (m.vn * m.inv) * det) * m.inv};
}

template <bool moved>
OBSCURA_INLINE Vec3x16 smooth_normal(const TriangleLanes<moved>& t, const RayTriangle& m) {
    const Vec3x16 sum =
        (t.normal[0] + (t.normal[1] - t.normal[0]) * m.b1) + (t.normal[2] - t.normal[0]) * m.b2;
    const F32 square = dot(sum, sum);
    const Mask usable = less(splat(1e-12f), square) & mask_of(t.smooth);
    return select(usable, sum * (splat(1.0f) / sqrt(square)), t.geometric);
}

template <bool moved>
void texture_coordinates(const TriangleLanes<moved>& t, const RayTriangle& m, const BlockRays& rays,
                         const Vec3x16& dir, SurfaceBlock& block, int at) {
    const F32 u1 = t.u[1] - t.u[0], u2 = t.u[2] - t.u[0], v1 = t.v[1] - t.v[0], v2 = t.v[2] - t.v[0];
    store(block.u + at, (t.u[0] + u1 * m.b1) + u2 * m.b2);
    store(block.v + at, (t.v[0] + v1 * m.b1) + v2 * m.b2);
    const Step x = step(m, dir, rays.origin_x, rays.dir_x);
    store(block.ux + at, u1 * x.b1 + u2 * x.b2);
    store(block.vx + at, v1 * x.b1 + v2 * x.b2);
    const Step y = step(m, dir, rays.origin_y, rays.dir_y);
    store(block.uy + at, u1 * y.b1 + u2 * y.b2);
    store(block.vy + at, v1 * y.b1 + v2 * y.b2);
}

/// Rays meet the triangles where they are.
void normals_of(const TriangleLanes<false>& t, const BlockRays& rays, const Rays& ray, SurfaceBlock& block,
                int at) {
    Vec3x16 normal = t.geometric;
    if ((t.smooth | t.textured) != 0) {
        const RayTriangle m = ray_triangle(t.corner, rays, ray);
        if (t.smooth != 0) normal = smooth_normal(t, m);
        if (t.textured != 0) texture_coordinates(t, m, rays, ray.dir, block, at);
    }
    const Mask behind = less(zero(), dot(t.geometric, ray.dir));
    store3(block.nx + at, block.ny + at, block.nz + at, negated(behind, normal));
    store3(block.gx + at, block.gy + at, block.gz + at, negated(behind, t.geometric));
}

/// Rays meet them where they are seen: moved_sample().
void normals_of(const TriangleLanes<true>& t, const BlockRays& rays, const Rays& ray, SurfaceBlock& block,
                int at) {
    const RayTriangle m = ray_triangle(t.seen, rays, ray);
    const Mask here = not_negative(load(reinterpret_cast<const std::int32_t*>(block.triangle) + at));
    const Vec3x16 corner0 = relative_to_eye(rays, t.corner[0]);
    const Vec3x16 e1 = relative_to_eye(rays, t.corner[1]) - corner0,
                  e2 = relative_to_eye(rays, t.corner[2]) - corner0;
    const Vec3x16 position = (corner0 + e1 * m.b1) + e2 * m.b2;
    const auto keep = [&](float* to, const F32& value) { store(to, select(here, value, load(to))); };
    keep(block.px + at, position.x);
    keep(block.py + at, position.y);
    keep(block.pz + at, position.z);
    const Vec3x16 normal = t.smooth != 0 ? smooth_normal(t, m) : t.geometric;
    if (t.textured != 0) texture_coordinates(t, m, rays, ray.dir, block, at);
    const Mask behind = less(dot(ray.dir, m.c), zero());
    store3(block.nx + at, block.ny + at, block.nz + at, negated(behind, normal));
    store3(block.gx + at, block.gy + at, block.gz + at, negated(behind, t.geometric));
}

template <bool moved>
void surface_group(const SurfaceMesh& mesh, const CameraRays& rays, const BlockRays& block_ray,
                   const Rays& ray, SurfaceBlock& block, int at) {
    const Mask here = not_negative(load(reinterpret_cast<const std::int32_t*>(block.triangle) + at));
    const std::uint32_t covered = bits(here);
    const int group = at / 16;
    block.covered[group] = covered;

    if constexpr (moved) {
        // Of what is covered normals_of() says more.
        const Vec3x16 dir = ray.dir + block_ray.dir_x * splat(mesh.background_shift_px);
        store3(block.px + at, block.py + at, block.pz + at, ray.origin + dir * splat(1.0f));
    } else {
        const F32 depth = load(block.depth + at);
        const F32 z =
            rays.perspective ? splat(rays.z_scale) / depth : splat(rays.z_scale) * depth + splat(rays.z_near);
        store3(block.px + at, block.py + at, block.pz + at,
               ray.origin + ray.dir * select(here, z, splat(1.0f)));
    }

    if (covered == 0) {
        block.open[group] = block.textured[group] = block.thin[group] = 0;
        store(block.material + at, splat(std::int32_t{0}));
        return;
    }
    const TriangleLanes<moved> t = read_triangles<moved>(mesh, block.triangle + at, covered);
    block.open[group] = t.open;
    block.textured[group] = t.textured;
    block.thin[group] = t.thin;
    store(block.material + at, t.material);
    normals_of(t, block_ray, ray, block, at);
}

template <bool moved>
void surface_rows(const SurfaceMesh& mesh, const CameraRays& rays, const TileRect& tile,
                  std::int32_t first_row, SurfaceBlock& block) {
    const BlockRays block_ray = block_rays(rays);
    for (int row = 0; row < block_rows; ++row) {
        const double Y = static_cast<double>(tile.y0 + first_row + row) +
                         static_cast<double>(tile.sample_y) * (1.0 / subtexel_one);
        const Vec3x16 origin = row_start(rays.origin0, rays.origin_y, Y);
        const Vec3x16 dir = row_start(rays.dir0, rays.dir_y, Y);
        for (int column = 0; column < frame_tile_side; column += lanes) {
            // Exact: pictures are narrower than 2^16, samples lie on 1/256.
            const F32 X = to_f32(lane_index() + splat(tile.x0 + column)) +
                          splat(static_cast<float>(tile.sample_x) * (1.0f / subtexel_one));
            const Rays ray{origin + block_ray.origin_x * X, dir + block_ray.dir_x * X};
            surface_group<moved>(mesh, rays, block_ray, ray, block, row * frame_tile_side + column);
        }
    }
}

}  // namespace

void surface_block(const SurfaceMesh& mesh, const CameraRays& rays, const TileRect& tile,
                   std::int32_t first_row, SurfaceBlock& block) noexcept {
    if (mesh.seen == nullptr) {
        surface_rows<false>(mesh, rays, tile, first_row, block);
    } else {
        surface_rows<true>(mesh, rays, tile, first_row, block);
    }
}

}  // namespace obscura::OBSCURA_ISA
