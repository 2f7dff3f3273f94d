#pragma once
// A scene's surfaces cut into patches of about one size, for light that they send on to one another.

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "core/vec.h"

namespace obscura {

/// One side of a piece of surface. What stands for it is the middle of one cell of one triangle.
struct SurfacePatch {
    std::uint32_t triangle = 0;
    std::uint32_t cell = 0;  ///< of the triangle's side^2
    bool back = false;       ///< its other side: against the triangle's plane
    float area_m2 = 0;
};

constexpr std::uint32_t no_patch = 0xffffffffu;

/// The patches of a triangle: side^2 cells alike, rows along its second edge, patch `front` + cell and, where
/// its other side may be seen, `back` + cell. Small triangles that lie together and look the same way share
/// a patch.
struct TrianglePatches {
    std::uint32_t front = no_patch, back = no_patch;
    std::uint16_t side = 0;
};

struct SurfacePatches {
    double size_m = 0;  ///< a patch is about half of a square of this side
    std::vector<TrianglePatches> triangles;
    std::vector<SurfacePatch> patches;
};

constexpr std::int64_t surface_cells = 1 << 17;  ///< of large triangles, about

/// Of everything in the mesh that casts shadows. Insides of closed components have no patches.
SurfacePatches surface_patches(const Mesh& mesh);

/// The patch that holds p, a point on the triangle or, by rounding, just beside it; no_patch: it has none.
std::uint32_t patch_at(const Mesh& mesh, const SurfacePatches& patches, std::uint32_t triangle, bool back,
                       Vec3d p);

/// What stands for a patch: its place, the unit normal of its side, and its place along the triangle's edges
/// from corner 0 to 1 and from 0 to 2.
struct PatchMiddle {
    Vec3d p, n;
    double u = 0, v = 0;
};
PatchMiddle patch_middle(const Mesh& mesh, const SurfacePatches& patches, const SurfacePatch& patch);

}  // namespace obscura
