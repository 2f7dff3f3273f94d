#pragma once
// Vec3 of sixteen lanes: the operators of core/vec.h, in the same order of operations. Kernel files only.

#include "core/simd.h"

namespace obscura::OBSCURA_ISA {
namespace {

struct Vec3x16 {
    F32 x, y, z;
};

OBSCURA_INLINE Vec3x16 operator+(const Vec3x16& a, const Vec3x16& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
OBSCURA_INLINE Vec3x16 operator-(const Vec3x16& a, const Vec3x16& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
OBSCURA_INLINE Vec3x16 operator*(const Vec3x16& a, const F32& s) {
    return {a.x * s, a.y * s, a.z * s};
}
OBSCURA_INLINE Vec3x16 operator*(const Vec3x16& a, const Vec3x16& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
OBSCURA_INLINE F32 dot(const Vec3x16& a, const Vec3x16& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
OBSCURA_INLINE Vec3x16 cross(const Vec3x16& a, const Vec3x16& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
OBSCURA_INLINE Vec3x16 select(const Mask& m, const Vec3x16& a, const Vec3x16& b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
/// -a in the lanes of `m`, a in the others.
OBSCURA_INLINE Vec3x16 negated(const Mask& m, const Vec3x16& a) {
    const F32 sign = select(m, splat(-0.0f), splat(0.0f));
    return {a.x ^ sign, a.y ^ sign, a.z ^ sign};
}
OBSCURA_INLINE Vec3x16 splat3(float x, float y, float z) {
    return {splat(x), splat(y), splat(z)};
}
OBSCURA_INLINE Vec3x16 splat3(const float (&v)[3]) {
    return splat3(v[0], v[1], v[2]);
}
OBSCURA_INLINE Vec3x16 load3(const float* x, const float* y, const float* z) {
    return {load(x), load(y), load(z)};
}
OBSCURA_INLINE void store3(float* x, float* y, float* z, const Vec3x16& v) {
    store(x, v.x);
    store(y, v.y);
    store(z, v.z);
}
using Float16 = float __attribute__((vector_size(64)));

/// x0 y0 z0 x1 y1 z1 ... x15 y15 z15, in three.
OBSCURA_INLINE Vec3x16 interleaved(const Vec3x16& v) {
    Float16 x, y, z;
    Vec3x16 out;
    __builtin_memcpy(&x, &v.x, sizeof x);
    __builtin_memcpy(&y, &v.y, sizeof y);
    __builtin_memcpy(&z, &v.z, sizeof z);
    const Float16 xy0 = __builtin_shufflevector(x, y, 0, 16, 0, 1, 17, 0, 2, 18, 0, 3, 19, 0, 4, 20, 0, 5);
    const Float16 xyz0 =
        __builtin_shufflevector(xy0, z, 0, 1, 16, 3, 4, 17, 6, 7, 18, 9, 10, 19, 12, 13, 20, 15);
    __builtin_memcpy(&out.x, &xyz0, sizeof xyz0);
    const Float16 xy1 = __builtin_shufflevector(x, y, 21, 0, 6, 22, 0, 7, 23, 0, 8, 24, 0, 9, 25, 0, 10, 26);
    const Float16 xyz1 =
        __builtin_shufflevector(xy1, z, 0, 21, 2, 3, 22, 5, 6, 23, 8, 9, 24, 11, 12, 25, 14, 15);
    __builtin_memcpy(&out.y, &xyz1, sizeof xyz1);
    const Float16 xy2 =
        __builtin_shufflevector(x, y, 0, 11, 27, 0, 12, 28, 0, 13, 29, 0, 14, 30, 0, 15, 31, 0);
    const Float16 xyz2 =
        __builtin_shufflevector(xy2, z, 26, 1, 2, 27, 4, 5, 28, 7, 8, 29, 10, 11, 30, 13, 14, 31);
    __builtin_memcpy(&out.z, &xyz2, sizeof xyz2);
    return out;
}
/// a + (b - a) t.
OBSCURA_INLINE Vec3x16 mix(const Vec3x16& a, const Vec3x16& b, const F32& t) {
    return a + (b - a) * t;
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
