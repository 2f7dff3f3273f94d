#include "hierarchy/stack/stack_check.h"

#include "core/error.h"
#include "hierarchy/code_check.h"
#include "hierarchy/stack/stack_units.h"

namespace obscura {

const char* fault_of(const StackShape& shape) {
    if (shape.map_levels < 0 || shape.map_levels > max_tree_levels) return "too many texels a side";
    if (shape.slice_levels < 0 || shape.slice_levels > max_slice_levels) return "too many maps";
    if (shape.anisotropy < -shape.slice_levels || shape.anisotropy > shape.map_levels)
        return "an anisotropy that its maps have no room for";
    return shape.levels() > max_tree_levels ? "too many levels" : nullptr;
}

const char* fault_of(const StackCode& code, std::uint64_t words, const MultiresCounts& counts) {
    CHECK(fault_of(code.shape) == nullptr);
    const CodeFaults faults{"more words than lookups can name", "children lie outside the octree"};
    const auto possible = [&](int height) {
        std::uint32_t kinds = 0xffff;
        if (!code.shape.divides_map(height)) kinds &= 0x0303;
        if (!code.shape.divides_slices(height)) kinds &= 0x00ff;
        return kinds;
    };
    return check_code<8>(code, code.shape.levels(), words, counts, faults, possible);
}

}  // namespace obscura
