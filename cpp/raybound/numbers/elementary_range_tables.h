// Constants and tables of the elementary functions, with twice double's digits. Only pi, ln 2 and 2/pi are written down
// (from python-flint, rounded to nearest, 2/pi cut off); the compiler computes all else by the series that define it.
// tests/numbers/test_elementary_range.py compares every entry with arbitrary precision.
#pragma once

#include <array>
#include <cstdint>

#include "raybound/numbers/double_double.h"

namespace raybound::elementary_tables {

inline constexpr DoubleDouble pi{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
inline constexpr DoubleDouble half_pi{pi.high / 2, pi.low / 2};
inline constexpr DoubleDouble ln_2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};

// 2/pi: one word of zeros, then the first 1280 bits after the binary point.
inline constexpr std::array<std::uint64_t, 21> two_over_pi = {
    0x0000000000000000, 0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041, 0xfe5163abdebbc561,
    0xb7246e3a424dd2e0, 0x06492eea09d1921c, 0xfe1deb1cb129a73e, 0xe88235f52ebb4484, 0xe99c7026b45f7e41,
    0x3991d639835339f4, 0x9c845f8bbdf9283b, 0x1ff897ffde05980f, 0xef2f118b5a0a6d1f, 0x6d367ecf27cb09b7,
    0x4f463f669e5fea2d, 0x7527bac7ebe5f17b, 0x3d0739f78a5292ea, 0x6bfb5fb11f8d5d08, 0x56033046fc7b6bab,
    0xf0cfbc209af4361d};

// c0 z + c1 z^2 + ...: the first coefficients with twice double's digits, the small rest as doubles.
template <int leading, int trailing>
struct Series {
    std::array<DoubleDouble, leading> first{};
    std::array<double, trailing> rest{};

    constexpr void set(int i, DoubleDouble c) {
        if (i < leading)
            first[std::size_t(i)] = c;
        else
            rest[std::size_t(i - leading)] = c.high;
    }

    // Each coefficient must be at least 5/3 of the sum that follows it (add_smaller); D10 bounds the error.
    DoubleDouble operator()(DoubleDouble z) const {
        double tail = rest[trailing - 1];
        for (int i = trailing - 2; i >= 0; --i) tail = tail * z.high + rest[i];
        DoubleDouble sum = add_smaller(first[leading - 1], z * tail);
        for (int i = leading - 2; i >= 0; --i) sum = add_smaller(first[i], z * sum);
        return z * sum;
    }
};

// Coefficients sign/first!, sign^2/(first + step)!, ...
template <int leading, int trailing>
constexpr Series<leading, trailing> factorial_series(int first, int step, double sign) {
    Series<leading, trailing> series;
    DoubleDouble c{1, 0};
    int n = 0;
    for (int i = 0; i < leading + trailing; ++i) {
        while (n < first + i * step) c = c / DoubleDouble{double(++n), 0};
        c = c * sign;
        series.set(i, c);
    }
    return series;
}

template <int leading, int trailing>
constexpr Series<leading, trailing> odd_reciprocals() {
    Series<leading, trailing> series;
    for (int i = 0; i < leading + trailing; ++i) series.set(i, DoubleDouble{1, 0} / DoubleDouble{2.0 * i + 3, 0});
    return series;
}

inline constexpr auto exp_minus_one = factorial_series<2, 6>(1, 1, 1);      // e^z - 1
inline constexpr auto sine_over_angle = factorial_series<4, 7>(3, 2, -1);   // sin(r)/r - 1, z = r^2
inline constexpr auto cosine_minus_one = factorial_series<4, 7>(2, 2, -1);  // cos(r) - 1, z = r^2
inline constexpr auto arc_over_tangent = odd_reciprocals<1, 5>();           // atan(t)/t - 1, z = -t^2; atanh: z = t^2

// atan(t) (sign = -1) or atanh(t) (sign = 1) for |t| <= 1/31: t^27/27 is below 2^-138.
constexpr DoubleDouble arc_series(DoubleDouble t, double sign) {
    const DoubleDouble z = t * t * sign;
    DoubleDouble sum;
    for (int n = 25; n > 0; n -= 2) sum = DoubleDouble{1, 0} / DoubleDouble{double(n), 0} + z * sum;
    return t * sum;
}

// atan(j/32), j = 0 ... 32: atan((j+1)/32) = atan(j/32) + atan(32 / (1024 + j (j+1))).
inline constexpr auto atan_table = [] {
    std::array<DoubleDouble, 33> table{};
    for (int j = 0; j < 32; ++j)
        table[j + 1] = table[j] + arc_series(DoubleDouble{32, 0} / DoubleDouble{1024.0 + j * (j + 1), 0}, -1);
    return table;
}();

// ln(j/64), j = log_first ... 91, at j - log_first: ln((j+1)/j) = 2 atanh(1 / (2j+1)).
inline constexpr int log_first = 45;
inline constexpr auto log_table = [] {
    std::array<DoubleDouble, 47> table{};
    const auto step = [](int j) { return arc_series(DoubleDouble{1, 0} / DoubleDouble{2.0 * j + 1, 0}, 1) * 2.0; };
    for (int j = 64; j < 91; ++j) table[j + 1 - log_first] = table[j - log_first] + step(j);
    for (int j = 64; j > log_first; --j) table[j - 1 - log_first] = table[j - log_first] - step(j - 1);
    return table;
}();

// 2^(j/64), j = 0 ... 63.
inline constexpr auto exp2_table = [] {
    DoubleDouble root{1, 0};
    for (int n = 18; n > 0; --n) root = DoubleDouble{1, 0} + root * ln_2 / DoubleDouble{64.0 * n, 0};
    std::array<DoubleDouble, 64> table{DoubleDouble{1, 0}};
    for (int j = 1; j < 64; ++j) table[j] = table[j - 1] * root;
    return table;
}();

}  // namespace raybound::elementary_tables
