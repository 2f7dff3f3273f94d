#pragma once
// Vectors in structs that kernels read are plain arrays: the way there and back.

#include "core/vec.h"

namespace obscura {

constexpr void set(float (&to)[3], Vec3f v) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

constexpr void set(double (&to)[3], Vec3d v) {
    to[0] = v.x;
    to[1] = v.y;
    to[2] = v.z;
}

constexpr Vec3f vec(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}

constexpr Vec3d vec(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

}  // namespace obscura
