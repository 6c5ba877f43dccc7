// Rigorous ranges of the elementary functions over intervals of doubles, for every double.
//
// The C library's accuracy is no promise, so nothing here calls it: values are computed with twice double's digits, at
// a proven relative error of 2^-74 (cpp/derivations.md, D10), and rounded outward. At a point the result is so the
// tightest pair of doubles unless the value lies within 2^-74 of a double; then one of its sides is one ulp wider.
// tests/numbers/test_elementary_range.py compares with arbitrary precision.
#pragma once

namespace raybound {

// {+infinity, -infinity} is empty.
struct Range {
    double inf, sup;
};

inline constexpr double pi_down = 0x1.921fb54442d18p+1, pi_up = 0x1.921fb54442d19p+1;
inline constexpr double half_pi_down = pi_down / 2, half_pi_up = pi_up / 2;

// The range over [lo, hi], lo <= hi, cut to the function's domain (IEEE 1788's set-based ranges): empty if nothing of
// it is left. An infinite end is an unbounded interval; lo > hi is the empty interval; with a NaN the result is entire.
// A tan that holds a pole is entire. Each side is the tightest double or one ulp wider.
Range exp_range(double lo, double hi);
Range log_range(double lo, double hi);
Range sin_range(double lo, double hi);
Range cos_range(double lo, double hi);
Range tan_range(double lo, double hi);
Range asin_range(double lo, double hi);
Range acos_range(double lo, double hi);
Range atan_range(double lo, double hi);

// The value at one double, from which the ranges are made. Exact values (exp 0, log 1, ...) are points; outside of the
// domain the result is empty. An infinity stands for all that lies beyond the doubles, and log_at(0) for all close to
// zero.
Range exp_at(double x);
Range log_at(double x);
Range sin_at(double x);
Range cos_at(double x);
Range tan_at(double x);
Range asin_at(double x);
Range acos_at(double x);
Range atan_at(double x);

}  // namespace raybound
