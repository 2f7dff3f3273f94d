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
/// a + (b - a) t.
OBSCURA_INLINE Vec3x16 mix(const Vec3x16& a, const Vec3x16& b, const F32& t) {
    return a + (b - a) * t;
}

}  // namespace
}  // namespace obscura::OBSCURA_ISA
