// The speed of intervals beside that of plain numbers.
#pragma once

#include <cstddef>
#include <string>

namespace raybound {

// Nanoseconds for one multiply-add r[i] = a[i] b[i] + c[i] over arrays of n elements, independent of each other, one
// after the other except for "interval array"; the best of `repeats` measurements. Operands are uniform in (-1, 1) with
// random signs, intervals 10^-3 wide around them. Every result is stored. kind: "double", "interval portable",
// "interval hardware" (only where AVX-512 is compiled in), "interval best" (what Interval uses), "interval array".
// Throws std::invalid_argument for another kind or n = 0.
double time_multiply_add(const std::string& kind, std::size_t n, int repeats);

}  // namespace raybound
