// Directed rounding by the exact residual of rounding to nearest and one step of next-float (see rounding.h).
#pragma once

#include "raybound/numbers/exact.h"
#include "raybound/numbers/float_bits.h"
#include "raybound/numbers/rounding_lanes.h"

namespace raybound {

namespace rounding {

// The neighbour above, where a rounding to nearest fell below its exact value.
inline double raise_if(bool below, double nearest) {
#ifdef RAYBOUND_SABOTAGE_ROUNDING
    static_cast<void>(below);  // the sabotage build: to nearest, and the tests must notice
    return nearest;
#else
    return below ? next_float_up(nearest) : nearest;
#endif
}

// The same for numbers between 2^-960 and 2^1023 in size, without a branch or a move to integer registers. With
// u = 2^-53, u (1 + 2 u) |x| is more than half the distance to either neighbour and less than one and a half of it,
// also where x is a power of two (Rump, Zimmermann, Boldo and Melquiond, Computing predecessor and successor in
// rounding to nearest, 2009).
template <class V>
inline V raise_if_positive(V residual, V nearest) {
#ifdef RAYBOUND_SABOTAGE_ROUNDING
    static_cast<void>(residual);
    return nearest;
#else
    const V step = (0x1p-53 + 0x1p-105) * lanes::magnitude(nearest);
    return nearest + lanes::where_positive(residual, step);
#endif
}

// The float at or above d + e, where d is the double nearest to d + e. If d is no float, no float lies between d and
// d + e, as every float is a double; if it is one, the sign of e decides.
template <class D>
inline lanes::With<D, float> float_above(D d, D e) {
    using F = lanes::With<D, float>;
    const F f = lanes::convert<F>(d);
#ifdef RAYBOUND_SABOTAGE_ROUNDING
    static_cast<void>(e);
    return f;
#else
    using Bits = lanes::Bits<F>;
    const D back = lanes::convert<D>(f);
    const auto below = lanes::convert<Bits>((back < d) | ((back == d) & (e > 0)));
    const auto bits = std::bit_cast<Bits>(f);
    const Bits above = f == 0 ? lanes::every<Bits>(1) : bits + ((bits >> 31) | 1);  // of zero the least subnormal
    return std::bit_cast<F>(below ? above : bits);
#endif
}

template <class V>
inline bool is_moderate(V x) {
    return lanes::all_between(lanes::magnitude(x), 0x1p-960, 0x1p1022);
}

// a + b - sum for sum = fl(a + b), exactly (Knuth's TwoSum): underflow does not happen in sums, nor overflow for
// |sum| < 2^1022 (Boldo, Graillat and Muller, On the robustness of the 2Sum and Fast2Sum algorithms, 2017).
template <class V>
inline V sum_error(V a, V b, V sum) {
    const V b_part = sum - a, a_part = sum - b_part;
    return (a - a_part) + (b - b_part);
}

// The slow paths, for results near underflow or overflow. Operands are scaled by powers of two to [1/2, 1), where the
// residual's sign is exact; `nearest` is the result rounded to nearest.
[[gnu::noinline]] inline double add_up(double a, double b, double nearest) {
    if (std::abs(nearest) < 1) return raise_if(sum_error(a, b, nearest) > 0, nearest);
    if (std::isinf(a) || std::isinf(b) || std::isnan(nearest)) return nearest;
    if (std::isinf(nearest)) return raise_if(nearest < 0, nearest);
    const double big = std::abs(a) > std::abs(b) ? a : b, small = std::abs(a) > std::abs(b) ? b : a;
    return raise_if(small - (nearest - big) > 0, nearest);  // Dekker's FastTwoSum: nothing exceeds |nearest|, |big|
}

[[gnu::noinline]] inline double multiply_up(double a, double b, double nearest) {
    if (a == 0 || b == 0 || std::isinf(a) || std::isinf(b) || std::isnan(nearest)) return nearest;
    if (std::isinf(nearest)) return raise_if(nearest < 0, nearest);
    int a_exponent, b_exponent;
    const double x = std::frexp(a, &a_exponent), y = std::frexp(b, &b_exponent);
    return raise_if(std::fma(x, y, -std::ldexp(nearest, -(a_exponent + b_exponent))) > 0, nearest);
}

[[gnu::noinline]] inline double divide_up(double a, double b, double nearest) {
    if (a == 0 || b == 0 || std::isinf(a) || std::isinf(b) || std::isnan(nearest)) return nearest;
    if (std::isinf(nearest)) return raise_if(nearest < 0, nearest);
    int a_exponent, b_exponent;
    const double x = std::frexp(a, &a_exponent), y = std::frexp(b, &b_exponent);
    const double residual = std::fma(-std::ldexp(nearest, b_exponent - a_exponent), y, x);  // (a / b - nearest) b
    return raise_if(y > 0 ? residual > 0 : residual < 0, nearest);
}

// A number with the sign of a b + c - nearest, for finite numbers with a b != 0.
inline double fma_residual(double a, double b, double c, double nearest) {
    int a_exponent, b_exponent, c_exponent;
    const double x = std::frexp(a, &a_exponent), y = std::frexp(b, &b_exponent), z = std::frexp(c, &c_exponent);
    const int unit = a_exponent + b_exponent;
    if (c != 0 && c_exponent - unit > 200) return x * y;  // the product is lost beside c: nearest = c
    ExactSum<4> residual;
    residual.add_product(x, y);
    // x y - nearest is a multiple of 2^-106 or 0: beside it, only the sign of a c below 2^-200 counts.
    residual.add(c != 0 && c_exponent - unit < -200 ? std::copysign(0x1p-200, c) : std::ldexp(z, c_exponent - unit));
    residual.add(-std::ldexp(nearest, -unit));
    return residual.value();
}

[[gnu::noinline]] inline double fma_up(double a, double b, double c, double nearest) {
    if (std::isinf(a) || std::isinf(b) || std::isinf(c) || std::isnan(nearest)) return nearest;
    if (std::isinf(nearest)) return raise_if(nearest < 0, nearest);
    if (a == 0 || b == 0) return nearest;
    return raise_if(fma_residual(a, b, c, nearest) > 0, nearest);
}

// In float, products are exact in double. A quotient or root that is no float differs from every float by 2^-48 of
// itself at least (its residual is a multiple of the operands' last places), more than double's rounding: it never
// looks like one.
template <class V>
inline constexpr bool by_double = sizeof(lanes::Value<V>) == 4;
template <class V>
inline lanes::With<V, double> wide(V x) {
    return lanes::convert<lanes::With<V, double>>(x);
}
template <class D>
inline lanes::With<D, float> float_above(D d) {
    return float_above(d, D{});
}

}  // namespace rounding

// Of numbers or lanes (rounding_lanes.h), float or double.
struct PortableRounding {
    template <class V>
    static V add_up(V a, V b) {
        if constexpr (rounding::by_double<V>) {
            const auto x = rounding::wide(a), y = rounding::wide(b), sum = x + y;
            return rounding::float_above(sum, rounding::sum_error(x, y, sum));
        } else {
            const V sum = a + b;
            if (!rounding::is_moderate(sum)) [[unlikely]]
                return lanes::one_by_one([](double x, double y) { return rounding::add_up(x, y, x + y); }, a, b);
            return rounding::raise_if_positive(rounding::sum_error(a, b, sum), sum);
        }
    }

