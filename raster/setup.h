#pragma once
// From a mesh to triangle records: transform, snap, clip, turn, depth planes.

#include <cstdint>
#include <vector>

#include "core/buffer.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "core/types.h"
#include "raster/map_vertex.h"
#include "raster/record.h"

namespace obscura {

/// Faces that are left out: none, or all that face away. Pictures leave out none: even of closed components a
/// back may be the nearest surface, where a solid is cut open by the near plane or turns itself inside out.
enum class Culling { none, back_faces };

/// Which triangles become records.
struct SetupParams {
    bool only_casters = false;  ///< leave out objects that cast no shadow
    Culling culling = Culling::none;
    bool pair_faces = false;  ///< mark pairs (see TriangleRecord), for loops that need not know the triangle;
                              ///< lists of records then name only the first of a pair, as bin_records() does
    Region region = {};  ///< leave out what lies outside these texels, up to 2^16 past the view; empty = it
    bool centre_samples_only = true;  ///< leave out what lies between texel centres (single-sample maps)
    bool keep_flat = false;           ///< also what is seen along its plane, and covers nothing
    bool depth_planes = true;         ///< else records have none, and in zmin and zmax the depths of their
                               ///< triangle's nearest and farthest corner (any that the view has, before the
                               ///< near plane): for who asks for coverage alone
};

/// Depth over one planar face: float(a X + (b Y + c)), clamped to [zmin, zmax].
struct DepthPlane {
    double a = 0, b = 0, c = 0;
    float zmin = 0, zmax = 0;
};

/// A run of valid records.
struct RecordBlock {
    std::size_t begin = 0, count = 0;
};

/// Records in ascending order of triangle, in blocks with gaps between them. A clipped triangle may give
/// several records, or none. Reuse the struct for the next view: its buffers are kept.
struct TriangleSetup {
    Buffer<TriangleRecord> records;
    std::vector<RecordBlock> blocks;
    // Stages before the records, kept for reuse and for lessons.
    Buffer<MapVertex> vertices;                ///< per mesh vertex
    Buffer<DepthPlane> planes;                 ///< per planar face
    Buffer<std::int32_t> face_low, face_high;  ///< depth range per scattered face, ordered integers
};

/// Fills `setup` with every triangle of `mesh` that `view` can see. The mesh needs its topology
/// (analyse_topology); views of up to 2^20 texels a side. The same records for any exec.
void setup_triangles(const Mesh& mesh, const View& view, const SetupParams& params, const Exec& exec,
                     TriangleSetup& setup);

/// The plane n . p + d = 0 as depth over map positions, before clamping. A plane that the viewer sees edge-on
/// has no such form: it becomes constant, in the middle of its range.
DepthPlane depth_plane(const Plane& world, const Mat4& from_map, float zmin, float zmax);

}  // namespace obscura
