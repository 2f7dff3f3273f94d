#pragma once
// What the readers of model files have in common: polygons whose corners are indices into lists.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "core/limits.h"
#include "core/topology.h"
#include "core/vec.h"

namespace obscura {

/// A corner of a face; indices from 0, -1 = not given.
struct FaceCorner {
    std::int32_t position = -1, uv = -1, normal = -1;
    friend bool operator==(const FaceCorner&, const FaceCorner&) = default;
};

struct IndexedFace {
    std::uint32_t first_corner = 0, corner_count = 0;  ///< 3 or more, in IndexedFaces::corners
    std::int32_t material = -1;                        ///< index into material_names, -1 where none is named
    std::int32_t object = -1;                          ///< index into object_names, -1 where none is named
    std::uint32_t smoothing = smooth_by_angle;         ///< as compute_normals() takes it
    std::int32_t line = 0;
};

/// A name in the file and the line it first stands on.
struct NameInFile {
    std::string name;
    int line = 0;
};

struct IndexedFaces {
    std::vector<Vec3d> positions;  ///< in the file's own frame, each number within the range of a float
    std::vector<Vec2f> uvs;
    std::vector<Vec3f> normals;
    std::vector<FaceCorner> corners;
    std::vector<IndexedFace> faces;
    std::vector<NameInFile> material_names;  ///< each once
    std::vector<NameInFile> object_names;    ///< each once
    std::int64_t triangles = 0;              ///< that the faces will be cut into
};

/// Triangles that a file may have: corners and vertices are counted in 32 bits. Of vertices three times as
/// many, but no more than 2^31 - 1.
inline std::int64_t most_triangles(const Limits& limits) {
    return std::min<std::int64_t>(limits.triangles, 1'000'000'000);
}
inline std::int64_t most_vertices(const Limits& limits) {
    return std::min<std::int64_t>(3 * most_triangles(limits), INT32_MAX);
}

/// Faces with more corners are refused: cutting them takes time that grows with the square.
constexpr std::uint32_t most_face_corners = 10'000;

}  // namespace obscura
