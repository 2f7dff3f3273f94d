#pragma once
// What lies on a lens or before it, as numbers.

#include <cstdint>

namespace obscura {

/// A circle moved over the opening.
enum class Occluder {
    none,
    housing,  ///< light passes inside it only: the barrel as seen from the side of the picture (cat's eye)
    disc,     ///< light passes outside it only
};

/// Lengths are shares of the mask's longer side. Counts and `noise` of 0: none of that kind.
struct LensDirt {
    std::int64_t seed = 1;  ///< whatever is random follows from it, every kind on its own; [0, 2^32)

    double noise = 0;            ///< smears: most amplitude they take away, [0, 1]; half of that on average
    double noise_cell = 0.1;     ///< size of the largest, [1/1024, 1]
    double noise_stretch = 1;    ///< length / width, [1, 64]
    double noise_angle_deg = 0;  ///< of the length, from x towards y

    int dust = 0;               ///< grains, [0, 10000]
    double dust_radius = 0.01;  ///< of the largest; most have a third of it, (0, 0.5]
    double dust_softness = 0;   ///< 0: hard edges, 1: fades from the centre on

    int scratches = 0;                ///< dark lines, slightly curved, [0, 10000]
    double scratch_width = 0.001;     ///< of the widest, in the middle of its length, (0, 0.1]
    double scratch_length = 0.5;      ///< of the longest, (0, 2]
    double scratch_spread_deg = 180;  ///< directions lie this far around the vertical, [0, 180]

    int eyelashes = 0;            ///< hairs that hang down from the mask's upper side, [0, 1000]
    double eyelash_width = 0.01;  ///< at the root; they taper, (0, 0.1]
    double eyelash_length = 0.6;  ///< of the longest, (0, 2]

    Occluder occluder = Occluder::none;
    double occluder_diameter = 1;           ///< (0, 4]
    double occluder_x = 0, occluder_y = 0;  ///< of its centre, from the mask's; [-2, 2]

    friend bool operator==(const LensDirt&, const LensDirt&) = default;
};

}  // namespace obscura
