// Directed rounding: add, subtract, multiply, divide, sqrt and fma toward minus and plus infinity, for float and
// double. The only file that rounds in a direction; the processor's rounding mode is neither read nor changed.
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

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

#include "raybound/numbers/exact.h"
#include "raybound/numbers/float_bits.h"

#if defined(__FAST_MATH__)
#error "raybound: error-free transformations are wrong under -ffast-math"
#endif

namespace raybound {

namespace rounding {

// The neighbour above, where a rounding to nearest fell below its exact value.
template <std::floating_point T>
inline T raise_if(bool below, T nearest) {
#ifdef RAYBOUND_SABOTAGE_ROUNDING
    return below ? nearest : nearest;
#else
    return below ? next_float_up(nearest) : nearest;
#endif
}

// The float at or above d + e, where d is the double nearest to d + e. If d is no float, no float lies between d and
// d + e, as every float is a double; if it is one, the sign of e decides.
inline float float_above(double d, double e = 0) {
    const float f = static_cast<float>(d);
    return raise_if(double(f) < d || (double(f) == d && e > 0), f);
}

// a + b - sum exactly, sum = fl(a + b) (Knuth's TwoSum): it cannot underflow, and cannot overflow for
// |sum| < 2^1022 (only for |a| or |b| equal to the largest number: Boldo, Graillat, Muller 2017).
template <std::floating_point T>
inline T sum_error(T a, T b, T sum) {
    const T b_part = sum - a, a_part = sum - b_part;
    return (a - a_part) + (b - b_part);
}

// The slow paths, for results near underflow or overflow. Operands are scaled by powers of two to [1/2, 1), where the
// residual's sign is exact; `nearest` is the result rounded to nearest.
[[gnu::noinline]] inline double add_up_at_overflow(double a, double b, double nearest) {
    if (std::isinf(a) || std::isinf(b) || std::isnan(nearest)) return nearest;
    if (std::isinf(nearest)) return raise_if(nearest < 0, nearest);
    const double big = std::abs(a) > std::abs(b) ? a : b, small = std::abs(a) > std::abs(b) ? b : a;
    return raise_if(small - (nearest - big) > 0, nearest);  // Dekker's FastTwoSum: |nearest - big| <= 2 |small|
}

[[gnu::noinline]] inline double multiply_up_slow(double a, double b, double nearest) {
    if (a == 0 || b == 0 || std::isinf(a) || std::isinf(b) || std::isnan(nearest)) return nearest;
    if (std::isinf(nearest)) return raise_if(nearest < 0, nearest);
    int a_exponent, b_exponent;
    const double x = std::frexp(a, &a_exponent), y = std::frexp(b, &b_exponent);
    const double scaled = std::ldexp(nearest, -(a_exponent + b_exponent));
    return raise_if(std::fma(x, y, -scaled) > 0, nearest);
}

[[gnu::noinline]] inline double divide_up_slow(double a, double b, double nearest) {
    if (a == 0 || b == 0 || std::isinf(a) || std::isinf(b) || std::isnan(nearest)) return nearest;
    if (std::isinf(nearest)) return raise_if(nearest < 0, nearest);
    int a_exponent, b_exponent;
    const double x = std::frexp(a, &a_exponent), y = std::frexp(b, &b_exponent);
    const double scaled = std::ldexp(nearest, b_exponent - a_exponent);
    const double residual = std::fma(-scaled, y, x);  // (a / b - nearest) b, scaled
    return raise_if(y > 0 ? residual > 0 : residual < 0, nearest);
}

// The sign of a b + c - nearest, for finite numbers with a b != 0, in units of 2^(the product's exponent).
inline double fma_residual(double a, double b, double c, double nearest) {
    int a_exponent, b_exponent, c_exponent;
    const double x = std::frexp(a, &a_exponent), y = std::frexp(b, &b_exponent), z = std::frexp(c, &c_exponent);
    const int unit = a_exponent + b_exponent;
    if (c != 0 && c_exponent - unit > 200) return x * y;  // the product is lost beside c: nearest = c
    // Below 2^-200 only c's sign counts: x y - nearest is a multiple of 2^-106, or zero.
    const double scaled_c =
        c_exponent - unit < -200 ? std::copysign(z == 0 ? 0.0 : 0x1p-200, c) : std::ldexp(z, c_exponent - unit);
    ExactSum<4> residual;
    residual.add_product(x, y);
    residual.add(scaled_c);
    residual.add(-std::ldexp(nearest, -unit));
    return residual.value();
}

[[gnu::noinline]] inline double fma_up_slow(double a, double b, double c, double nearest) {
    if (std::isinf(a) || std::isinf(b) || std::isinf(c) || std::isnan(nearest)) return nearest;
    if (a == 0 || b == 0) return nearest;
    if (std::isinf(nearest)) return raise_if(nearest < 0, nearest);
    return raise_if(fma_residual(a, b, c, nearest) > 0, nearest);
}

}  // namespace rounding

// By the exact residual of rounding to nearest and one step of next-float. Toward minus infinity is the mirror image,
// for signed zeros too.
struct PortableRounding {
    // float by way of double: a product of floats is exact there. A quotient or root that is no float differs from
    // every float by 2^-48 of itself at least (its residual is a multiple of the operands' last places), more than
    // double's rounding, so that it never looks like one.
    static float add_up(float a, float b) {
        const double d = double(a) + double(b);
        return rounding::float_above(d, rounding::sum_error(double(a), double(b), d));
    }
    static float multiply_up(float a, float b) { return rounding::float_above(double(a) * double(b)); }
    static float divide_up(float a, float b) { return rounding::float_above(double(a) / double(b)); }
    static float sqrt_up(float x) { return rounding::float_above(std::sqrt(double(x))); }
    static float sqrt_down(float x) {
        const double root = std::sqrt(double(x));
        return -rounding::float_above(-root);
    }
    static float fma_up(float a, float b, float c) {
        const double product = double(a) * double(b), d = product + double(c);
        return rounding::float_above(d, rounding::sum_error(product, double(c), d));
    }

