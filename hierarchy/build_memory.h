#pragma once
// What build_shadow_tree() and encode_tree() take.

#include <cstdint>

#include "hierarchy/facets.h"
#include "hierarchy/multires.h"
#include "raster/setup_memory.h"

namespace obscura {

/// A node while trees are made: as its thread's part, and joined; then joined, and serialised.
constexpr std::int64_t node_construction_bytes = 2 * std::int64_t{sizeof(MultiresNode)} + 8;
/// Serialised: a leaf or an empty node takes 4 bytes, a full one 8.
constexpr std::int64_t node_bytes = 6;

/// Bytes of one tree under construction, without its nodes: the setup of the view and a facet for every
/// triangle, and what squares on the way down list of them. A facet stands in the lists of several squares:
/// 3 to 13 in the scenes measured, the most where a field of small facets is cut as a whole.
constexpr std::int64_t construction_bytes(const MeshSize& mesh) {
    constexpr std::int64_t lists = 6;
    return setup_bytes(mesh) + mesh.triangles * std::int64_t{sizeof(Facet) + lists * sizeof(Listed)};
}

}  // namespace obscura
