#pragma once
// Our OBJ reader beside tinyobjloader: what we accept, both must read alike.

#include <string>
#include <string_view>

#include "core/limits.h"
#include "core/scene.h"
#include "tests/fuzz/obj_dialect.h"

namespace obscura {

enum class Feed {
    translated,  ///< in the library's words (obj_dialect.h)
    raw          ///< as the file stands: for texts that the library is known to survive
};

struct PeerResult {
    std::string difference;  ///< the first one; empty where the readers agree or are not compared
    Quirks quirks;
    bool compared = true;
    std::size_t triangles = 0;
};

/// Reads an OBJ text, every mtllib meaning `mtl`, with obj_from_text() and throws what that throws. Accepted
/// texts go to tinyobjloader, with triangulate = false. Positions, texture coordinates and normals must agree
/// within an ulp, one by one, used or not; faces corner by corner; the triangles are then those of the
/// library's polygons, cut by our own triangulate_polygon() (the library cuts concave polygons wrongly), bit
/// by bit. Materials: name, map_Kd and what load_obj() makes of Kd, Ks, Ke, Ns, Pr and Pm within an ulp.
PeerResult read_by_both(std::string_view obj, std::string_view mtl, const Limits& limits,
                        Feed feed = Feed::translated);

}  // namespace obscura
