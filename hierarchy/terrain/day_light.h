#pragma once
// How much of the sun every sample of the ground sees, at a time and over a day.

#include <span>

#include "core/image.h"
#include "core/isa.h"
#include "hierarchy/terrain/far_day.h"

namespace obscura {

/// Share of a sun's disc that each sample sees, in [0, 1]. disc_radius_deg = 0: 0 or 1, by the exact shadow
/// of the sun's middle. Else lit_share_of_disc() above the ground's horizon in the sun's direction, taken as
/// level over the disc's width; time then grows with the length of rays.
Image<float> lit_shares(const HeightField& field, const FarSun& sun, double disc_radius_deg,
                        const Exec& exec);

/// Hours of sun of every sample: the sum, in their order, of FarSun::hours of the suns times their
/// lit_shares().
Image<float> lit_hours(const HeightField& field, std::span<const FarSun> suns, double disc_radius_deg,
                       const Exec& exec, const FarDayWatch& watch = {});

}  // namespace obscura