    static double add_up(double a, double b) {
        const double sum = a + b;
        if (!(std::abs(sum) < 0x1p1022)) return rounding::add_up_at_overflow(a, b, sum);
        return rounding::raise_if(rounding::sum_error(a, b, sum) > 0, sum);
    }
    // The residual a b - product is a multiple of 2^-106 |product| and so representable from 2^-968 on.
    static double multiply_up(double a, double b) {
        const double product = a * b, size = std::abs(product);
        if (!(size >= 0x1p-960 && size < infinity<double>)) return rounding::multiply_up_slow(a, b, product);
        return rounding::raise_if(std::fma(a, b, -product) > 0, product);
    }
    static double divide_up(double a, double b) {
        const double quotient = a / b, size = std::abs(quotient);
        if (!(std::abs(a) >= 0x1p-960 && size >= 0x1p-1022 && size < infinity<double>))
            return rounding::divide_up_slow(a, b, quotient);
        const double residual = std::fma(-quotient, b, a);
        return rounding::raise_if(b > 0 ? residual > 0 : residual < 0, quotient);
    }
    static double sqrt_up(double x) {
        if (x > 0 && x < 0x1p-960) return 0x1p-100 * sqrt_up(0x1p200 * x);
        const double root = std::sqrt(x);
        return rounding::raise_if(std::fma(-root, root, x) > 0, root);  // NaN for infinity and NaN: left as they are
    }
    static double sqrt_down(double x) {
        if (x > 0 && x < 0x1p-960) return 0x1p-100 * sqrt_down(0x1p200 * x);
        const double root = std::sqrt(x);
        return -rounding::raise_if(std::fma(-root, root, x) < 0, -root);
    }
    // The error of a fused multiply-add is ((s - nearest) + s_error) + p_error, the last addition rounded and the
    // others exact (Boldo and Muller, Exact and approximated error of the FMA, 2011).
    static double fma_up(double a, double b, double c) {
        const double nearest = std::fma(a, b, c), product = a * b, size = std::abs(product);
        if (!(size >= 0x1p-960 && size < 0x1p1020 && std::abs(c) < 0x1p1020))
            return rounding::fma_up_slow(a, b, c, nearest);
        const double low = std::fma(a, b, -product);
        const double tail = c + low, tail_error = rounding::sum_error(c, low, tail);
        const double sum = product + tail, error = rounding::sum_error(product, tail, sum);
        return rounding::raise_if(((sum - nearest) + error) + tail_error > 0, nearest);
    }

