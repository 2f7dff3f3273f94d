#pragma once
// A scene's materials, lights and sky in the form that shading reads.

#include <vector>

#include "core/scene.h"
#include "raster/shade.h"

namespace obscura {

std::vector<ShadeMaterial> shade_materials(const std::vector<Material>& materials);

/// `eye`: the point that positions are relative to.
ShadeLight shade_light_of(const Light& light, Vec3d eye);

/// Of an area light, one side, square metres.
double area_m2(const Light& light);

/// Whether the light contributes anything: not below the horizon, not black.
bool sheds_light(const Light& light);

ShadeSky shade_sky(const Sky& sky);

}  // namespace obscura
