#pragma once
// Scenes that every contestant renders: solids on a closed slab, one directional light, one camera.

#include <string>

#include "app/scene/scene.h"
#include "core/types.h"

namespace obscura {

/// Resolutions of a bench run.
struct BenchSize {
    int map_px = 4096;  ///< light view, square
    int frame_width = 1920, frame_height = 1080;
};

/// One scene, ready for every contestant: `scene` has the mesh, one material, the camera and lights[0], a
/// directional light; `light` is that light's orthographic map over the whole mesh.
struct BenchScene {
    std::string name;
    Scene scene;
    LightView light;
    double topology_ms = 0;  ///< time analyse_topology() took, once per load, as a BVH build is
};

/// Puts `mesh` under the bench's light and before its camera, and analyses its topology.
BenchScene stage_scene(std::string name, Mesh mesh, const BenchSize& size);

/// Distance from the camera to the farthest corner of the scene's bounding box, metres.
double view_distance_m(const BenchScene& bench);

}  // namespace obscura
