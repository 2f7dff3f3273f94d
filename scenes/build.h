#pragma once
// Bricklaying: flat facets into a mesh, parts into a model, and the rigid moves that place them.

#include <initializer_list>
#include <vector>

#include "core/mesh.h"
#include "core/scene.h"
#include "core/vec.h"

namespace obscura {

/// What a generator returns: one mesh and the material slots that its `material` entries index. A slot has a
/// name, which a scene file may give a material of its own, and a default look.
struct GeneratedModel {
    Mesh mesh;
    std::vector<Material> materials;
};

/// Move by `offset`, metres.
Affine translation(Vec3d offset);
Affine translation(double x, double y, double z);
/// Stretch along the axes.
Affine scaling(Vec3d factor);
/// Turn counter-clockwise seen against the axis (right-hand rule), degrees. Multiples of 90 are exact.
Affine rotation_x(double degrees);
Affine rotation_y(double degrees);
Affine rotation_z(double degrees);
/// Turns +Y to the unit vector `up`, by the smallest angle.
Affine rotation_to(Vec3d up);

/// (cos, sin) of a share of a full turn; exact at multiples of a quarter.
Vec2d on_circle(double turns);

/// A position as meshes store it: minus zero becomes zero, so that equal positions have equal bits.
constexpr Vec3f stored(Vec3d p) {
    return to_float(p) + Vec3f{0, 0, 0};
}

/// Adds one convex facet, counter-clockwise from outside, with its flat normal and metre-scaled uvs: u runs
/// level along the facet, v up it. Fewer than three corners, or a facet without area, break the precondition.
void add_facet(Mesh& mesh, std::initializer_list<Vec3d> corners, std::uint32_t material = 0);
void add_facet(Mesh& mesh, const std::vector<Vec3d>& corners, std::uint32_t material = 0);

/// Flat uv of `p` on a facet with unit normal `n`, metres.
Vec2f facet_uv(Vec3d p, Vec3d n);

/// Appends a moved copy of `part`, all its triangles with `material`. Mirroring moves keep it inside-in.
void add_part(Mesh& to, const Mesh& part, const Affine& move, std::uint32_t material = 0);
/// Appends a moved copy of a part that brings its own slots, whose numbers move up by `first_material`.
void add_parts(Mesh& to, const Mesh& part, const Affine& move, std::uint32_t first_material);

/// A named slot with its default look. Colours are sRGB in 0..255, as a paint chart gives them.
Material material_slot(const char* name, int red, int green, int blue, float roughness = 0.8f);

}  // namespace obscura
