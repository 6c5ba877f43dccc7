// Elementary functions of the kernels: our own, so that a picture has the same bits with every libm and machine.
//
// The float versions are evaluated in double by +, -, *, / and sqrt alone and rounded once at the end: at most 0.51
// ulp (tests/numbers/test_elementary.py runs through all floats; the largest error seen stands there).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "raybound/numbers/number.h"

namespace raybound {

namespace elementary {

inline constexpr double pi = 3.14159265358979323846;

// 2^k for the integer k that stands in the low bits of `shifted`.
inline double power_of_two(double shifted) {
    return std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023) << 52);
}

// e^x for |x| < 700, relative error below 2^-36: x = k ln 2 + r with |r| <= ln 2 / 2, a Taylor polynomial of degree 9
// in r (its remainder r^10/10! is below 2^-37), times 2^k. D is double, or doubles side by side.
template <class D>
inline D exp_kernel(const D& x) {
    constexpr double shifter = 0x1.8p52;  // adding it rounds to an integer in the low bits
    constexpr double log2_e = 1.4426950408889634074, ln2_high = 0x1.62e42fefa38p-1, ln2_low = 0x1.ef35793c7673p-45;
    const D shifted = x * D(log2_e) + D(shifter);
    const D k = shifted - D(shifter);
    const D r = (x - k * D(ln2_high)) - k * D(ln2_low);
    D p(1.0 / 362880);
    p = p * r + D(1.0 / 40320);
    p = p * r + D(1.0 / 5040);
    p = p * r + D(1.0 / 720);
    p = p * r + D(1.0 / 120);
    p = p * r + D(1.0 / 24);
    p = p * r + D(1.0 / 6);
    p = p * r + D(0.5);
    p = p * r + D(1.0);
    p = p * r + D(1.0);
    return p * power_of_two(shifted);
}

// atan(z) for 0 <= z <= 1, absolute error below 2^-37: one reduction by tan(pi/8), then the odd series to z^23
// (|z| <= 0.4143: the remainder is below 0.4143^25/25).
template <class D>
inline D atan_kernel(const D& z) {
    constexpr double tan_pi_8 = 0.41421356237309504880;
    const auto high = z > D(tan_pi_8);
    const D w = select(high, (z - D(1.0)) / (z + D(1.0)), z);
    const D w2 = w * w;
    D p(-1.0 / 23);
    p = p * w2 + D(1.0 / 21);
    p = p * w2 - D(1.0 / 19);
    p = p * w2 + D(1.0 / 17);
    p = p * w2 - D(1.0 / 15);
    p = p * w2 + D(1.0 / 13);
    p = p * w2 - D(1.0 / 11);
    p = p * w2 + D(1.0 / 9);
    p = p * w2 - D(1.0 / 7);
    p = p * w2 + D(1.0 / 5);
    p = p * w2 - D(1.0 / 3);
    p = p * w2 * w + w;
    return select(high, p + D(pi / 4), p);
}

// The angle of (x, y) in [-pi, pi]; the sign of a zero y is kept, atan2(+-0, +0) is +-0 as in C.
template <class D>
inline D atan2_kernel(const D& y, const D& x) {
    const D ax = abs(x), ay = abs(y);
    const D big = maximum(ax, ay), small = minimum(ax, ay);
    D angle = select(big > D(0.0), atan_kernel(D(small / big)), D(0.0));
    angle = select(ay > ax, D(pi / 2) - angle, angle);
    angle = select(copysign(D(1.0), x) < D(0.0), D(pi) - angle, angle);
    return copysign(angle, y);
}

// The functions of F = float, or of floats side by side.
template <class F>
inline F rounded_exp(const F& x) {
    using D = Wide<F>;
    const D clamped = minimum(maximum(D(-150.0), D(x)), D(150.0));  // NaN goes to -150 here, and is put back
    return select(x == x, F(exp_kernel(clamped)), x);
}
template <class F>
inline F rounded_atan2(const F& y, const F& x) {
    return F(atan2_kernel(Wide<F>(y), Wide<F>(x)));
}
// acos(x) = atan2(sqrt((1 - x)(1 + x)), x) for |x| <= 1, which does not cancel near 1; NaN outside.
template <class F>
inline F rounded_acos(const F& x) {
    using D = Wide<F>;
    const D s = (D(1.0) - D(x)) * (D(1.0) + D(x));
    return select(Mask<F>(s >= D(0.0)), F(atan2_kernel(D(sqrt(s)), D(x))),
                  F(std::numeric_limits<Scalar<F>>::quiet_NaN()));
}

}  // namespace elementary

// e^x. Above 88.73 it is +infinity, below -104 it is 0; NaN stays NaN.
inline float exp(float x) { return elementary::rounded_exp(x); }
inline float atan2(float y, float x) { return elementary::rounded_atan2(y, x); }
inline float acos(float x) { return elementary::rounded_acos(x); }

// Ward's lobe exp(-tan^2(alpha) / sigma^2) from the cosine of alpha (thesis 4.3.7, its sign of tan^2 corrected): the
// exponent in double, so that nothing cancels where the lobe is bright, and one rounding. Even in the cosine, 0 at 0.
inline float ward_lobe(float cosine, double sigma) {
    const double x = cosine, tangent = (1 - x) * (1 + x) / (x * x);
    const double exponent = minimum(maximum(-tangent / (sigma * sigma), -150.0), 150.0);
    return x == 0 ? 0.0f : x == x ? static_cast<float>(elementary::exp_kernel(exponent)) : cosine;
}

// The reference: double by the C library, accurate to 2^-52, far below what a float picture can show.
inline double exp(double x) { return std::exp(x); }
inline double atan2(double y, double x) { return std::atan2(y, x); }
inline double acos(double x) { return std::acos(x); }
template <std::floating_point T>
inline T ward_lobe(T cosine, double sigma) {
    const T tangent = (1 - cosine) * (1 + cosine) / (cosine * cosine);
    return cosine == 0 ? T(0) : std::exp(-tangent / (T(sigma) * T(sigma)));
}

// Not used by kernels, so they may be the C library's; float's are double's, rounded once.
template <std::floating_point T>
using AtLeastDouble = std::conditional_t<std::is_same_v<T, float>, double, T>;
template <std::floating_point T>
inline T log(T x) {
    return static_cast<T>(std::log(AtLeastDouble<T>(x)));
}
template <std::floating_point T>
inline T sin(T x) {
    return static_cast<T>(std::sin(AtLeastDouble<T>(x)));
}
template <std::floating_point T>
inline T cos(T x) {
    return static_cast<T>(std::cos(AtLeastDouble<T>(x)));
}
template <std::floating_point T>
inline T tan(T x) {
    return static_cast<T>(std::tan(AtLeastDouble<T>(x)));
}
template <std::floating_point T>
inline T asin(T x) {
    return static_cast<T>(std::asin(AtLeastDouble<T>(x)));
}
template <std::floating_point T>
inline T atan(T x) {
    return static_cast<T>(std::atan(AtLeastDouble<T>(x)));
}

}  // namespace raybound
