// The operations that all number types share, for float and double themselves: what a plain kernel computes.
#pragma once

#include "raybound/numbers/elementary.h"

namespace raybound {

using std::asin;
using std::atan;
using std::cos;
using std::fma;
using std::log;
using std::sin;
using std::tan;

template <std::floating_point T>
inline T reciprocal(T x) {
    return T(1) / x;
}
template <std::floating_point T>
inline T rsqrt(T x) {
    return T(1) / sqrt(x);
}

// x^n by squaring; the reciprocal of x^-n for n < 0.
template <std::floating_point T>
inline T power(T x, int n) {
    T result(1);
    for (unsigned rest = n < 0 ? -static_cast<unsigned>(n) : static_cast<unsigned>(n); rest != 0; rest /= 2) {
        if (rest % 2 == 1) result = result * x;
        x = x * x;
    }
    return n < 0 ? T(1) / result : result;
}

// exp((1 - 1/cosine^2) / sigma^2): Ward's lobe of the cosine between N and H.
template <std::floating_point T>
inline T ward_lobe(T cosine, double sigma) {
    return exp((T(1) - T(1) / square(cosine)) / square(T(sigma)));
}

}  // namespace raybound