    template <class V>
    static V multiply_up(V a, V b) {
        if constexpr (rounding::by_double<V>) {
            return rounding::float_above(rounding::wide(a) * rounding::wide(b));
        } else {
            const V product = a * b;
            if (!lanes::has_product_error(a, b, product)) [[unlikely]]
                return lanes::one_by_one([](double x, double y) { return rounding::multiply_up(x, y, x * y); }, a, b);
            return rounding::raise_if_positive(lanes::product_error(a, b, product), product);
        }
    }

    // The greater of a b and c d, rounded up, at the price of one test for special cases: false, and nothing done,
    // where there may be one.
    template <class V>
    static bool try_greater_product_up(V a, V b, V c, V d, V& greater) {
        if constexpr (rounding::by_double<V>) {
            const auto x = rounding::wide(a) * rounding::wide(b), y = rounding::wide(c) * rounding::wide(d);
            if (!lanes::all_finite(x + y)) return false;
            greater = rounding::float_above(lanes::greater(x, y));
        } else {
            const V x = a * b, y = c * d;
            if (!lanes::have_product_errors(a, b, x, c, d, y)) return false;
            greater = lanes::greater(rounding::raise_if_positive(lanes::product_error(a, b, x), x),
                                     rounding::raise_if_positive(lanes::product_error(c, d, y), y));
        }
        return true;
    }

