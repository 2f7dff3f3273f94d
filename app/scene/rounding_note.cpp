#include "app/scene/rounding_note.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/edges.h"

namespace obscura {
namespace {

/// How a mesh bears the rounding of its corners to floats where it stands.
struct Rounding {
    float step = 0;                         ///< of a float at the mesh's farthest coordinate
    std::size_t collapsed = 0, coarse = 0;  ///< triangles without an area now; with an edge of a few steps
};

/// `made` may be null when no triangle was flat there.
Rounding rounding_of(const Mesh* made, const Mesh& placed) {
    constexpr float few_steps = 4;
    float farthest = 0;
    for (const Vec3f p : placed.positions)
        farthest = std::max({farthest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    Rounding r;
    r.step = std::nextafter(farthest, 2 * farthest + 1) - farthest;
    const auto corner = [](const Mesh& mesh, std::size_t t, std::size_t k) {
        return mesh.positions[mesh.triangles[t].v[k % 3]];
    };
    const auto flat = [&](const Mesh& mesh, std::size_t t) {
        return is_degenerate(corner(mesh, t, 0), corner(mesh, t, 1), corner(mesh, t, 2));
    };
    for (std::size_t t = 0; t < placed.triangles.size(); ++t) {
        bool coarse = false;
        for (std::size_t k = 0; k < 3; ++k)
            coarse |= length(corner(placed, t, k + 1) - corner(placed, t, k)) < few_steps * r.step;
        if (!coarse || (made != nullptr && flat(*made, t))) continue;
        ++(flat(placed, t) ? r.collapsed : r.coarse);
    }
    return r;
}

}  // namespace

std::string rounding_note(const std::string& whose, const Mesh* made, const Mesh& placed) {
    const std::size_t count = placed.triangles.size();
    const Rounding r = rounding_of(made, placed);
    // A scan has slivers that rounding costs wherever it stands.
    if (1000 * r.collapsed <= count && 10 * r.coarse <= count) return {};
    return fmt::format(
        "{}: single precision has steps of {:.3g} m where it stands: {} of {} "
        "triangles collapse, {} more have edges of a few steps",
        whose, r.step, r.collapsed, count, r.coarse);
}

}  // namespace obscura
