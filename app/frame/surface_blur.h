#pragma once
// Means over the patches around a patch, level by level.

#include <vector>

#include "core/isa.h"
#include "core/vec.h"

namespace obscura {

/// A patch as means count it.
struct BlurPatch {
    Vec3d p;
    int facing = 0;  ///< which of six directions it looks most
    float area_m2 = 0;
};

/// Of every patch the mean value over those within `radius_m` that face the same way, by area, nearer ones
/// more (a grid's hat functions, twice). Sums go in the order of the patches.
std::vector<Vec3f> mean_around(const std::vector<BlurPatch>& patches, const std::vector<Vec3f>& values,
                               double radius_m);

/// Which of six directions n looks most.
int facing_of(Vec3d n);

}  // namespace obscura
