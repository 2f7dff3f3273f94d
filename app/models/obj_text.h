#pragma once
// The text of a Wavefront OBJ file as checked arrays. Nothing here is looked up or opened yet.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/models/indexed_faces.h"
#include "core/limits.h"

namespace obscura {

/// Something in the text that the mesh does without.
struct ObjSkipped {
    std::string what;
    int line = 0;  ///< where it first stands
    std::size_t count = 0;
};

struct ObjText : IndexedFaces {
    std::vector<NameInFile> libraries;  ///< mtllib lines, the whole rest of the line
    std::vector<ObjSkipped> skipped;    ///< statements and numbers that are not obeyed, each kind once
};

/// Reads v, vt, vn, f, o, g, s, usemtl and mtllib; points, lines, display attributes and curves' parameters
/// are noted in ObjText::skipped; free-form surfaces, calls and unknown keywords are errors, as is everything
/// that is not exactly a number or an index of an existing element (relative indices count back from the
/// face's own line, positive ones may point ahead). `file` names the text in messages. Throws InputError with
/// the line; LimitError beyond limits.triangles triangles or three times as many vertices of a kind, before
/// they are stored.
ObjText parse_obj_text(std::string_view text, const std::string& file, const Limits& limits);

}  // namespace obscura
