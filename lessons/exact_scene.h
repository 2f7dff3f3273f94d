#pragma once
// The scene of lesson 19: what a camera sees of a ring, a board and a tile in the sun, what shadow maps make
// of it, and the truth, ray by ray.

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "core/pixel.h"
#include "core/scene.h"
#include "raster/exact/exact_shadow.h"
#include "raster/gbuffer.h"
#include "raster/shadow_map.h"

namespace obscura {

constexpr int exact_width = 3 * frame_tile_side, exact_height = 2 * frame_tile_side;

/// Materials: 0 floor, 1 a tile let into it, their tops one plane, 2 ring, 3 board.
struct ExactScene {
    Mesh mesh;
    Light sun;
    Camera camera;
};
ExactScene exact_scene();

/// Samples of a picture that is `finer` times as fine both ways as exact_width x exact_height, in the form
/// that exact shadows ask for: point i is sample i of all blocks.
struct SeenPoints {
    int finer = 1;
    std::vector<SurfaceBlock> blocks;
    std::vector<double> p[3];  ///< world space, on the plane of its face
    std::vector<float> g[3];
    std::vector<std::uint32_t> face, triangle, covered, thin;

    std::size_t size() const { return face.size(); }
    ExactPoints points() const;
    bool is_covered(std::size_t i) const { return (covered[i / 16] >> (i % 16) & 1u) != 0; }
    Vec3d at(std::size_t i) const { return {p[0][i], p[1][i], p[2][i]}; }
    /// Of the geometric normal to the sun.
    double facing(const ExactScene& scene, std::size_t i) const;
};
SeenPoints seen_points(const ExactScene& scene, int finer, const Exec& exec);
/// Of any scene, one sample a pixel.
SeenPoints seen_points(const Mesh& mesh, const Camera& camera, int width, int height, const Exec& exec);

/// The sun's map, as frames make it: fitted to what casts shadows.
ShadowMap map_of(const ExactScene& scene, int texels, const Exec& exec);

/// Light that reaches each sample, 0 to 1; 0 where it faces away.
using Visibility = std::vector<float>;

/// From the bits that exact shadows leave.
Visibility of_bits(const std::vector<std::uint32_t>& lit);

/// By a map of the first surface's depth: nearest texel, lit where no more than `bias` behind it.
Visibility by_first_depth(const ExactScene& scene, const SeenPoints& seen, const LightView& view, float bias,
                          const Exec& exec);

/// By a kernel of side x side texels on a map of stored depths, as frames do it.
Visibility by_map(const ExactScene& scene, const SeenPoints& seen, const ShadowMap& map, int side,
                  const Exec& exec);

/// By a ray to the sun that asks every triangle: world space, doubles, none of the light's grid.
Visibility by_rays(const ExactScene& scene, const SeenPoints& seen, const Exec& exec);

/// Samples dark that should be lit, and the other way round; half is lit.
struct WrongSamples {
    int dark = 0, lit = 0;
};
WrongSamples wrong_samples(const Visibility& v, const Visibility& truth);

/// A window of the picture, in its pixels.
struct Crop {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Mean light and mean colour of its pixels.
struct LitPixels {
    Image<double> light;
    Image<Rgb8> picture;
};
LitPixels lit_pixels(const ExactScene& scene, const SeenPoints& seen, const Visibility& visibility,
                     const Crop& crop);

/// The same from side x side rays through each pixel, which share nothing with the renderer but the camera.
LitPixels true_pixels(const ExactScene& scene, int side, const Crop& crop, const Exec& exec);

/// Root of the mean squared difference.
double rms_between(const Image<double>& a, const Image<double>& b);

}  // namespace obscura
