// Whether a serialised tree is sound, for trees that come from outside.

#include "core/error.h"
#include "hierarchy/code_check.h"
#include "hierarchy/mh/mh.h"
#include "hierarchy/tree_units.h"

namespace obscura {

const char* mh_fault_of(const ShadowTree& tree) {
    const TreeCode& code = tree.code;
    CHECK(code.levels >= 0 && code.levels <= max_tree_levels);
    if (row_of(code.layout).layout != code.layout) return "has an unknown layout";
    if (tree.bytes % unit_bytes(code.layout) != 0) return "ends within a word";
    const std::uint64_t units = tree.bytes / unit_bytes(code.layout);
    const CodeFaults faults{"more units than lookups can name", "children lie outside the tree"};
    const auto any_kinds = [](int) { return 0xffu; };
    if (const char* fault = check_code<4>(code, code.levels, units, tree.counts, faults, any_kinds))
        return fault;
    // Counts are true now, so nothing overflows here.
    const std::uint64_t padding = byte_of_unit(code.layout, units - node_units(code.layout, tree.counts));
    return padding == tree.padding_bytes ? nullptr : "has other padding than stated";
}

}  // namespace obscura
