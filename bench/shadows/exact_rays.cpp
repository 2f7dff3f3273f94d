#include "bench/shadows/exact_rays.h"

#include <algorithm>
#include <cmath>

#include "bench/embree/embree_scene.h"
#include "core/parallel.h"

namespace obscura {

struct ExactRays::Scene {
    const Mesh& mesh;
    double ulp = 0;  ///< unit in the last place of the largest coordinate, metres
    EmbreeDevice device{0};
    EmbreeScene embree{
        device, mesh,
        static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION)};

    explicit Scene(const Mesh& mesh_) : mesh(mesh_) {}
};

namespace {

constexpr double judged_ulps = 1024, own_surface_ulps = 8;

/// Embree hands the context's address to the filter, so `base` comes first.
struct RayContext {
    RTCIntersectContext base;
    const Mesh* mesh;
    double ulp;
    Vec3d point, direction;
    std::uint32_t face;
    double beside_m;  ///< faces whose planes pass as close to the point are left out
};

bool is_own_surface(const RayContext& ray, std::uint32_t triangle, double t) {
    const std::uint32_t face = ray.mesh->face[triangle];
    if (face == ray.face) return true;
    const Plane& plane = ray.mesh->faces[face];
    const double height = dot(plane.n, ray.point) + plane.d;
    if (std::fabs(height) < ray.beside_m) return true;
    if (t > judged_ulps * ray.ulp) return false;
    // Distance along the ray to the plane of the face that was hit; edge-on it says nothing.
    const double across = dot(plane.n, ray.direction);
    if (std::fabs(across) < 1e-9) return true;
    return -height / across <= own_surface_ulps * ray.ulp;
}

void ignore_own_surface(const RTCFilterFunctionNArguments* args) {
    const auto& ray = *reinterpret_cast<const RayContext*>(args->context);
    for (unsigned lane = 0; lane < args->N; ++lane) {
        if (args->valid[lane] == 0) continue;
        const unsigned triangle = RTCHitN_primID(args->hit, args->N, lane);
        const auto t = static_cast<double>(RTCRayN_tfar(args->ray, args->N, lane));
        if (is_own_surface(ray, triangle, t)) args->valid[lane] = 0;
    }
}

}  // namespace

ExactRays::ExactRays(const Mesh& mesh) : scene_(std::make_unique<Scene>(mesh)) {
    float largest = 0;
    for (const Vec3f& p : mesh.positions)
        largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    scene_->ulp = static_cast<double>(largest) * 0x1p-23;
}

ExactRays::~ExactRays() = default;

bool ExactRays::occluded(Vec3d point, std::uint32_t face, Vec3d to_light) const {
    return occluded_beyond(point, face, to_light, 0);
}

bool ExactRays::occluded_beyond(Vec3d point, std::uint32_t face, Vec3d to_light, double beside_m) const {
    RayContext context;
    rtcInitIntersectContext(&context.base);
    context.base.filter = ignore_own_surface;
    context.mesh = &scene_->mesh;
    context.ulp = scene_->ulp;
    context.point = point;
    context.direction = to_light;
    context.face = face;
    context.beside_m = beside_m;
    const Vec3f origin = to_float(context.point), direction = to_float(to_light);
    RTCRay ray{};
    ray.org_x = origin.x;
    ray.org_y = origin.y;
    ray.org_z = origin.z;
    ray.dir_x = direction.x;
    ray.dir_y = direction.y;
    ray.dir_z = direction.z;
    ray.tnear = 0;
    ray.tfar = 1e30f;
    ray.mask = ~0u;
    rtcOccluded1(scene_->embree.handle(), &context.base, &ray);
    return ray.tfar < 0;  // Embree's mark of an occluded ray
}

Vec3d seen_point(const Mesh& mesh, std::uint32_t triangle, Vec3d p) {
    const Plane& plane = mesh.faces[mesh.face[triangle]];
    Vec3d at = on_plane(plane, p), corner[3];
    for (int k = 0; k < 3; ++k)
        corner[k] = on_plane(plane, to_double(mesh.positions[mesh.triangles[triangle].v[k]]));
    const Vec3d normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    // Outside of one edge: to its nearest point, which of two such edges is their corner.
    for (int k = 0; k < 3; ++k) {
        const Vec3d from = corner[k], edge = corner[(k + 1) % 3] - from;
        if (dot(normal, cross(edge, at - from)) >= 0 || dot(edge, edge) == 0) continue;
        at = from + edge * std::clamp(dot(at - from, edge) / dot(edge, edge), 0.0, 1.0);
    }
    return at;
}

std::vector<Truth> true_shadows(const ExactRays& rays, const Mesh& mesh, const VisiblePoints& points,
                                Vec3d to_light, const Exec& exec) {
    std::vector<Truth> truth(static_cast<std::size_t>(points.width) * static_cast<std::size_t>(points.height),
                             Truth::nothing);
    const Vec3f light = to_float(to_light);
    parallel_for(points.blocks.size(), exec, [&](std::size_t b) {
        const SurfaceBlock& s = points.blocks[b];
        for (int at = 0; at < block_samples; ++at) {
            if (!is_covered(s, at)) continue;
            Truth& t = truth[points.pixel(b, at)];
            t = Truth::away;
            if (!(dot(Vec3f{s.gx[at], s.gy[at], s.gz[at]}, light) > 0)) continue;
            const Vec3d p = points.eye + to_double(Vec3f{s.px[at], s.py[at], s.pz[at]});
            const std::uint32_t face = mesh.face[s.triangle[at]];
            t = rays.occluded(seen_point(mesh, s.triangle[at], p), face, to_light) ? Truth::dark : Truth::lit;
        }
    });
    return truth;
}

}  // namespace obscura
