// Neighbouring floating-point numbers and the error factor gamma (seeds/000, 3.9.1), and a scaled epsilon (seeds/004).
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "raybound/numbers/number.h"

namespace raybound {

template <class T>
using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

// The bits of a number as an unsigned integer of its size, and the number of bits: FloatToBits and BitsToFloat.
template <std::floating_point T>
constexpr Bits<T> float_bits(T x) {
    return std::bit_cast<Bits<T>>(x);
}
template <std::floating_point T>
constexpr T float_from_bits(Bits<T> bits) {
    return std::bit_cast<T>(bits);
}

// The least number greater than x; +infinity and NaN stay as they are; both zeros go to the least subnormal.
template <std::floating_point T>
constexpr T next_float_up(T x) {
    if (!(x < std::numeric_limits<T>::infinity())) return x;
    if (x == 0) return std::numeric_limits<T>::denorm_min();
    const Bits<T> bits = float_bits(x);
    return float_from_bits<T>(x > 0 ? bits + 1 : bits - 1);
}

template <std::floating_point T>
constexpr T next_float_down(T x) {
    return -next_float_up(-x);
}

// Epsilon(x, scale) of seeds/004: |x| times `scale` times the distance from 1 to the next number. For scale > 1,
// x + epsilon > x and x - epsilon < x for every normal x: the product is at least the distance from x to its
// neighbours, a number, so rounding keeps it. Not for zero, whose epsilon is 0, nor for float's subnormal x with |x|
// scale <= 2^-127, whose epsilon is rounded to 0.
template <std::floating_point T>
inline T epsilon(T x, T scale) {
    return std::abs(x) * (std::numeric_limits<T>::epsilon() * scale);
}

// gamma_n = n u / (1 - n u): n roundings in a row multiply a result by a factor within 1 +- gamma_n
// (seeds/000, eq. 3.6; Higham 2002). Evaluated in double and rounded up, so that it is a bound itself.
template <std::floating_point T>
constexpr T gamma(int n) {
#ifdef RAYBOUND_SABOTAGE_ROUNDING
    return T(n) * 0;  // the sabotage build: every rounding bound is gone, and the tests must notice
#else
    const double nu = n * double(NumberTraits<T>::unit_roundoff);
    return n > 0 ? next_float_up(T(nu / (1 - nu))) : T(0);
#endif
}

}  // namespace raybound
