// Integer powers rounded toward either infinity.
#pragma once

#include <concepts>

namespace raybound {

// x^n toward minus and plus infinity, to the bit, for finite x > 0 and any n; overflow and underflow as in rounding.h.
// Certain for every operand; tight unless x^n comes within 2^-340 of a floating-point number without being one.
template <std::floating_point T>
T power_down(T x, int n);
template <std::floating_point T>
T power_up(T x, int n);

}  // namespace raybound