    template <std::floating_point T>
    static T subtract_up(T a, T b) {
        return add_up(a, -b);
    }
    template <std::floating_point T>
    static T add_down(T a, T b) {
        return -add_up(-a, -b);
    }
    template <std::floating_point T>
    static T subtract_down(T a, T b) {
        return -add_up(-a, b);
    }
    template <std::floating_point T>
    static T multiply_down(T a, T b) {
        return -multiply_up(-a, b);
    }
    template <std::floating_point T>
    static T divide_down(T a, T b) {
        return -divide_up(-a, b);
    }
    template <std::floating_point T>
    static T fma_down(T a, T b, T c) {
        return -fma_up(-a, b, -c);
    }
};

#ifdef __AVX512F__

// By instructions that carry their own rounding mode.
struct HardwareRounding {
#ifdef RAYBOUND_SABOTAGE_ROUNDING
    static constexpr int up = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC, down = up;
#else
    static constexpr int up = _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC;
    static constexpr int down = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
#endif
    static __m128d load(double x) { return _mm_set_sd(x); }
    static __m128 load(float x) { return _mm_set_ss(x); }
    static double value(__m128d x) { return _mm_cvtsd_f64(x); }
    static float value(__m128 x) { return _mm_cvtss_f32(x); }

    static double add_up(double a, double b) { return value(_mm_add_round_sd(load(a), load(b), up)); }
    static double add_down(double a, double b) { return value(_mm_add_round_sd(load(a), load(b), down)); }
    static double subtract_up(double a, double b) { return value(_mm_sub_round_sd(load(a), load(b), up)); }
    static double subtract_down(double a, double b) { return value(_mm_sub_round_sd(load(a), load(b), down)); }
    static double multiply_up(double a, double b) { return value(_mm_mul_round_sd(load(a), load(b), up)); }
    static double multiply_down(double a, double b) { return value(_mm_mul_round_sd(load(a), load(b), down)); }
    static double divide_up(double a, double b) { return value(_mm_div_round_sd(load(a), load(b), up)); }
    static double divide_down(double a, double b) { return value(_mm_div_round_sd(load(a), load(b), down)); }
    static double sqrt_up(double x) { return value(_mm_sqrt_round_sd(load(x), load(x), up)); }
    static double sqrt_down(double x) { return value(_mm_sqrt_round_sd(load(x), load(x), down)); }
    static double fma_up(double a, double b, double c) {
        return value(_mm_fmadd_round_sd(load(a), load(b), load(c), up));
    }
    static double fma_down(double a, double b, double c) {
        return value(_mm_fmadd_round_sd(load(a), load(b), load(c), down));
    }

    static float add_up(float a, float b) { return value(_mm_add_round_ss(load(a), load(b), up)); }
    static float add_down(float a, float b) { return value(_mm_add_round_ss(load(a), load(b), down)); }
    static float subtract_up(float a, float b) { return value(_mm_sub_round_ss(load(a), load(b), up)); }
    static float subtract_down(float a, float b) { return value(_mm_sub_round_ss(load(a), load(b), down)); }
    static float multiply_up(float a, float b) { return value(_mm_mul_round_ss(load(a), load(b), up)); }
    static float multiply_down(float a, float b) { return value(_mm_mul_round_ss(load(a), load(b), down)); }
    static float divide_up(float a, float b) { return value(_mm_div_round_ss(load(a), load(b), up)); }
    static float divide_down(float a, float b) { return value(_mm_div_round_ss(load(a), load(b), down)); }
    static float sqrt_up(float x) { return value(_mm_sqrt_round_ss(load(x), load(x), up)); }
    static float sqrt_down(float x) { return value(_mm_sqrt_round_ss(load(x), load(x), down)); }
    static float fma_up(float a, float b, float c) { return value(_mm_fmadd_round_ss(load(a), load(b), load(c), up)); }
    static float fma_down(float a, float b, float c) {
        return value(_mm_fmadd_round_ss(load(a), load(b), load(c), down));
    }
};

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