    template <class V>
    static V divide_up(V a, V b) {
        if constexpr (rounding::by_double<V>) {
            return rounding::float_above(rounding::wide(a) / rounding::wide(b));
        } else {
            const V quotient = a / b, product = quotient * b;
            if (!(rounding::is_moderate(quotient) && lanes::has_product_error(quotient, b, product))) [[unlikely]]
                return lanes::one_by_one([](double x, double y) { return rounding::divide_up(x, y, x / y); }, a, b);
            // The difference is exact, being small, and so is the residual a - quotient b (Markstein 1990).
            const V residual = (a - product) - lanes::product_error(quotient, b, product);
            return rounding::raise_if_positive(b > 0 ? residual : -residual, quotient);
        }
    }

    template <class V>
    static V sqrt_up(V x) {
        return root<V, false>(x);
    }
    template <class V>
    static V sqrt_down(V x) {
        return -root<V, true>(x);
    }

    // a b + c as a sum of three numbers, each at most half a unit of the last place of the one before: then the sign of
    // the last two decides (the steps are those of Boldo and Muller, Exact and approximated error of the FMA, 2011).
    template <class V>
    static V fma_up(V a, V b, V c) {
        if constexpr (rounding::by_double<V>) {
            const auto product = rounding::wide(a) * rounding::wide(b), x = rounding::wide(c), sum = product + x;
            return rounding::float_above(sum, rounding::sum_error(product, x, sum));
        } else {
            const V product = a * b;
            const V low = lanes::product_error(a, b, product);
            const V tail = c + low, tail_error = rounding::sum_error(c, low, tail);
            const V sum = product + tail, error = rounding::sum_error(product, tail, sum);
            const V middle = error + tail_error, last = rounding::sum_error(error, tail_error, middle);
            const V first = sum + middle, second = rounding::sum_error(sum, middle, first);
            if (!(lanes::has_product_error(a, b, product) && rounding::is_moderate(first) &&
                  lanes::all_between(lanes::magnitude(c), 0, 0x1p1020))) [[unlikely]]
                return lanes::one_by_one(
                    [](double x, double y, double z) { return rounding::fma_up(x, y, z, std::fma(x, y, z)); }, a, b, c);
            return rounding::raise_if_positive(second + last, first);
        }
    }

    // Toward minus infinity everything is the mirror image, signed zeros too.
    template <class V>
    static V subtract_up(V a, V b) {
        return add_up(a, -b);
    }
    template <class V>
    static V add_down(V a, V b) {
        return -add_up(-a, -b);
    }
    template <class V>
    static V subtract_down(V a, V b) {
        return -add_up(-a, b);
    }
    template <class V>
    static V multiply_down(V a, V b) {
        return -multiply_up(-a, b);
    }
    template <class V>
    static V divide_down(V a, V b) {
        return -divide_up(-a, b);
    }
    template <class V>
    static V fma_down(V a, V b, V c) {
        return -fma_up(-a, b, -c);
    }

  private:
    // The root rounded up, or if `mirrored` minus the root, rounded up.
    template <class V, bool mirrored>
    static V root(V x) {
        if constexpr (rounding::by_double<V>) {
            const auto nearest = lanes::square_root(rounding::wide(x));
            return rounding::float_above(mirrored ? -nearest : nearest);
        } else {
            const V nearest = lanes::square_root(x), product = nearest * nearest;
            if (!lanes::all_between(x, 0x1p-900, 0x1p900)) [[unlikely]]
                return lanes::one_by_one([](double y) { return root_slow<mirrored>(y); }, x);
            const V residual = (x - product) - lanes::product_error(nearest, nearest, product);
            return mirrored ? rounding::raise_if_positive(-residual, -nearest)
                            : rounding::raise_if_positive(residual, nearest);
        }
    }
    template <bool mirrored>
    static double root_slow(double x) {
        if (!(x > 0 && x < std::numeric_limits<double>::infinity())) return mirrored ? -std::sqrt(x) : std::sqrt(x);
        if (x < 0x1p-900) return 0x1p-100 * root<double, mirrored>(0x1p200 * x);
        if (x >= 0x1p900) return 0x1p100 * root<double, mirrored>(0x1p-200 * x);
        return root<double, mirrored>(x);
    }
};

}  // namespace raybound
