#pragma once
// Pixels sorted by what an edit can tell apart: their object and material. There are few such classes, so
// whatever an edit is about is settled per class, and per pixel one look-up is left.

#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "stereo/edit.h"
#include "stereo/middle_view.h"

namespace obscura {

constexpr std::uint32_t no_class = 0xffffffffu;

struct PixelClass {
    std::uint32_t object = nothing_seen, material = nothing_seen;
    // NOLINTNEXTLINE(modernize-use-nullptr): the compiler's own comparisons with 0
    friend auto operator<=>(const PixelClass&, const PixelClass&) = default;
};

struct ClassMap {
    std::vector<PixelClass> classes;  ///< ascending, each seen by at least one valid pixel
    Image<std::uint32_t> of;          ///< index into classes; no_class where not valid
};

ClassMap classify(const MiddleView& view, const Image<std::uint8_t>& valid, const Exec& exec);

/// Per class 1 where its object or its material is in the target. All 0 for an empty target.
std::vector<std::uint8_t> covered_classes(const ClassMap& map, const EditTarget& target);

/// Mean of the middle half of the values: of those with at least a quarter of all (rounded down) below and
/// above. Not empty; reordered. Sums in steps of 2^-20 within +-1e5, so the order of values leaves no trace.
double interquartile_mean(std::vector<float>& values);

/// D_m of each group of classes: the interquartile mean of the disparities of all its pixels.
std::vector<double> centres(const ClassMap& map, const DisparityMap& disparity,
                            const std::vector<std::vector<std::uint32_t>>& groups);

}  // namespace obscura
