#pragma once
// What the readers of model files have in common: polygons whose corners are indices into lists.

#include <cstdint>
#include <string>
#include <vector>

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
    std::uint32_t smoothing = 0;                       ///< as compute_normals() takes it
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

/// Faces with more corners are refused: cutting them takes time that grows with the square.
constexpr std::uint32_t most_face_corners = 10'000;

}  // namespace obscura
