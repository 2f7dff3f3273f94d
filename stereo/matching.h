#pragma once
// Matching points (thesis 4.4): pixels that follow the disparity of a source.

#include <optional>
#include <string>
#include <vector>

#include "stereo/edit.h"

namespace obscura {

/// The set of one edit, without c3: its weight is the edit's own. Nothing, and a reason in `why_not`, when
/// the source or the destination is beyond the map or on nothing, or when both are one pixel.
std::optional<MatchingSet> matching_set(const MiddleView& view, const Image<std::uint8_t>& valid,
                                        const StereoEdit& edit, std::string& why_not);

/// The set that holds what is around the edit's source to it (MatchEdit::hold_source) as it stands in
/// `edited`, which is D~: its object or the disc of the edit's radius, less what follows the destination.
/// Nothing when the edit does not ask for it, or where matching_set() gives nothing.
std::optional<MatchingSet> held_source(const MiddleView& view, const Image<std::uint8_t>& valid,
                                       const DisparityMap& edited, const StereoEdit& edit);

/// The sets of all match edits among `edits`, in their order; a notice for each that comes to none.
std::vector<MatchingSet> matching_sets(const MiddleView& view, const Image<std::uint8_t>& valid,
                                       const std::vector<const StereoEdit*>& edits,
                                       std::vector<EditNotice>& notices);

/// Adds held_source() of all match edits.
void hold_sources(const MiddleView& view, const Image<std::uint8_t>& valid, const DisparityMap& edited,
                  const std::vector<const StereoEdit*>& edits, std::vector<MatchingSet>& sets);

/// Brings members in D~ to where their sets want them, faded in by weight up to 1. The thesis leaves D~
/// as 4.3 has it; but then gradients from D~ at the members' outline hold all of them where they were, and it
/// is the lone source pixel that gives way, as a spike. Sources that are members of other sets count as they
/// were.
void move_members(const std::vector<MatchingSet>& sets, DisparityMap& edited);

}  // namespace obscura
