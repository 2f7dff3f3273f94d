#include "hierarchy/codes/codes.h"

#include "core/error.h"
#include "hierarchy/build_memory.h"
#include "hierarchy/codes/decode.h"
#include "hierarchy/dag/dag.h"
#include "hierarchy/facet/facet.h"
#include "hierarchy/mh/mh.h"
#include "hierarchy/mmh/mmh.h"

namespace obscura {

const ShadowCodeRow shadow_codes[shadow_code_count] = {
    {ShadowCode::mh, false, node_construction_bytes, encode_mh, mh_fault_of, mh_text},
    {ShadowCode::mmh, true, mmh_construction_bytes, encode_mmh, mmh_fault_of, mmh_text},
    {ShadowCode::dag, true, dag_construction_bytes, encode_dag, dag_fault_of, dag_text},
    {ShadowCode::facet, false, facet_construction_bytes, encode_facet, facet_fault_of, facet_text,
     facet_from_mesh},
};

const ShadowCodeRow* find_code(ShadowCode code) {
    for (const ShadowCodeRow& row : shadow_codes) {
        if (row.code == code) return &row;
    }
    return nullptr;
}

const ShadowCodeRow& row_of(ShadowCode code) {
    const ShadowCodeRow* row = find_code(code);
    CHECK(row != nullptr);
    return *row;
}

ShadowTree encode_tree(const MultiresTree& tree, const LightView& view, const EncodeParams& params) {
    ShadowTree result = row_of(params.code).encode(tree, view, params);
    set_top_grid(result, params.top_levels);
    return result;
}

}  // namespace obscura
