#pragma once
// The parts of a system that have nothing to do with each other: islands of valid pixels that no gradient and
// no matching set connects, as leaves before a sky or what is left of a measured map. Each has its own
// constant to find, which a coarse cell that several share cannot hold, so each is solved by itself.

#include "core/isa.h"
#include "stereo/disparity_system.h"

namespace obscura {

struct SystemPart {
    std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< bounding box, half open
    std::int64_t pixels = 0;
    std::uint32_t label = 0;
};

struct SystemParts {
    std::vector<SystemPart> parts;  ///< most pixels first, then by place
    Image<std::uint32_t> label;     ///< which one a pixel belongs to; any value where not valid
};

/// One part without labels when every pixel is valid.
SystemParts system_parts(const DisparitySystem& system);

/// The system of one part alone, its bounding box large.
DisparitySystem part_system(const DisparitySystem& system, const SystemParts& parts, const SystemPart& part);

/// Most pixels of a part that minimise_part() takes.
constexpr std::int64_t small_part = 96;

/// Replaces x of a small part by the minimiser, exactly: a dense factorisation in double.
void minimise_part(const DisparitySystem& system, const SystemParts& parts, const SystemPart& part,
                   DisparityMap& x);

}  // namespace obscura
