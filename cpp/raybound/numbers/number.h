// The concept Number: what a type must offer for the kernels of light and geometry to be instantiated with it.
//
// Kernels are written once, as templates over T. They do not branch on values: they `select`, and leave early only
// through `none(mask)`, which every number type can answer ("no lane", "certainly not"). So a pack of floats, an
// interval or a Taylor model can follow where today `float` draws and `double` checks.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <limits>

namespace raybound {

// Mask: the truth value of comparisons. Wide: the type that decides whether and where rays cross surfaces (double for
// float; double decides for itself), while T filters before it and computes the light (cpp/derivations.md, D0).
template <class T>
struct NumberTraits;

template <>
struct NumberTraits<float> {
    using Mask = bool;
    using Wide = double;
    static constexpr float unit_roundoff = 0x1p-24f;
};

template <>
struct NumberTraits<double> {
    using Mask = bool;
    using Wide = double;
    static constexpr double unit_roundoff = 0x1p-53;
};

template <class T>
using Mask = typename NumberTraits<T>::Mask;
template <class T>
using Wide = typename NumberTraits<T>::Wide;

// The floating-point type that an execution of the kernel would compute in.
template <class T>
struct ScalarOf {
    using type = T;
};
template <class T>
using Scalar = typename ScalarOf<T>::type;

// A small integer for each value of T: one, or one for each lane.
template <class T>
struct IndexOf {
    using type = int;
};
template <class T>
using Index = typename IndexOf<T>::type;

inline bool none(bool mask) { return !mask; }

template <std::floating_point T>
inline T select(bool mask, T yes, T no) {
    return mask ? yes : no;
}
inline int select(bool mask, int yes, int no) { return mask ? yes : no; }
inline bool select(bool mask, bool yes, bool no) { return mask ? yes : no; }

// min and max that keep their first argument when the second is NaN: a slab that says nothing (0 times infinity)
// constrains nothing.
template <std::floating_point T>
inline T minimum(T a, T b) {
    return b < a ? b : a;
}
template <std::floating_point T>
inline T maximum(T a, T b) {
    return b > a ? b : a;
}

template <std::floating_point T>
inline T square(T x) {
    return x * x;
}
template <std::floating_point T>
inline T reciprocal(T x) {
    return T(1) / x;
}
template <std::floating_point T>
inline T rsqrt(T x) {
    return T(1) / std::sqrt(x);
}
using std::abs;
using std::copysign;
using std::fma;
using std::sqrt;

// The n-th power by repeated squaring: at most |n| roundings. A negative power is the reciprocal of the positive one.
template <std::floating_point T>
inline T power(T x, int n) {
    T result(1), factor = x;
    for (unsigned rest = n < 0 ? 0u - unsigned(n) : unsigned(n); rest > 0;) {
        if (rest & 1u) result = result * factor;
        if ((rest >>= 1) > 0) factor = factor * factor;
    }
    return n < 0 ? T(1) / result : result;
}

// What dot and cross products consist of, so that a number type can do it in one go. The order of rounding is part of
// the specification.
template <class T>
constexpr T sum_of_products(const T& a, const T& b, const T& c, const T& d, const T& e, const T& f) {
    return a * b + c * d + e * f;
}
template <class T>
constexpr T difference_of_products(const T& a, const T& b, const T& c, const T& d) {
    return a * b - c * d;
}

// constant + sum slopes[i] x[i], from left to right without the slopes that are 0.
template <class T, std::size_t N>
constexpr T affine(double constant, const std::array<double, N>& slopes, const std::array<T, N>& x) {
    T sum(constant);
    for (std::size_t i = 0; i < N; ++i)
        if (slopes[i] != 0) sum = sum + T(slopes[i]) * x[i];
    return sum;
}

template <class T>
inline constexpr T infinity = std::numeric_limits<T>::infinity();

template <class T>
concept Number = requires(T a, Mask<T> m) {
    { a + a } -> std::convertible_to<T>;
    { a - a } -> std::convertible_to<T>;
    { a * a } -> std::convertible_to<T>;
    { a / a } -> std::convertible_to<T>;
    { a < a } -> std::convertible_to<Mask<T>>;
    { sqrt(a) } -> std::convertible_to<T>;
    { select(m, a, a) } -> std::convertible_to<T>;
};

static_assert(Number<float> && Number<double>);

}  // namespace raybound
