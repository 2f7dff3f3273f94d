#pragma once
// Edits as tests write them.

#include <utility>
#include <vector>

#include "stereo/edit.h"

namespace obscura {

/// Conflicts are left alone: only what edits write is seen.
inline EditParams plain() {
    EditParams p;
    p.comfort_weight = p.window_weight = 0;
    p.reset_inversions = p.limit_folds = false;
    return p;
}

inline StereoEdit roundness(std::vector<std::uint32_t> objects, double factor, double weight = 1) {
    return {"round", weight, RoundnessEdit{{std::move(objects), {}}, factor}};
}
inline StereoEdit anchor(std::vector<std::uint32_t> objects, double offset_px, double weight = 1) {
    return {"anchor", weight, AnchorEdit{{std::move(objects), {}}, offset_px}};
}

}  // namespace obscura
