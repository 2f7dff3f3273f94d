#pragma once
// The light that surfaces send on to one another: how much of it leaves every place of the scene, so that
// what hides a part of the sky can stand for it (`bounces` of [sky]).
//
// Surfaces are cut into patches. What arrives at the middle of each, from lights and from the sky, is asked
// as exact shadows of it, and is sent on as from matt paint. A picture's samples gather it direction by
// direction (raster/exact/exact_nearest.h), and for further bounces so do the patches. C. Goral, K. Torrance,
// D. Greenberg, B. Battaile, "Modeling the Interaction of Light Between Diffuse Surfaces", SIGGRAPH 1984, for
// light that is the same to all sides of a patch; T. Hachisuka, GPU Gems 2, chapter 38, 2005, for gathering
// from all surfaces along one direction after the other.
//
// A direction stands for a cone, which far off is wider than a patch: what it meets there is the mean over
// what lies around and looks the same way (after L. Williams, "Pyramidal Parametrics", SIGGRAPH 1983, for
// surfaces in space).
//
// Approximate: mirrors send light on as paint does, what shines (emission) lights nothing, means know no
// walls, and of what comes from the sky patches ask 16 directions from above and 8 from below.

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "app/frame/frame_sky.h"
#include "app/frame/surface_patches.h"
#include "app/scene/scene.h"
#include "core/isa.h"
#include "core/mesh_memory.h"

namespace obscura {

struct SurfaceLight {
    /// Level 0 is the patches' own, level l the mean within about 2^l of their sizes.
    static constexpr int levels = 4;
    SurfacePatches patches;
    std::array<std::vector<Vec3f>, levels> sent;  ///< by patch: radiance, W / (m^2 sr)

    bool empty() const { return sent[0].empty(); }
};

/// What arrives at p within a cone of so large a solid angle from a triangle `distance_m` before it on the
/// way to_light: radiance, W / (m^2 sr).
Vec3f sent_radiance(const Mesh& mesh, const SurfaceLight& light, std::uint32_t triangle, Vec3d p,
                    Vec3d to_light, float distance_m, float solid_angle_sr);

/// What the scene's surfaces send after `sky.sky.bounces` - 1 exchanges among them; none when cancelled. Does
/// not depend on the camera, nor on exec.
SurfaceLight surface_light(const Scene& scene, const FrameSky& sky, const Exec& exec,
                           const std::atomic<bool>* cancel);

/// Bytes of the result, and of what making it takes beside it and one light's casters: expected.
std::int64_t surface_light_bytes(const MeshSize& mesh);
std::int64_t surface_light_work_bytes(const MeshSize& mesh);

/// What it was made from, which a frame that keeps it compares.
struct KeptSurfaceLight {
    SurfaceLight light;
    std::vector<SceneLight> lights;
    std::vector<Material> materials;
    Sky sky;
};

}  // namespace obscura
