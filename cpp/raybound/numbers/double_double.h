// Numbers of twice double's digits, as unevaluated sums of two doubles: the arithmetic under elementary_range.h.
//
// Every operation is correct up to a relative error of 2^-102 as long as nothing overflows or underflows; the bounds
// and their proofs are those of Joldes, Muller and Popescu ("Tight and rigorous error bounds for basic building blocks
// of double-word arithmetic", ACM TOMS 44(2), 2017), whose algorithm is named at each. All is constexpr, so that tables
// can be made by the compiler.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace raybound {

// high is the double nearest to high + low.
struct DoubleDouble {
    double high = 0, low = 0;
};

// a + b exactly, where |a| >= |b| or a = 0 (Dekker 1971).
constexpr DoubleDouble fast_two_sum(double a, double b) {
    const double sum = a + b;
    return {sum, b - (sum - a)};
}

// a + b exactly (Knuth).
constexpr DoubleDouble two_sum(double a, double b) {
    const double sum = a + b, back = sum - a;
    return {sum, (a - (sum - back)) + (b - back)};
}

// 2^n exactly, -1022 <= n <= 1023.
constexpr double power_of_two(int n) { return std::bit_cast<double>(std::uint64_t(n + 1023) << 52); }

namespace double_double {

// a b exactly without fma, by halves of 26 bits (Veltkamp, Dekker 1971); |a|, |b| < 2^995.
constexpr DoubleDouble two_product_by_halves(double a, double b) {
    constexpr double splitter = 0x1p27 + 1;
    const double a_shifted = splitter * a, a_high = a_shifted - (a_shifted - a), a_low = a - a_high;
    const double b_shifted = splitter * b, b_high = b_shifted - (b_shifted - b), b_low = b - b_high;
    const double product = a * b;
    return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

}  // namespace double_double

// a b exactly: the same bits with and without the instruction, and in the compiler.
constexpr DoubleDouble two_product(double a, double b) {
#if defined(__FMA__) || defined(__ARM_FEATURE_FMA) || defined(__FP_FAST_FMA)
    if (!std::is_constant_evaluated()) {
        const double product = a * b;
        return {product, std::fma(a, b, -product)};
    }
#endif
    return double_double::two_product_by_halves(a, b);
}

constexpr DoubleDouble operator-(DoubleDouble a) { return {-a.high, -a.low}; }

// Any signs, cancellation included (AccurateDWPlusDW: 3 u^2 < 2^-104).
constexpr DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble high = two_sum(a.high, b.high), low = two_sum(a.low, b.low);
    const DoubleDouble sum = fast_two_sum(high.high, high.low + low.high);
    return fast_two_sum(sum.high, low.low + sum.low);
}
constexpr DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }

// a + b where a = 0 or |b| <= 0.6 |a|, at half the price (SloppyDWPlusDW). The two sums of low parts are rounded: at
// most 3 u^2 (|a| + |b|) with all second-order terms, and |a| + |b| <= 4 |a + b|: 12 u^2 < 2^-102. A zero a is exact.
constexpr DoubleDouble add_smaller(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble high = fast_two_sum(a.high, b.high);
    return fast_two_sum(high.high, high.low + (a.low + b.low));
}

// DWTimesFP1: 2 u^2 < 2^-105.
constexpr DoubleDouble operator*(DoubleDouble a, double b) {
    const DoubleDouble product = two_product(a.high, b), sum = fast_two_sum(product.high, a.low * b);
    return fast_two_sum(sum.high, sum.low + product.low);
}

// DWTimesDW1: 7 u^2 < 2^-103.
constexpr DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
    const DoubleDouble product = two_product(a.high, b.high);
    return fast_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

// DWDivDW2: 15 u^2 + 56 u^3 < 2^-102.
constexpr DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
    const double quotient = a.high / b.high;
    const DoubleDouble product = b * quotient;
    const double rest = (a.high - product.high) + (a.low - product.low);
    return fast_two_sum(quotient, rest / b.high);
}

// a >= 0. With s = sqrt(a.high)(1 + d), |d| <= u, the exact next Newton step is off by d^2/2; the residual is exact but
// for the roundings of its last two sums, 3 u^2 of a, and the quotient's own is u^2: together 4 u^2 < 2^-103 of the
// root.
inline DoubleDouble sqrt(DoubleDouble a) {
    if (!(a.high > 0)) return {};
    const double root = std::sqrt(a.high);
    const DoubleDouble square = two_product(root, root);
    return fast_two_sum(root, ((a.high - square.high) - square.low + a.low) / (2 * root));
}

}  // namespace raybound
