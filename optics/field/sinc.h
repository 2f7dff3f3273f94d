#pragma once
// The transform of an interval of width 1, in double; sinc() of phasor_scalar.h is its float twin.

#include <cmath>

#include "core/num.h"

namespace obscura {

/// sin(pi t) / (pi t), of any t: the sine's argument is reduced first.
inline double sinc_in_double(double t) {
    const double angle = num::pi * (t - 2 * std::floor(t / 2 + 0.5));
    return t == 0 ? 1 : num::sin(angle) / (num::pi * t);
}

}  // namespace obscura
