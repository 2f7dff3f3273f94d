#pragma once
// The terms of one sample's shading by themselves, for traces, tests and lessons. raster/shade_ref.cpp.

#include "core/vec.h"
#include "raster/shade.h"

namespace obscura::ref {

/// Light that arrives at a point: direction to the light, and irradiance on a facing surface, unshadowed.
struct Incident {
    Vec3f to_light;
    Vec3f irradiance;
};
Incident incident_light(const ShadeLight& light, Vec3f position);

/// What one light adds to one sample.
struct LightTerms {
    Incident incident;
    float nl = 0;             ///< n . l, may be negative
    Vec3f diffuse, specular;  ///< per unit of irradiance, with the cosine
    Vec3f through;            ///< transmitted by thin materials
};
LightTerms light_terms(const SurfaceBlock& surface, const ShadeLight& light, const ShadeBlock& shade, int at);

/// Radiance from direction y = d.y of a unit direction, and the irradiance of the whole sky on a surface
/// whose normal has n.y = y.
Vec3f sky_radiance(const ShadeSky& sky, float y);
Vec3f sky_irradiance(const ShadeSky& sky, float y);

}  // namespace obscura::ref
