#pragma once
// The scene of lessons 3 and 4: solids that nest, touch, interpenetrate and stand on a slab, and a sheet,
// under a light that shines straight down. One row of its map, seen from the side, is a cut through them.

#include <vector>

#include "core/isa.h"
#include "core/mesh.h"
#include "core/types.h"
#include "lessons/drawing/figure.h"

namespace obscura {

struct CutScene {
    Mesh mesh;
    LightView view;
    int row = 0;  ///< the cut
};

/// A texel of the cut row whose ray shows one case.
struct CutRay {
    const char* name;
    int x;
};

CutScene cut_scene();
std::vector<CutRay> cut_rays(const CutScene& scene);

/// Where a depth at a texel position of the row lies in the picture: the row runs along `box`, depth down it.
Vec2d in_cut(const CutScene& scene, const Box& box, double X, double depth);

/// The row's solids, darker where the counter is higher, and its sheets, found with layers_of(). `strength`:
/// 1 as a picture of its own, less as a background.
void draw_cut(Figure& figure, const CutScene& scene, const Box& box, double strength, const Exec& exec);

}  // namespace obscura
