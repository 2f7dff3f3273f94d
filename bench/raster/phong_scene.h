#pragma once
// The shading constants that both peers use for a bench scene's frame.

#include "bench/harness/stage.h"
#include "bench/raster/phong.h"

namespace obscura {

/// Constants for scene.lights[0], the first material and the sky; `normals` is left empty.
PhongScene phong_constants(const BenchScene& bench);

/// Per triangle the three vertex normals, nine floats, as PhongScene::normals wants them.
std::vector<float> corner_normals(const Mesh& mesh);

}  // namespace obscura
