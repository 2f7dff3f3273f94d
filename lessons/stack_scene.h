#pragma once
// The scene of lesson 21: a stool, a ring and a board under a square lamp, the stack of its shadow maps, and
// what lookups in it take.

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/isa.h"
#include "core/mesh.h"
#include "core/pixel.h"
#include "core/scene.h"
#include "hierarchy/stack/stack.h"
#include "hierarchy/stack/visible_share.h"

namespace obscura {

/// Materials: 0 floor, 1 stool, 2 ring, 3 board.
struct LampScene {
    Mesh mesh;
    Camera camera;
    Vec3d lamp;            ///< its middle
    double lamp_side = 0;  ///< of its square, metres
    Vec3d stool{0, 0, 0};  ///< below its middle, on the floor
    double stool_height = 0;
};
LampScene lamp_scene();

/// So many points of the whole lamp; and along a line across its middle, `along` unit.
LightSamples lamp_samples(const LampScene& scene, int count);
LightSamples tube_samples(const LampScene& scene, Vec3d along, int count);

/// A stack, and the bytes of its maps' own quadtrees.
struct Stacked {
    ShadowStack stack;
    std::uint64_t quadtree_bytes = 0;
    double ratio() const { return static_cast<double>(stack.bytes) / static_cast<double>(quadtree_bytes); }
};

/// Of the whole lamp, the floor kept in place.
constexpr int lamp_texels = 512;
Stacked stacked(const LampScene& scene, int maps, const Exec& exec);

/// Of points along a line across the lamp, along the maps' own first axis: all maps have a point in the same
/// row of texels, so that a cut through the stack shows what moves.
constexpr int tube_maps = 32, tube_texels = 128;
struct Tube {
    Stacked stacked;
    int row = 0;  ///< of texels, through the stool
};
Tube tube_of(const LampScene& scene, const Exec& exec);

/// Each map aimed at the middle of the scene by itself; its octree can be asked by texels alone.
Stacked stack_apart(const LampScene& scene, const LightSamples& samples, int texels, const Exec& exec);

/// Points for lookups: places relative to an eye, and normals.
struct LampReceivers {
    std::vector<float> px, py, pz, nx, ny, nz;
    std::vector<std::uint16_t> pattern;
    std::vector<std::uint32_t> material;  ///< no_material: nothing is there

    static constexpr std::uint32_t no_material = ~0u;
    void add(Vec3f at, Vec3f normal, std::uint16_t turn, std::uint32_t of);
    std::size_t size() const { return px.size(); }
    StackPoints points() const;
};

/// A window of a picture of these pixels, row by row; `step` pixels apart. Patterns are those of squares of 4
/// x 4 pixels, each another sixteenth.
struct PictureWindow {
    int x = 0, y = 0, width = 0, height = 0, step = 1;
    int columns() const { return width / step; }
    int rows() const { return height / step; }
};
LampReceivers seen_receivers(const LampScene& scene, int width, int height, const PictureWindow& window,
                             const Exec& exec);

/// A point of the plane of focus over texel (x, y), or at a height above it, and the way up.
LampReceivers receivers_over(const StackFrame& frame, const std::vector<Vec3d>& texels_and_heights);

/// Colours of receivers that so much of the lamp reaches.
Image<Rgb8> lit_picture(const LampScene& scene, const LampReceivers& receivers,
                        const std::vector<float>& share, int columns);

/// Nodes read for each point, all maps at once and one by one; that both say the same is checked.
struct NodesRead {
    std::vector<double> at_once, one_by_one;
    std::vector<int> lit;
};
NodesRead nodes_read(const StackLookup& stack, const LampReceivers& receivers, const Exec& exec);
double mean_of(const std::vector<double>& values);

/// Columns of the tube's row, in texels, where the floor sees none of the lamp, a quarter to three, all of
/// it; and of a point raised_m above it that the middle map shows beside the second.
constexpr double raised_m = 0.25;
struct TellingColumns {
    double dark = 0, partly = 0, lit = 0, raised = 0;
};
TellingColumns telling_columns(const Tube& tube);

}  // namespace obscura
