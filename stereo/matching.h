#pragma once
// Matching points (thesis 4.4): pixels that follow the disparity of a source.

#include <optional>
#include <string>

#include "stereo/edit.h"

namespace obscura {

/// The set of one edit, without c3: its weight is the edit's own. Nothing, and a reason in `why_not`, when
/// the source or the destination is beyond the map or on nothing, or when both are one pixel.
std::optional<MatchingSet> matching_set(const MiddleView& view, const Image<std::uint8_t>& valid,
                                        const StereoEdit& edit, std::string& why_not);

}  // namespace obscura
