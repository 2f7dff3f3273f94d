#pragma once
// What can lie on a lens, one row per parameter: a key of [optics] and a flag of `obscura diffraction`.

#include <string>
#include <variant>
#include <vector>

#include "app/scene/key_row.h"
#include "optics/lens_dirt.h"

namespace obscura {

inline constexpr Word<Occluder> occluder_words[] = {
    {"none", Occluder::none}, {"housing", Occluder::housing}, {"disc", Occluder::disc}};

struct DirtRow {
    std::variant<double LensDirt::*, int LensDirt::*, std::int64_t LensDirt::*, Occluder LensDirt::*> member;
    KeyRow<LensDirt> row;  ///< with the default
    // The flag is --NAME, with dashes.
    const char* flag_value;  ///< what stands for its value in the help
    const char* flag_doc;
};

const std::vector<DirtRow>& dirt_rows();

}  // namespace obscura
