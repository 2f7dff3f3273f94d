#pragma once
// A system at 1:2, 1:4 or 1:8 whose minimiser is the full one's, as nearly as its samples allow.
//
// The paper makes its smaller systems from smaller views, "via rendering or sampling" (thesis 4.3.3, 4.3.5).
// Applied to samples, an edit misses what happens between them: a sphere loses a third of its depth in the
// last pixels before its outline, so that scaling the difference of two samples, or keeping that at its
// border, asks for another shape (0.36 px rms of error at 1:8 where the change is 4 px). Here every
// reduced gradient is the sum of the full ones along the way from sample to sample, as in a chain of springs
// (0.02 px rms in the same case). The price: the full system must be built, about as much work as solving it;
// a preview that cannot wait applies edits to reduced(view) and lives with the error.

#include "core/isa.h"
#include "stereo/disparity_system.h"
#include "stereo/middle_view.h"

namespace obscura {

/// The system of reduced(view, reduction); `full` is of `view`, of full resolution.
///
/// - Values are those of the sampled pixels; gradients sum the changes of gradient on the way between
///   them (a pair with an invalid pixel adds none). An unedited system gives an unedited one.
/// - A sample's anchor is the sum of its object's in its block; epsilon and the sets' weights grow by the
///   area. Squared differences of a smooth map are the same at every scale.
/// - Sets keep the members that were sampled; their source moves to the nearest sample of its object. Sets
///   without sampled members are left out. A source that nothing else holds gives way less, by ln(n) / (4 pi
///   c1) per unit of pull, for it is a larger pixel: where a set draws a free source far, its members follow
///   farther than in the full solution.
DisparitySystem reduced_system(const DisparitySystem& full, const MiddleView& view, int reduction,
                               const Exec& exec);

}  // namespace obscura
