// Vectors of three numbers. Sums run left to right, always: the order of rounding is part of the specification.
#pragma once

#include <array>

#include "raybound/numbers/number.h"

namespace raybound {

template <class T>
struct Vec3 {
    T x{}, y{}, z{};

    // Copied component by component: as one block of bytes a vector would be read in pieces wider than those just
    // written, which stalls processors (measured: 12 to 15 % of a frame).
    constexpr Vec3() = default;
    constexpr Vec3(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
    constexpr Vec3& operator=(const Vec3& v) {
        x = v.x;
        y = v.y;
        z = v.z;
        return *this;
    }
    [[gnu::always_inline]] constexpr Vec3(const T& x_, const T& y_, const T& z_) : x(x_), y(y_), z(z_) {}
    template <class S>
    constexpr explicit Vec3(const Vec3<S>& v)
        : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}

    constexpr T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    constexpr bool operator==(const Vec3&) const = default;
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <class T>
constexpr Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
constexpr Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
constexpr Vec3<T> operator-(const Vec3<T>& a) {
    return {-a.x, -a.y, -a.z};
}
template <class T>
constexpr Vec3<T> operator*(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T>
constexpr Vec3<T> operator*(const Vec3<T>& a, T s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <class T>
constexpr Vec3<T> operator*(T s, const Vec3<T>& a) {
    return a * s;
}

template <class T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return sum_of_products(a.x, b.x, a.y, b.y, a.z, b.z);
}
template <class T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}
template <class T>
inline T length(const Vec3<T>& a) {
    return sqrt(dot(a, a));
}
template <class T>
inline Vec3<T> normalize(const Vec3<T>& a) {
    return a * rsqrt(dot(a, a));
}
template <class T>
inline Vec3<T> absolute(const Vec3<T>& a) {
    return {abs(a.x), abs(a.y), abs(a.z)};
}
template <class T>
inline T norm1(const Vec3<T>& a) {
    return abs(a.x) + abs(a.y) + abs(a.z);
}
template <class T>
inline T max_component(const Vec3<T>& a) {
    return maximum(maximum(a.x, a.y), a.z);
}
template <class T>
inline T min_component(const Vec3<T>& a) {
    return minimum(minimum(a.x, a.y), a.z);
}
template <class T>
inline Vec3<T> select(Mask<T> mask, const Vec3<T>& yes, const Vec3<T>& no) {
    return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
template <class T>
inline Vec3<T> minimum(const Vec3<T>& a, const Vec3<T>& b) {
    return {minimum(a.x, b.x), minimum(a.y, b.y), minimum(a.z, b.z)};
}
template <class T>
inline Vec3<T> maximum(const Vec3<T>& a, const Vec3<T>& b) {
    return {maximum(a.x, b.x), maximum(a.y, b.y), maximum(a.z, b.z)};
}
template <std::floating_point T>
inline bool is_finite(const Vec3<T>& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
template <class T>
inline Mask<T> is_finite(const Vec3<T>& a) {
    return Mask<T>(abs(a.x) < infinity<T>) & (abs(a.y) < infinity<T>)&(abs(a.z) < infinity<T>);
}

// Two unit vectors that complete the unit vector w to a right-handed basis (Duff et al. 2017): for w = z they are x
// and y, so that shapes along z have the (u,v) one expects.
template <class T>
inline std::array<Vec3<T>, 2> orthonormal_basis(const Vec3<T>& w) {
    const T sign = copysign(T(1), w.z);
    const T a = T(-1) / (sign + w.z);
    const T b = w.x * w.y * a;
    return {Vec3<T>{T(1) + sign * w.x * w.x * a, sign * b, -sign * w.x}, Vec3<T>{b, sign + w.y * w.y * a, -w.y}};
}

}  // namespace raybound
