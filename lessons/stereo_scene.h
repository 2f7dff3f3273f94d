#pragma once
// The scene of lessons 13 to 17: a block, a ball and a bust between a wall and a floor, and what its middle
// camera and both eyes see of it, found by the renderer's own stages.

#include <cstdint>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/mesh.h"
#include "core/pixel.h"
#include "core/scene.h"
#include "stereo/middle_view.h"
#include "stereo/moved_mesh.h"

namespace obscura {

/// Indices of its objects.
namespace stereo_object {
constexpr std::uint32_t wall = 0, ground = 1, block = 2, ball = 3, bust = 4;
}

/// With topology. The eyes stand at a height of 1.5 m and look along -z.
struct StereoScene {
    Mesh mesh;
    Camera camera;
    StereoRig rig;
};
StereoScene stereo_scene();
std::vector<std::string> object_names(const Mesh& mesh);

/// What is seen, pixel by pixel; infinitely far and nothing_seen where nothing is.
struct SeenPicture {
    Image<float> depth_m;
    Image<Vec3f> position, normal;  ///< of the surface where the scene has it, also in an eye's picture
    Image<std::uint32_t> triangle;
};
/// Of the middle camera.
SeenPicture seen_from_middle(const Mesh& mesh, const Camera& camera, int width, int height, const Exec& exec);
/// Of an eye: the moved mesh, drawn where eye_positions() says.
SeenPicture seen_by_eye(const StereoScene& scene, const MovedMesh& moved, Eye eye, int width, int height,
                        const Exec& exec);
/// Lit from the upper left, with chequered wall and floor.
Image<Rgb8> shaded(const Mesh& mesh, const SeenPicture& seen);

/// Without margins.
MiddleView stereo_view(const StereoScene& scene, const SeenPicture& seen);
MiddleView stereo_view(const StereoScene& scene, int width, int height, const Exec& exec);

/// The mesh as it is: no change anywhere.
MovedMesh unmoved(const Mesh& mesh);

}  // namespace obscura
