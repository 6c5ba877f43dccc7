// 3x3 matrices and affine maps. Maps are composed in double and rounded to float once, where a kernel needs them.
#pragma once

#include "raybound/geometry/vector.h"

namespace raybound {

template <class T>
struct Mat3 {
    Vec3<T> row[3]{{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}};

    Mat3() = default;
    Mat3(const Vec3<T>& r0, const Vec3<T>& r1, const Vec3<T>& r2) : row{r0, r1, r2} {}
    template <class S>
    explicit Mat3(const Mat3<S>& m) : row{Vec3<T>(m.row[0]), Vec3<T>(m.row[1]), Vec3<T>(m.row[2])} {}
    bool operator==(const Mat3&) const = default;

    Vec3<T> column(int j) const { return {row[0][j], row[1][j], row[2][j]}; }
};

template <class T>
inline Vec3<T> operator*(const Mat3<T>& m, const Vec3<T>& v) {
    return {dot(m.row[0], v), dot(m.row[1], v), dot(m.row[2], v)};
}
// The transpose of m times v: how gradients travel when points travel by the inverse.
template <class T>
inline Vec3<T> transpose_times(const Mat3<T>& m, const Vec3<T>& v) {
    return m.row[0] * v.x + m.row[1] * v.y + m.row[2] * v.z;
}
template <class T>
inline Mat3<T> operator*(const Mat3<T>& a, const Mat3<T>& b) {
    const Vec3<T> c0 = a * b.column(0), c1 = a * b.column(1), c2 = a * b.column(2);
    return {{c0.x, c1.x, c2.x}, {c0.y, c1.y, c2.y}, {c0.z, c1.z, c2.z}};
}
template <class T>
inline Mat3<T> from_columns(const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c) {
    return {{a.x, b.x, c.x}, {a.y, b.y, c.y}, {a.z, b.z, c.z}};
}
template <class T>
inline T determinant(const Mat3<T>& m) {
    return dot(m.row[0], cross(m.row[1], m.row[2]));
}
// The inverse by cofactors; rows of the adjugate are cross products of columns.
template <class T>
inline Mat3<T> inverse(const Mat3<T>& m) {
    const Vec3<T> a = m.column(0), b = m.column(1), c = m.column(2);
    const T scale = T(1) / determinant(m);
    return {cross(b, c) * scale, cross(c, a) * scale, cross(a, b) * scale};
}
template <class T>
inline Mat3<T> absolute(const Mat3<T>& m) {
    return {absolute(m.row[0]), absolute(m.row[1]), absolute(m.row[2])};
}
// The largest row sum of absolute values, an upper bound of how far a component can grow.
template <class T>
inline T norm_infinity(const Mat3<T>& m) {
    return maximum(maximum(norm1(m.row[0]), norm1(m.row[1])), norm1(m.row[2]));
}

// x -> linear x + offset, in double.
struct Affine {
    Mat3<double> linear;
    Vec3d offset;

    bool operator==(const Affine&) const = default;
    Vec3d point(const Vec3d& p) const { return linear * p + offset; }
    bool is_identity() const { return *this == Affine{}; }
};

inline Affine operator*(const Affine& a, const Affine& b) { return {a.linear * b.linear, a.point(b.offset)}; }
inline Affine inverse(const Affine& a) {
    const Mat3<double> linear = inverse(a.linear);
    return {linear, -(linear * a.offset)};
}

}  // namespace raybound
