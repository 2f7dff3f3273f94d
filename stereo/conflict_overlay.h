#pragma once
// A picture of where an edited map is in conflict: the middle view, dimmed, with the conflicts drawn on it.

#include "core/image.h"
#include "core/vec.h"
#include "stereo/conflict.h"

namespace obscura {

/// Linear light. Four colours that also colour-blind viewers tell apart, of Okabe and Ito, "Color Universal
/// Design", 2008: vermilion inversions, blue window violations, yellow comfort, bluish green folds.
Vec3f conflict_colour(ConflictKind kind);

/// `beauty` is the picture without margins, display-referred linear light in [0, 1]; the result is too.
/// Conflicts between neighbours (inversions, folds) are drawn as solid lines a few pixels wide, those of
/// surfaces as stripes: window violations rising to the right, comfort falling. `conflict_pixels` is of the
/// view's size, as in EditedSystem and Conflicts.
Image<Vec3f> conflict_overlay(const Image<Vec3f>& beauty, const MiddleView& view,
                              const Image<std::uint8_t>& conflict_pixels);

}  // namespace obscura
