#pragma once
// The text of a Wavefront OBJ file as checked arrays. Nothing here is looked up or opened yet.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/scene.h"

namespace obscura {

/// A corner of a face; indices from 0, -1 = not given.
struct ObjCorner {
    std::int32_t position = -1, uv = -1, normal = -1;
    friend bool operator==(const ObjCorner&, const ObjCorner&) = default;
};

struct ObjFace {
    std::uint32_t first_corner = 0, corner_count = 0;  ///< 3 or more, in ObjText::corners
    std::int32_t material = -1;                        ///< index into material_names, -1 before any usemtl
    std::int32_t object = -1;                          ///< index into object_names, -1 before any o
    std::uint32_t smoothing = 0;                       ///< as compute_normals() takes it
    std::int32_t line = 0;
};

/// A name in the text and the line it first stands on.
struct ObjName {
    std::string name;
    int line = 0;
};

/// Something in the text that the mesh does without.
struct ObjSkipped {
    std::string what;
    int line = 0;  ///< where it first stands
    std::size_t count = 0;
};

struct ObjText {
    std::vector<Vec3d> positions;  ///< in the file's own frame, each number within the range of a float
    std::vector<Vec2f> uvs;
    std::vector<Vec3f> normals;
    std::vector<ObjCorner> corners;
    std::vector<ObjFace> faces;
    std::vector<ObjName> material_names;  ///< usemtl, each once
    std::vector<ObjName> libraries;       ///< mtllib lines, the whole rest of the line
    std::vector<ObjName> object_names;    ///< o, each once; g where the file has no o at all
    std::vector<ObjSkipped> skipped;      ///< statements and numbers that are not obeyed, each kind once
    std::int64_t triangles = 0;           ///< that the faces will be cut into
};

/// Reads v, vt, vn, f, o, g, s, usemtl and mtllib; points, lines, display attributes and curves' parameters
/// are noted in ObjText::skipped; free-form surfaces, calls and unknown keywords are errors, as is everything
/// that is not exactly a number or an index of an existing element (relative indices count back from the
/// face's own line, positive ones may point ahead). `file` names the text in messages. Throws InputError with
/// the line; LimitError beyond limits.triangles triangles or three times as many vertices of a kind, before
/// they are stored.
ObjText parse_obj_text(std::string_view text, const std::string& file, const Limits& limits);

/// Faces with more corners are refused: cutting them takes time that grows with the square.
constexpr std::uint32_t most_face_corners = 10'000;

}  // namespace obscura
