#pragma once
// The code facet: leaves that hold a plane, a depth, or an edge with either of them on each side.

#include <atomic>
#include <cstdint>
#include <string>

#include "core/isa.h"
#include "core/mesh.h"
#include "core/types.h"
#include "hierarchy/build.h"
#include "hierarchy/encode_params.h"
#include "hierarchy/facet/facet_tree.h"
#include "hierarchy/multires.h"
#include "hierarchy/shadow_tree.h"

namespace obscura {

/// The tree of `mesh` seen from `view` (square, a power of two in [1, 2^20] a side). Every texel's depth lies
/// in its interval; the same tree for any exec. params.needed must be null; params.max_nodes counts what
/// threads make. When `cancel` is set meanwhile, the result has no meaning.
FacetTree build_facet_tree(const Mesh& mesh, const LightView& view, const BuildParams& params,
                           const Exec& exec, BuildStats* stats = nullptr,
                           const std::atomic<bool>* cancel = nullptr);

/// Serialises it, without the top grid. LimitError when it takes more than params.max_units words. Of
/// more than 2^20 planes the later ones are stored as depths.
ShadowTree encode_facet(const FacetTree& tree, const LightView& view, const EncodeParams& params);

/// Both, on encode.exec. A cancelled tree has no bytes.
ShadowTree facet_from_mesh(const Mesh& mesh, const LightView& view, const BuildParams& params,
                           const EncodeParams& encode, BuildStats* stats, const std::atomic<bool>* cancel);

/// The same of a tree of depths alone, which then has no planes and edges.
ShadowTree encode_facet(const MultiresTree& tree, const LightView& view, const EncodeParams& params);

/// What is wrong with a tree from outside, or null: as mh_fault_of(); every edge and plane that a value names
/// is there, whole numbers are whole, and what planes come to is a depth. O(words).
const char* facet_fault_of(const ShadowTree& tree);

struct FacetStats {
    std::uint64_t node_words = 0, edges = 0, planes = 0;
};
FacetStats facet_stats(const ShadowTree& tree);

/// "184320 bytes of nodes, 2011 edges, 845 planes"
std::string facet_text(const ShadowTree& tree);

/// A node while trees are made, as its thread's part and joined, and its bytes.
constexpr std::int64_t facet_construction_bytes =
    2 * std::int64_t{sizeof(FacetNode)} + std::int64_t{sizeof(FacetEdge)} + 8 + 12;

}  // namespace obscura
