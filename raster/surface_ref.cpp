// From a sample's depth and triangle to its surface, one sample at a time.

#include <cmath>

#include "core/scalar_lanes.h"
#include "core/vec_arrays.h"
#include "raster/coverage.h"
#include "raster/depth_tile.h"
#include "raster/surface.h"

namespace obscura::ref {
namespace {

/// A ray and how it changes from pixel to pixel, relative to the eye.
struct Ray {
    Vec3f origin, dir;
    Vec3f origin_x, origin_y, dir_x, dir_y;
};

/// v0 + Y vy of a row in double, then rounded: the columns are added in float.
Vec3f row_start(const double (&v0)[3], const double (&vy)[3], double Y) {
    return {static_cast<float>(v0[0] + vy[0] * Y), static_cast<float>(v0[1] + vy[1] * Y),
            static_cast<float>(v0[2] + vy[2] * Y)};
}

Ray ray_at(const CameraRays& rays, double X, double Y) {
    Ray r;
    r.origin_x = to_float(vec(rays.origin_x));
    r.origin_y = to_float(vec(rays.origin_y));
    r.dir_x = to_float(vec(rays.dir_x));
    r.dir_y = to_float(vec(rays.dir_y));
    const auto x = static_cast<float>(X);
    r.origin = row_start(rays.origin0, rays.origin_y, Y) + r.origin_x * x;
    r.dir = row_start(rays.dir0, rays.dir_y, Y) + r.dir_x * x;
    return r;
}

/// The four signed volumes of Moeller and Trumbore, all linear in a ray: u = un / det, v = vn / det.
struct RayTriangle {
    Vec3f e1, e2;
    Vec3f s;        ///< corner 0 to ray origin
    Vec3f a, b, c;  ///< un = dir . a, vn = dir . b, det = dir . c
    float un, vn, inv;
};

RayTriangle ray_triangle(const Vec3f (&corner)[3], Vec3f origin, Vec3f dir) {
    RayTriangle m;
    m.e1 = corner[1] - corner[0];
    m.e2 = corner[2] - corner[0];
    m.s = origin - corner[0];
    m.a = cross(m.e2, m.s);
    m.b = cross(m.s, m.e1);
    m.c = cross(m.e2, m.e1);
    m.un = dot(dir, m.a);
    m.vn = dot(dir, m.b);
    m.inv = 1.0f / dot(dir, m.c);
    return m;
}

Barycentrics clamped(const RayTriangle& m) {
    // A ray in the triangle's plane gives NaN or infinity; the comparisons turn both into a corner.
    const float b1 = lane_min(lane_max(m.un * m.inv, 0.0f), 1.0f);
    const float b2 = lane_min(lane_max(m.vn * m.inv, 0.0f), 1.0f - b1);
    return {b1, b2};
}

/// Change of b1 and b2 when the ray's origin moves by `o` and its direction by `d` (quotient rule).
Barycentrics step(const RayTriangle& m, Vec3f dir, Vec3f o, Vec3f d) {
    const float un = dot(d, m.a) + dot(o, cross(dir, m.e2));
    const float vn = dot(d, m.b) + dot(o, cross(m.e1, dir));
    const float det = dot(d, m.c);
    return {(un - (m.un * m.inv) * det) * m.inv, (vn - (m.vn * m.inv) * det) * m.inv};
}

Vec2f interpolated(const Vec2f& corner, const Vec2f& e1, const Vec2f& e2, Barycentrics b) {
    return {(corner.x + e1.x * b.b1) + e2.x * b.b2, (corner.y + e1.y * b.b1) + e2.y * b.b2};
}

struct Store {
    SurfaceBlock& block;
    int at;
    void position(Vec3f p) {
        block.px[at] = p.x;
        block.py[at] = p.y;
        block.pz[at] = p.z;
    }
    void normal(Vec3f n) {
        block.nx[at] = n.x;
        block.ny[at] = n.y;
        block.nz[at] = n.z;
    }
    void geometric(Vec3f g) {
        block.gx[at] = g.x;
        block.gy[at] = g.y;
        block.gz[at] = g.z;
    }
};

void texture_coordinates(const SurfaceVertex* const (&vertex)[3], const RayTriangle& m, const Ray& ray,
                         Barycentrics b, SurfaceBlock& block, int at) {
    const auto uv = [&](int k) { return Vec2f{vertex[k]->uv[0], vertex[k]->uv[1]}; };
    const Vec2f uv0 = uv(0), e1 = uv(1) - uv0, e2 = uv(2) - uv0;
    const Vec2f here = interpolated(uv0, e1, e2, b);
    const Barycentrics bx = step(m, ray.dir, ray.origin_x, ray.dir_x);
    const Barycentrics by = step(m, ray.dir, ray.origin_y, ray.dir_y);
    block.u[at] = here.x;
    block.v[at] = here.y;
    block.ux[at] = e1.x * bx.b1 + e2.x * bx.b2;
    block.vx[at] = e1.y * bx.b1 + e2.y * bx.b2;
    block.uy[at] = e1.x * by.b1 + e2.x * by.b2;
    block.vy[at] = e1.y * by.b1 + e2.y * by.b2;
}

/// Corners of a triangle.
struct Corners {
    const SurfaceVertex* vertex[3];
    std::uint32_t index[3];
};

Corners corners_of(const SurfaceMesh& mesh, std::uint32_t triangle) {
    Corners c;
    for (int k = 0; k < 3; ++k) {
        c.index[k] = mesh.corners[3 * static_cast<std::size_t>(triangle) + static_cast<std::size_t>(k)];
        c.vertex[k] = mesh.vertices + c.index[k];
    }
    return c;
}

/// Positions are relative to the eye, which two floats hold per axis.
Vec3f relative_to_eye(const CameraRays& rays, Vec3f position) {
    const Vec3f eye = to_float(vec(rays.eye));
    const Vec3f eye_rest = {static_cast<float>(rays.eye[0] - static_cast<double>(eye.x)),
                            static_cast<float>(rays.eye[1] - static_cast<double>(eye.y)),
                            static_cast<float>(rays.eye[2] - static_cast<double>(eye.z))};
    return (position - eye) - eye_rest;
}

Vec3f smooth_normal(const Corners& corners, Barycentrics b, Vec3f geometric) {
    const Vec3f n0 = vec(corners.vertex[0]->normal);
    const Vec3f sum =
        (n0 + (vec(corners.vertex[1]->normal) - n0) * b.b1) + (vec(corners.vertex[2]->normal) - n0) * b.b2;
    const float square = dot(sum, sum);
    return square > 1e-12f ? sum * (1.0f / std::sqrt(square)) : geometric;
}

void surface_sample(const SurfaceMesh& mesh, const CameraRays& rays, const Ray& ray, SurfaceBlock& block,
                    int at) {
    const std::uint32_t t = block.triangle[at];
    const SurfaceTriangle& surface = mesh.triangles[t];
    Store out{block, at};
    out.position(ray.origin + ray.dir * view_distance(rays, block.depth[at]));

    const Vec3f geometric = vec(surface.normal);
    Vec3f normal = geometric;
    if ((surface.info & (surface_smooth | surface_textured)) != 0) {
        const Corners corners = corners_of(mesh, t);
        Vec3f corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] = relative_to_eye(rays, vec(corners.vertex[k]->position));
        const RayTriangle m = ray_triangle(corner, ray.origin, ray.dir);
        const Barycentrics b = clamped(m);
        if ((surface.info & surface_smooth) != 0) normal = smooth_normal(corners, b, geometric);
        if ((surface.info & surface_textured) != 0) texture_coordinates(corners.vertex, m, ray, b, block, at);
    }

