#pragma once
// Which of a cube's faces sees each of sixteen directions. Kernel files only; twin of cube_face()
// (raster/view.h).

#include "core/simd_vec.h"

namespace obscura::OBSCURA_ISA {
namespace {

OBSCURA_INLINE I32 cube_faces(const Vec3x16& d) {
    const F32 ax = abs(d.x), ay = abs(d.y), az = abs(d.z), zero = splat(0.0f);
    const auto face = [&](const F32& along, std::int32_t positive) {
        return select(less_equal(zero, along), splat(positive), splat(positive + 1));
    };
    const I32 y_or_z = select(less_equal(az, ay), face(d.y, 2), face(d.z, 4));
    return select(less_equal(ay, ax) & less_equal(az, ax), face(d.x, 0), y_or_z);
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
