#pragma once
// Small fixed-size vectors and the affine and projective maps between spaces.
// Right-handed, +Y up, metres, column vectors: p' = M * p.

#include <cmath>

namespace obscura {

template <class T>
struct Vec2 {
    T x = 0, y = 0;
    friend bool operator==(const Vec2&, const Vec2&) = default;
};

template <class T>
struct Vec3 {
    T x = 0, y = 0, z = 0;
    friend bool operator==(const Vec3&, const Vec3&) = default;
};

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
constexpr Vec2<T> operator+(Vec2<T> a, Vec2<T> b) {
    return {a.x + b.x, a.y + b.y};
}
template <class T>
constexpr Vec2<T> operator-(Vec2<T> a, Vec2<T> b) {
    return {a.x - b.x, a.y - b.y};
}
template <class T>
constexpr Vec2<T> operator*(Vec2<T> a, T s) {
    return {a.x * s, a.y * s};
}

template <class T>
constexpr Vec3<T> operator+(Vec3<T> a, Vec3<T> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
constexpr Vec3<T> operator-(Vec3<T> a, Vec3<T> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
constexpr Vec3<T> operator-(Vec3<T> a) {
    return {-a.x, -a.y, -a.z};
}
template <class T>
constexpr Vec3<T> operator*(Vec3<T> a, T s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <class T>
constexpr Vec3<T> operator*(Vec3<T> a, Vec3<T> b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(Vec3<T> a) {
    return std::sqrt(dot(a, a));
}
/// Unit vector along `a`; `fallback` when `a` has no direction (zero, or too small to square).
template <class T>
Vec3<T> normalize(Vec3<T> a, Vec3<T> fallback = {T(0), T(1), T(0)}) {
    const T len = length(a);
    return len > T(0) ? a * (T(1) / len) : fallback;
}

constexpr Vec3d to_double(Vec3f a) {
    return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}
constexpr Vec3f to_float(Vec3d a) {
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

/// 3 x 4 affine map, row-major, in double: p' = (m[r][0] x + m[r][1] y + m[r][2] z) + m[r][3].
struct Affine {
    double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    friend bool operator==(const Affine&, const Affine&) = default;
};

constexpr Vec3d transform_point(const Affine& a, Vec3d p) {
    return {(a.m[0][0] * p.x + a.m[0][1] * p.y + a.m[0][2] * p.z) + a.m[0][3],
            (a.m[1][0] * p.x + a.m[1][1] * p.y + a.m[1][2] * p.z) + a.m[1][3],
            (a.m[2][0] * p.x + a.m[2][1] * p.y + a.m[2][2] * p.z) + a.m[2][3]};
}
constexpr Vec3d transform_direction(const Affine& a, Vec3d d) {
    return {a.m[0][0] * d.x + a.m[0][1] * d.y + a.m[0][2] * d.z,
            a.m[1][0] * d.x + a.m[1][1] * d.y + a.m[1][2] * d.z,
            a.m[2][0] * d.x + a.m[2][1] * d.y + a.m[2][2] * d.z};
}
/// First `b`, then `a`.
constexpr Affine operator*(const Affine& a, const Affine& b) {
    Affine r;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 4; ++j) {
            r.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j] +
                        (j == 3 ? a.m[i][3] : 0.0);
        }
    }
    return r;
}
constexpr double determinant(const Affine& a) {
    return a.m[0][0] * (a.m[1][1] * a.m[2][2] - a.m[1][2] * a.m[2][1]) -
           a.m[0][1] * (a.m[1][0] * a.m[2][2] - a.m[1][2] * a.m[2][0]) +
           a.m[0][2] * (a.m[1][0] * a.m[2][1] - a.m[1][1] * a.m[2][0]);
}

/// One row of an affine map, summed by pairs.
constexpr double row_at(const double (&row)[4], Vec3d p) {
    return (row[0] * p.x + row[1] * p.y) + (row[2] * p.z + row[3]);
}

/// 4 x 4 map in double, row-major, for homogeneous points.
struct Mat4 {
    double m[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    friend bool operator==(const Mat4&, const Mat4&) = default;
};

struct Vec4d {
    double x = 0, y = 0, z = 0, w = 0;
};

constexpr Vec4d operator*(const Mat4& a, Vec4d p) {
    const auto row = [&](int r) {
        return (a.m[r][0] * p.x + a.m[r][1] * p.y) + (a.m[r][2] * p.z + a.m[r][3] * p.w);
    };
    return {row(0), row(1), row(2), row(3)};
}
constexpr Mat4 operator*(const Mat4& a, const Mat4& b) {
    Mat4 r;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            r.m[i][j] = (a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j]) +
                        (a.m[i][2] * b.m[2][j] + a.m[i][3] * b.m[3][j]);
        }
    }
    return r;
}
/// Inverse by cofactors. The caller guarantees det != 0.
Mat4 inverse(const Mat4& a);

}  // namespace obscura