    // Seen from behind: both normals turn to the viewer.
    const bool behind = 0.0f < dot(geometric, ray.dir);
    out.normal(behind ? -normal : normal);
    out.geometric(behind ? -geometric : geometric);
    block.material[at] = static_cast<std::int32_t>(surface.info & surface_material_mask);
}

/// The same where vertices are seen elsewhere than they are: the ray meets the triangle that is seen, and its
/// barycentrics say where in the true one it is.
void moved_sample(const SurfaceMesh& mesh, const CameraRays& rays, const Ray& ray, SurfaceBlock& block,
                  int at) {
    const std::uint32_t t = block.triangle[at];
    const SurfaceTriangle& surface = mesh.triangles[t];
    Store out{block, at};
    const Corners corners = corners_of(mesh, t);
    Vec3f seen[3], corner[3];
    for (int k = 0; k < 3; ++k) {
        const float* p = mesh.seen + 3 * static_cast<std::size_t>(corners.index[k]);
        seen[k] = relative_to_eye(rays, {p[0], p[1], p[2]});
        corner[k] = relative_to_eye(rays, vec(corners.vertex[k]->position));
    }
    const RayTriangle m = ray_triangle(seen, ray.origin, ray.dir);
    const Barycentrics b = clamped(m);
    out.position((corner[0] + (corner[1] - corner[0]) * b.b1) + (corner[2] - corner[0]) * b.b2);

    const Vec3f geometric = vec(surface.normal);
    const bool smooth = (surface.info & surface_smooth) != 0;
    const Vec3f normal = smooth ? smooth_normal(corners, b, geometric) : geometric;
    if ((surface.info & surface_textured) != 0) texture_coordinates(corners.vertex, m, ray, b, block, at);

    // The side that is seen is the seen triangle's; its normal is -m.c.
    const bool behind = dot(ray.dir, m.c) < 0.0f;
    out.normal(behind ? -normal : normal);
    out.geometric(behind ? -geometric : geometric);
    block.material[at] = static_cast<std::int32_t>(surface.info & surface_material_mask);
}

}  // namespace

