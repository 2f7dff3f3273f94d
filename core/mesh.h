#pragma once
// Triangle meshes: plain arrays, in metres.

#include <cstdint>
#include <string>
#include <vector>

#include "core/vec.h"

namespace obscura {

/// Vertex indices, counter-clockwise seen from outside.
struct Triangle {
    std::uint32_t v[3] = {0, 0, 0};
    friend bool operator==(const Triangle&, const Triangle&) = default;
};

/// A connected part of a mesh. Closed: a solid, every edge is walked as often one way as the other.
struct Component {
    bool closed = false;
    bool balanced_multi_edges = false;  ///< closed, though some edge carries more than two triangles
    std::uint32_t triangles = 0;
    std::uint32_t open_edges = 0;  ///< directed edges without a partner
};

/// Plane n . p + d = 0 with a unit normal that points to the side the triangle is counter-clockwise from.
struct Plane {
    Vec3d n;
    double d = 0;
};

/// An object that a scene, a picture (AOV) or a stereo edit can name.
struct Object {
    std::string name;
    bool casts_shadow = true;
};

/// Triangles with everything that rasterizing and shading need. Arrays per vertex have positions.size()
/// entries, arrays per triangle triangles.size(). `uvs` may be empty. The part below the line is derived by
/// analyse_topology() (core/topology.h).
struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;  ///< unit length
    std::vector<Vec2f> uvs;      ///< (0,0) is the lower left corner of a texture
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> material;  ///< per triangle, index into the scene's materials
    std::vector<std::uint32_t> object;    ///< per triangle, index into `objects`
    std::vector<Object> objects;
    // ---
    std::vector<std::uint32_t> component;  ///< per triangle
    std::vector<Component> components;
    std::vector<std::uint32_t> face;  ///< per triangle: triangles of one planar face share one plane
    std::vector<Plane> faces;
};

}  // namespace obscura
