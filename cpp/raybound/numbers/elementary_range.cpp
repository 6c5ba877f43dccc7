#include "raybound/numbers/elementary_range.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "raybound/numbers/elementary_range_values.h"
#include "raybound/numbers/float_bits.h"

namespace raybound {

namespace {

using namespace elementary_values;

constexpr double largest = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
constexpr Range empty{infinity<double>, -infinity<double>}, entire{-infinity<double>, infinity<double>};

// --- Rounding ---

// The doubles around a value within relative_error of v: v.high is the nearest one to v, so its neighbours enclose the
// value in any case. Zero is exact: a relative error leaves it alone.
Range round_outward(DoubleDouble v) {
#ifdef RAYBOUND_SABOTAGE_ROUNDING
    return {v.high, v.high};  // the sabotage build: not rounded outward, and the tests must notice
#else
    if (v.high == 0) return {0, 0};
    const double error = std::abs(v.high) * relative_error;
    return {v.low > error ? v.high : next_float_down(v.high), v.low < -error ? v.high : next_float_up(v.high)};
#endif
}

// For |x| < tiny: sin and atan are between x and the next double toward zero, tan and asin between x and the next one
// away from it, as |f(x) - x| <= |x|^3 (1/3 + |x|^2) < 2^-53 |x|.
constexpr double tiny = 0x1p-26;
Range toward_zero(double x) { return x > 0 ? Range{next_float_down(x), x} : Range{x, x < 0 ? next_float_up(x) : x}; }
Range away_from_zero(double x) { return x > 0 ? Range{x, next_float_up(x)} : Range{x < 0 ? next_float_down(x) : x, x}; }

// --- From points to ranges ---

// A bound of e^x as a double, from that of its significand: exact, but for subnormal results, whose bits are the
// integer part of significand 2^(exponent + 1074), or the next integer.
template <bool up>
double scale(double significand, int exponent) {
    if (exponent >= -1021) {
        const int half = exponent / 2;
        return significand * power_of_two(half) * power_of_two(exponent - half);
    }
    const auto digits = std::uint64_t(significand * 0x1p53);
    const int shift = -1021 - exponent;
    return std::bit_cast<double>((digits + (up ? (std::uint64_t(1) << shift) - 1 : 0)) >> shift);
}

Range sine_at(double x, const QuarterTurns& turns, int shift) {
    if (shift == 0 && std::abs(x) < tiny) return toward_zero(x);
    if (x == 0) return {1, 1};
    const Range v = round_outward(sine_value(turns, shift));
    return {std::max(v.inf, -1.0), std::min(v.sup, 1.0)};
}

Range sine_at(double x, int shift) { return std::isfinite(x) ? sine_at(x, quarter_turns(x), shift) : Range{-1, 1}; }

// How many multiples of pi/2 are in (lo, hi], hi - lo < 6.5.
int multiples_between(const QuarterTurns& lo, const QuarterTurns& hi) { return (hi.below() - lo.below()) & 63; }

// The range of sin(x + shift pi/2). Maxima are at the multiples n = 1 modulo 4 of pi/2, minima at 3.
Range sine_range(double lo, double hi, int shift) {
    if (!(hi - lo < 6.5)) return {-1, 1};  // a whole turn, whatever the difference's rounding; or infinite
    if (lo == hi) return sine_at(lo, shift);
    const QuarterTurns a = quarter_turns(lo), b = quarter_turns(hi);
    const Range at_lo = sine_at(lo, a, shift), at_hi = sine_at(hi, b, shift);
    Range range{std::min(at_lo.inf, at_hi.inf), std::max(at_lo.sup, at_hi.sup)};
    for (int n = multiples_between(a, b); n > 0; --n) {
        const int phase = (a.below() + n + shift) & 3;
        if (phase == 1) range.sup = 1;
        if (phase == 3) range.inf = -1;
    }
    return range;
}

Range tangent_at(double x, const QuarterTurns& turns) {
    return std::abs(x) < tiny ? away_from_zero(x) : round_outward(tangent_value(turns));
}

Range no_interval(double lo, double hi) { return lo != lo || hi != hi ? entire : empty; }

template <class At>
Range increasing(double lo, double hi, At at) {
    if (lo == hi) return at(lo);
    return {at(lo).inf, at(hi).sup};
}

}  // namespace

Range exp_at(double x) {
    if (x != x) return entire;
    if (x > 0x1.62e42fefa39efp+9) return {largest, infinity<double>};  // the largest x with e^x < 2^1024
    if (x < -746) return {0, least};
    if (std::abs(x) < 0x1p-54) return {x < 0 ? next_float_down(1.0) : 1.0, x > 0 ? next_float_up(1.0) : 1.0};
    const Scaled v = exp_value(x);
    const Range r = round_outward(v.significand);
    return {scale<false>(r.inf, v.exponent), scale<true>(r.sup, v.exponent)};
}

Range log_at(double x) {
    if (x != x) return entire;
    if (x < 0) return empty;
    if (x == 0) return {-infinity<double>, -largest};
    const Range v = round_outward(log_value(std::min(x, largest)));
    return {v.inf, x > largest ? infinity<double> : v.sup};
}

Range sin_at(double x) { return x != x ? entire : sine_at(x, 0); }
Range cos_at(double x) { return x != x ? entire : sine_at(x, 1); }
Range tan_at(double x) { return std::isfinite(x) ? tangent_at(x, quarter_turns(x)) : entire; }

Range asin_at(double x) {
    if (x != x) return entire;
    if (std::abs(x) > 1) return empty;
    if (std::abs(x) < tiny) return away_from_zero(x);
    return round_outward(asin_value(x));
}

Range acos_at(double x) {
    if (x != x) return entire;
    if (std::abs(x) > 1) return empty;
    return round_outward(acos_value(x));
}

Range atan_at(double x) {
    if (x != x) return entire;
    if (std::abs(x) < tiny) return toward_zero(x);
    return round_outward(atan_value(x));
}

Range exp_range(double lo, double hi) { return lo <= hi ? increasing(lo, hi, exp_at) : no_interval(lo, hi); }
Range atan_range(double lo, double hi) { return lo <= hi ? increasing(lo, hi, atan_at) : no_interval(lo, hi); }

Range log_range(double lo, double hi) {
    if (!(lo <= hi)) return no_interval(lo, hi);
    return hi > 0 ? increasing(std::max(lo, 0.0), hi, log_at) : empty;
}

Range asin_range(double lo, double hi) {
    if (!(lo <= hi)) return no_interval(lo, hi);
    return lo <= 1 && hi >= -1 ? increasing(std::max(lo, -1.0), std::min(hi, 1.0), asin_at) : empty;
}

Range acos_range(double lo, double hi) {
    if (!(lo <= hi)) return no_interval(lo, hi);
    // Decreasing: the ends change places.
    return lo <= 1 && hi >= -1 ? increasing(std::min(hi, 1.0), std::max(lo, -1.0), acos_at) : empty;
}

Range sin_range(double lo, double hi) { return lo <= hi ? sine_range(lo, hi, 0) : no_interval(lo, hi); }
Range cos_range(double lo, double hi) { return lo <= hi ? sine_range(lo, hi, 1) : no_interval(lo, hi); }

Range tan_range(double lo, double hi) {
    if (!(lo <= hi)) return no_interval(lo, hi);
    if (lo == hi) return tan_at(lo);
    if (!(hi - lo < 3.5)) return entire;  // more than pi, whatever the difference's rounding; or infinite
    const QuarterTurns a = quarter_turns(lo), b = quarter_turns(hi);
    const int count = multiples_between(a, b);
    if (count > 1 || (count == 1 && b.below() & 1)) return entire;  // a pole: an odd multiple of pi/2
    return {tangent_at(lo, a).inf, tangent_at(hi, b).sup};
}

}  // namespace raybound