Barycentrics barycentrics(const Vec3f (&corner)[3], Vec3f origin, Vec3f dir) {
    return clamped(ray_triangle(corner, origin, dir));
}

void surface_block(const SurfaceMesh& mesh, const CameraRays& rays, const TileRect& tile,
                   std::int32_t first_row, SurfaceBlock& block) noexcept {
    for (int group = 0; group < block_groups; ++group) {
        std::uint32_t covered = 0, open = 0, textured = 0, thin = 0;
        for (int lane = 0; lane < 16; ++lane) {
            const int at = 16 * group + lane;
            const double X = sample_position(tile.x0 + at % frame_tile_side, tile.sample_x);
            const double Y = sample_position(tile.y0 + first_row + at / frame_tile_side, tile.sample_y);
            const Ray ray = ray_at(rays, X, Y);
            const bool moved = mesh.seen != nullptr;
            if (block.triangle[at] == no_triangle) {
                const Vec3f dir = moved ? ray.dir + ray.dir_x * mesh.background_shift_px : ray.dir;
                Store{block, at}.position(ray.origin + dir * 1.0f);
                block.material[at] = 0;
                continue;
            }
            if (moved) {
                moved_sample(mesh, rays, ray, block, at);
            } else {
                surface_sample(mesh, rays, ray, block, at);
            }
            const std::uint32_t info = mesh.triangles[block.triangle[at]].info, bit = 1u << lane;
            covered |= bit;
            open |= (info & surface_open) != 0 ? bit : 0;
            textured |= (info & surface_textured) != 0 ? bit : 0;
            thin |= (info & surface_thin) != 0 ? bit : 0;
        }
        block.covered[group] = covered;
        block.open[group] = open;
        block.textured[group] = textured;
        block.thin[group] = thin;
    }
}

}  // namespace obscura::ref
