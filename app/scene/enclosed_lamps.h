#pragma once
// Lamps that stand in the inside of a solid, whose light ends at its walls.

#include <string>
#include <vector>

#include "app/scene/scene.h"

namespace obscura {

/// A line for each light with a position and shadows that is inside an object that casts them. Inside: the
/// object's closed components turn once around the light, as A. van Oosterom and J. Strackee, "The Solid
/// Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 30 (1983), equation 8, counts them; so a lamp in the
/// hollow of a thick shell, which is meant to be there, or on a wall is in none, and a surface that shines is
/// not in its own object. Of several objects the smallest one.
std::vector<std::string> enclosed_lamp_notes(const Scene& scene);

}  // namespace obscura
