// Directed rounding: add, subtract, multiply, divide, sqrt and fma toward minus and plus infinity, for float and
// double. Only these files round in a direction; the processor's rounding mode is neither read nor changed.
//
// Both implementations give the results of IEEE 754-2019 (4.3.2) to the bit, and these special values:
//
//   operands                                 toward -infinity        toward +infinity
//   result above the largest finite number   largest finite          +infinity
//   result below the least finite number     -infinity               least finite (= -largest)
//   0 < result < smallest subnormal          +0                      smallest subnormal
//   -smallest subnormal < result < 0         -smallest subnormal     -0
//   x - x, (+0) + (-0), exact fma to zero    -0                      +0
//   (+0) + (+0), (-0) + (-0)                 +0, -0                  +0, -0
//   0 * x, 0 / x                             0 with the product of the signs
//   sqrt(-0)                                 -0                      -0
//   an infinite operand, x / 0               as rounding to nearest: exact
//   inf - inf, 0 * inf, 0 / 0, inf / inf, sqrt(x < 0), a NaN         NaN
#pragma once

#include <concepts>

#include "raybound/numbers/rounding_hardware.h"
#include "raybound/numbers/rounding_portable.h"

namespace raybound {

#ifdef __AVX512F__
using DirectedRounding = HardwareRounding;
#else
using DirectedRounding = PortableRounding;
#endif

template <std::floating_point T>
inline T add_down(T a, T b) {
    return DirectedRounding::add_down(a, b);
}
template <std::floating_point T>
inline T add_up(T a, T b) {
    return DirectedRounding::add_up(a, b);
}
template <std::floating_point T>
inline T subtract_down(T a, T b) {
    return DirectedRounding::subtract_down(a, b);
}
template <std::floating_point T>
inline T subtract_up(T a, T b) {
    return DirectedRounding::subtract_up(a, b);
}
template <std::floating_point T>
inline T multiply_down(T a, T b) {
    return DirectedRounding::multiply_down(a, b);
}
template <std::floating_point T>
inline T multiply_up(T a, T b) {
    return DirectedRounding::multiply_up(a, b);
}
template <std::floating_point T>
inline T divide_down(T a, T b) {
    return DirectedRounding::divide_down(a, b);
}
template <std::floating_point T>
inline T divide_up(T a, T b) {
    return DirectedRounding::divide_up(a, b);
}
template <std::floating_point T>
inline T sqrt_down(T x) {
    return DirectedRounding::sqrt_down(x);
}
template <std::floating_point T>
inline T sqrt_up(T x) {
    return DirectedRounding::sqrt_up(x);
}
template <std::floating_point T>
inline T fma_down(T a, T b, T c) {
    return DirectedRounding::fma_down(a, b, c);
}
template <std::floating_point T>
inline T fma_up(T a, T b, T c) {
    return DirectedRounding::fma_up(a, b, c);
}

}  // namespace raybound
