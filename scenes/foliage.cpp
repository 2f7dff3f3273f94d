#include "scenes/foliage.h"

#include <cmath>

#include "scenes/build.h"

namespace obscura {

void add_leaf(Mesh& mesh, Vec3d at, Vec3d along, Vec3d up, double length_m, std::uint32_t material) {
    const Vec3d across = normalize(cross(along, up), Vec3d{1, 0, 0});
    const Vec3d top = cross(across, along);
    // The blade's edges stand a little above the line base - tip: a shallow V, as thick as a leaf can be
    // drawn.
    const Vec3d tip = at + along * length_m - top * (0.035 * length_m);
    const Vec3d middle = at + along * (0.45 * length_m) + top * (0.04 * length_m);
    const Vec3d right = middle + across * (0.27 * length_m), left = middle - across * (0.27 * length_m);
    add_facet(mesh, {left, right, tip}, material);  // upper half towards the tip
    add_facet(mesh, {right, left, at}, material);   // upper half towards the base
    add_facet(mesh, {at, tip, right}, material);    // under sides, which meet in the midrib
    add_facet(mesh, {tip, at, left}, material);
}

Vec3d random_direction(Random& random) {
    const double y = random.range(-1, 1), turns = random.uniform();
    const double r = std::sqrt(1 - y * y);
    const Vec2d c = on_circle(turns);
    return {r * c.x, y, r * c.y};
}

}  // namespace obscura
