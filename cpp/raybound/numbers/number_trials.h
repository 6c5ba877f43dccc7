// Random trials of directed rounding and of interval arithmetic, judged by exact integers that share no code with them.
#pragma once

#include <cstdint>
#include <string>

namespace raybound {

struct TrialCounts {
    std::uint64_t trials = 0;
    std::uint64_t violations = 0;   // on the wrong side of the exact result, or a wrong special value or signed zero
    std::uint64_t not_tight = 0;    // on the right side, but not the nearest there
    std::uint64_t differences = 0;  // lanes whose bits are not those of one number or interval
    std::string first_failure;      // operands and result, in hexadecimal
    // The interesting cases. special: an operand or the result is not a number of the operation.
    std::uint64_t inexact = 0, exact = 0, special = 0;
    std::uint64_t underflows = 0, overflows = 0;  // below the least normal number, beyond the largest
    std::uint64_t cancellations = 0;              // sums of less than 2^-20 of a term
    std::uint64_t points = 0, straddling = 0;     // of the first interval
};

// `count` operand tuples for "add", "subtract", "multiply", "divide", "sqrt" or "fma" in float or double (`wide`), both
// directions: 10^U(-6, 6) with random signs, all bits random, subnormal, huge, near powers of two, small integers,
// special values, nearly equal operands and, for fma, c near -a b. implementation: "portable" or "hardware" (with
// AVX-512). Throws std::invalid_argument for other names.
TrialCounts rounding_trials(const std::string& operation, bool wide, const std::string& implementation,
                            std::uint64_t seed, std::uint64_t count);

// `count` tuples of intervals for "add", "subtract", "multiply", "divide", "sqrt", "square" or "fma" of Interval and of
// IntervalPack: points, a few ulps wide, up to as wide as they are large, and around zero; with ends 10^U(-6, 6) or
// near underflow and overflow. Both ends are compared with the exact extremes over the corners of the operands;
// divisors without zero.
TrialCounts interval_trials(const std::string& operation, bool wide, const std::string& implementation,
                            std::uint64_t seed, std::uint64_t count);

}  // namespace raybound
