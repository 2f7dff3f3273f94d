#pragma once
// The definition of exact shadows in pieces (exact_ref.cpp), for whoever defines more by them.

#include "core/vec.h"
#include "raster/exact/exact.h"

namespace obscura::ref {

/// A sample as triangles see it.
struct Place {
    Vec3d p;  ///< world space
    std::int32_t x = 0, y = 0;
    float z = 0, rounding = 0;
    std::uint32_t face = 0;
    int point = 0;
};

/// What a point asks.
struct Question {
    bool asks = false;
    bool looks = false;  ///< else lit: before the near plane, or beyond everything that casts
    int view = 0;
    Place place;
};
Question question(const ExactPoints& points, const ExactLight& light, int at);

/// Adds the place of a question that looks.
void add_sample(const Question& q, ExactSamples& samples);

/// Whether a triangle, whose nearest depth is z_low, darkens a sample.
bool darkens(const CasterTriangle& t, float z_low, const ExactLight& light, const ExactPoints& points,
             const Place& s);

}  // namespace obscura::ref
