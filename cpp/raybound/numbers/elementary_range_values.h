// The elementary functions with twice double's digits: what elementary_range.h rounds outward.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "raybound/numbers/elementary_range_reduction.h"
#include "raybound/numbers/elementary_range_tables.h"

namespace raybound::elementary_values {

using namespace elementary_tables;

// Every value here is within this relative error of the function's (cpp/derivations.md, D10). Largest error over bound
// that tests/numbers/test_elementary_range.py has seen: RATIO.
inline constexpr double relative_error = 0x1p-74;

inline constexpr DoubleDouble one{1, 0};

// ----------------------------------------------------------------------------------

struct Scaled {
    DoubleDouble significand;  // in [0.99, 2)
    int exponent;
};

// x = (64 exponent + j) ln2/64 + r, |r| <= ln2/128 and a little; e^x = 2^exponent 2^(j/64) e^r. 2^-54 <= |x| < 750.
inline Scaled exp_value(double x) {
    constexpr double shifter = 0x1.8p52, inverse_step = 0x1.71547652b82fep+6;  // 64 / ln 2
    const double k = (x * inverse_step + shifter) - shifter;                   // to an integer, in the low bits
    const DoubleDouble high = two_product(k, ln_2.high / 64), rest = two_sum(x, -high.high);
    const DoubleDouble r = two_sum(rest.high, rest.low - high.low - k * (ln_2.low / 64));
    const int steps = int(k), j = steps & 63;
    const DoubleDouble& power = exp2_table[std::size_t(j)];
    return {add_smaller(power, power * exp_minus_one(r)), (steps - j) / 64};
}

// x = 2^e m > 0, m in [0.7071, 1.4142], q = j/64 the nearest to m: ln x = e ln2 + ln q + 2 atanh((m - q) / (m + q)).
inline DoubleDouble log_value(double x) {
    const bool subnormal = x < std::numeric_limits<double>::min();
    const auto bits = std::bit_cast<std::uint64_t>(subnormal ? x * 0x1p54 : x);
    int e = int(bits >> 52) - 1023 - (subnormal ? 54 : 0);
    double m = std::bit_cast<double>((bits & ((std::uint64_t(1) << 52) - 1)) | std::uint64_t(1023) << 52);
    if (m > 1.4142) m /= 2, ++e;
    const int j = int(m * 64 + 0.5);
    const double q = j / 64.0;
    const DoubleDouble t = DoubleDouble{m - q, 0} / two_sum(m, q);  // m - q is exact
    const DoubleDouble arc = add_smaller(t, t * arc_over_tangent(t * t)) * 2.0;
    return add_smaller(ln_2 * double(e), add_smaller(log_table[std::size_t(j - log_first)], arc));
}

// |r| <= pi/4 (1 + 2^-50).
inline DoubleDouble sine_value(DoubleDouble r) { return add_smaller(r, r * sine_over_angle(r * r)); }
inline DoubleDouble cosine_value(DoubleDouble r) { return add_smaller(one, cosine_minus_one(r * r)); }

inline DoubleDouble sine_value(const QuarterTurns& x, int shift) {
    const int n = x.nearest + shift;
    const DoubleDouble v = n & 1 ? cosine_value(x.rest) : sine_value(x.rest);
    return n & 2 ? -v : v;
}

inline DoubleDouble tangent_value(const QuarterTurns& x) {
    const DoubleDouble s = sine_value(x.rest), c = cosine_value(x.rest);
    return x.nearest & 1 ? -(c / s) : s / c;
}

// The angle of (x, y), 0 <= y <= x: turned back by atan(q), q a multiple of 1/32, its tangent is 1/64 at most.
inline DoubleDouble low_angle(DoubleDouble y, DoubleDouble x) {
    const int j = int(y.high / x.high * 32 + 0.5);
    const double q = j / 32.0;
    const DoubleDouble t = (y - x * q) / (x + y * q);
    return add_smaller(atan_table[std::size_t(j)], add_smaller(t, t * arc_over_tangent(-(t * t))));
}

// The angle of (x, y), x >= 0, y >= 0, not both zero.
inline DoubleDouble angle(DoubleDouble y, DoubleDouble x) {
    return y.high > x.high ? add_smaller(half_pi, -low_angle(x, y)) : low_angle(y, x);
}

// sqrt(1 - x^2), which does not cancel near 1.
inline DoubleDouble cosine_of_sine(double x) { return sqrt(two_sum(1, -x) * two_sum(1, x)); }

// |x| <= 1.
inline DoubleDouble asin_value(double x) {
    const DoubleDouble v = angle({std::abs(x), 0}, cosine_of_sine(x));
    return x > 0 ? v : -v;
}
inline DoubleDouble acos_value(double x) {
    const DoubleDouble v = angle(cosine_of_sine(x), {std::abs(x), 0});
    return x >= 0 ? v : add_smaller(pi, -v);
}

// From 2^100 on the value is pi/2 within 2^-100, infinity included.
inline DoubleDouble atan_value(double x) {
    const DoubleDouble v = angle({std::abs(x) < 0x1p100 ? std::abs(x) : 0x1p100, 0}, one);
    return x > 0 ? v : -v;
}

}  // namespace raybound::elementary_values
