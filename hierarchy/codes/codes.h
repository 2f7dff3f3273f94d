#pragma once
// The codes: ways to write a tree of depths, one row each.
//
// A code has four verbs: encode, look up in lanes, check what a file holds, describe itself. Four are here;
// looking up is inlined into kernels, so its row stands in tree_step.h and tree_lanes.h. A new
// code is a folder beside mh/ and mmh/, a number and a name in tree_code.h, a row here and one there.

#include <atomic>
#include <cstdint>
#include <string>

#include "core/mesh.h"
#include "core/types.h"
#include "hierarchy/build.h"
#include "hierarchy/encode_params.h"
#include "hierarchy/multires.h"
#include "hierarchy/shadow_tree.h"

namespace obscura {

struct ShadowCodeRow {
    ShadowCode code;
    bool wants_intervals;  ///< MultiresTree::intervals must be there: see BuildParams::keep_intervals
    std::int64_t node_construction_bytes;  ///< that one node takes at most, until its bytes are written
    ShadowTree (*encode)(const MultiresTree& tree, const LightView& view, const EncodeParams& params);
    /// What is wrong with a tree from outside, or null: then no lookup leaves its bytes or finds other than
    /// depths in [0, 1].
    const char* (*fault_of)(const ShadowTree& tree);
    std::string (*text)(const ShadowTree& tree);  ///< one line on what it came to
    /// Codes that hold more than depths are made from the mesh itself; null: from the tree of depths. Without
    /// top grid; params.needed must be null.
    ShadowTree (*from_mesh)(const Mesh& mesh, const LightView& view, const BuildParams& params,
                            const EncodeParams& encode, BuildStats* stats,
                            const std::atomic<bool>* cancel) = nullptr;
};

extern const ShadowCodeRow shadow_codes[shadow_code_count];

/// Null: no such code.
const ShadowCodeRow* find_code(ShadowCode code);
/// Of a code that is one.
const ShadowCodeRow& row_of(ShadowCode code);

/// Serialises a quadtree in params.code, with its top grid. Equal trees give equal bytes, for any exec.
/// LimitError when it takes more than params.max_units. Codes that want intervals CHECK that they are there.
ShadowTree encode_tree(const MultiresTree& tree, const LightView& view, const EncodeParams& params = {});

/// Whether a tree that is all of a map is made from the mesh.
inline bool is_from_mesh(const ShadowCodeRow& row, const BuildParams& params) {
    return row.from_mesh != nullptr && params.needed == nullptr;
}

}  // namespace obscura
