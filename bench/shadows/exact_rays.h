#pragma once
// Whether light reaches a point: a ray through the triangles themselves, the truth that shadow maps
// approximate. Built only with Embree (OBSCURA_HAS_EMBREE).

#include <cstdint>
#include <memory>
#include <vector>

#include "bench/shadows/visible_points.h"
#include "core/mesh.h"

namespace obscura {

/// Rays against a mesh with topology. Candidates come from Embree (robust traversal, float). A ray never
/// meets the planar face it starts on. A hit nearer than 1024 units in the last place of the largest
/// coordinate is judged again, in double, by the plane of the face hit: within 8 units, about how far stored
/// corners lie from where they are meant, it is the receiver's own surface (a neighbour, or a doubled face).
class ExactRays {
  public:
    explicit ExactRays(const Mesh& mesh);
    ~ExactRays();
    ExactRays(const ExactRays&) = delete;
    ExactRays& operator=(const ExactRays&) = delete;

    /// Whether anything but `face` lies between `point` and a light in unit direction `to_light`.
    bool occluded(Vec3d point, std::uint32_t face, Vec3d to_light) const;

    /// The same, but for faces whose planes pass within `beside_m` of the point.
    bool occluded_beyond(Vec3d point, std::uint32_t face, Vec3d to_light, double beside_m) const;

  private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

/// The point of a plane that is nearest to p: float positions of pixels, put back onto what they see.
inline Vec3d on_plane(const Plane& plane, Vec3d p) {
    return p - plane.n * (dot(plane.n, p) + plane.d);
}

/// The point of a triangle that is nearest to p, of those on its face's plane: a pixel's position is a float,
/// and up to 1/256 pixel beside the triangle that it shows.
Vec3d seen_point(const Mesh& mesh, std::uint32_t triangle, Vec3d p);

/// What is so at a pixel.
enum class Truth : std::uint8_t {
    nothing,  ///< sees no surface
    away,     ///< the surface faces away from the light
    dark,
    lit,
};

/// Truth of every pixel, row by row.
std::vector<Truth> true_shadows(const ExactRays& rays, const Mesh& mesh, const VisiblePoints& points,
                                Vec3d to_light, const Exec& exec);

}  // namespace obscura
