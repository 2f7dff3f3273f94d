#pragma once
// Which parts of a mesh are solids, which triangles lie on one plane, and normals where a file brings none.

#include <cstdint>
#include <span>

#include "core/mesh.h"

namespace obscura {

/// What analyse_topology() saw on the way. Edges are counted without direction, once as the vertex ids say
/// and once with equal positions of the whole mesh merged; triangles that repeat a corner have no edges.
struct TopologyReport {
    struct Edges {
        std::uint32_t open = 0;   ///< walked more often one way than the other
        std::uint32_t multi = 0;  ///< with more than two triangles
    };
    Edges by_index, welded;
    std::uint32_t degenerate_triangles = 0;  ///< see is_degenerate() in core/edges.h
};

/// Fills component, components, face and faces. positions, triangles and, when present, object are read.
/// `vertex_ids` (one per vertex, below 2^32 - 1; empty = the vertex numbers) says which vertices are one
/// point of the source, so that vertices split for normals or texture coordinates stay one.
///
/// Policy. A component is a set of triangles that hang together by edges; it is closed when each of its edges
/// is walked as often one way as the other. Vertices are merged step by step, and what is closed at one step
/// is never looked at again, so that a solid stays closed whatever touches it:
///   1. equal vertex ids;  2. among what is still open, equal positions within one object;
///   3. among what is still open, equal positions.
/// At each step, two triangles at an edge of two hang together. At an edge of more, the parts connected so
/// far hang together only if they do not balance there by themselves: a fin on a cube stays a part of its
/// own, back-to-back sheets become one. Such an edge in a closed component sets balanced_multi_edges.
/// Degenerate triangles stay in the mesh (the rasterizer covers nothing with them) and count as any other:
/// their edges keep a solid closed. Those that repeat a corner join the component at their edge, if there is
/// one. Components are numbered by their first triangle. O(n log n). Faces: see core/planar_faces.h.
TopologyReport analyse_topology(Mesh& mesh, std::span<const std::uint32_t> vertex_ids = {});

/// Volume inside a component, in cubic metres; negative when it is inside out. Meaningful for closed ones.
/// One entry per component.
std::vector<double> signed_volumes(const Mesh& mesh);

/// Smoothing of a triangle's edges, in `smoothing_groups` of compute_normals().
constexpr std::uint32_t smooth_none = 0;  ///< flat: `s off`
constexpr std::uint32_t smooth_by_angle =
    UINT32_MAX;  ///< smooth up to the crease angle; any other value: smooth
                 ///< with the neighbours of the same group, whatever the angle

/// Gives every vertex without a normal (no `normals`, or a zero entry) the angle-weighted mean of the
/// triangles around it (Thurmer and Wuthrich, Computing vertex normals from polygonal facets, 1998), and
/// splits vertices where two triangles meet at more than crease_angle_deg in [0, 180]. Triangles are
/// neighbours when they share an edge by position, walk it in opposite directions and, where components are
/// known, belong to one. Degenerate triangles smooth nothing: they take the normal of a neighbour corner, or
/// +Y. Triangles keep their order and corners, new vertices are appended, vertices keep their uvs; unit
/// length. `smoothing_groups`: per triangle, empty = by angle. The result depends on the order of triangles
/// only in the numbering of vertices and the last bits of the sums.
void compute_normals(Mesh& mesh, double crease_angle_deg,
                     std::span<const std::uint32_t> smoothing_groups = {});

/// Appends `part` to `to`: vertices, objects, components and faces are renumbered, materials are the scene's
/// and stay. Missing normals and uvs are filled with zeros where the other side has some, missing materials
/// and objects with 0 (and an object is added if `part` names none). Either both sides have been analysed, or
/// neither; an empty `to` takes what `part` has.
void append_mesh(Mesh& to, const Mesh& part);

}  // namespace obscura
