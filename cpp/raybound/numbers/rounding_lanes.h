// What directed rounding needs of its operands, written once for a number and for several side by side: `V` is float,
// double, or one of the compiler's vectors of them.
#pragma once

#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <type_traits>
#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace raybound {

template <class T, int n>
struct LanesOf {
    typedef T type __attribute__((vector_size(sizeof(T) * n)));
};
template <class T, int n>
using Lanes = typename LanesOf<T, n>::type;

// As many doubles as registers hold: compilers split longer vectors badly.
#if defined(__AVX512F__)
inline constexpr int native_lanes = 8;
#elif defined(__AVX__)
inline constexpr int native_lanes = 4;
#else
inline constexpr int native_lanes = 2;
#endif

namespace lanes {

template <class V>
struct Traits {
    using Value = std::remove_cvref_t<decltype(V{}[0])>;
    static constexpr int count = sizeof(V) / sizeof(Value);
    template <class T>
    using With = Lanes<T, count>;
};
template <class V>
    requires std::is_arithmetic_v<V>
struct Traits<V> {
    using Value = V;
    static constexpr int count = 1;
    template <class T>
    using With = T;
};

template <class V>
using Value = typename Traits<V>::Value;
template <class V>
inline constexpr int count = Traits<V>::count;
template <class V, class T>
using With = typename Traits<V>::template With<T>;  // as many lanes, of another type
template <class V>
using Bits = With<V, std::conditional_t<sizeof(Value<V>) == 4, std::int32_t, std::int64_t>>;

template <class V>
inline V every(Value<V> x) {
    if constexpr (count<V> == 1)
        return x;
    else
        return x - V{};  // x - 0, not x + 0: keeps -0
}
template <class To, class V>
inline To convert(V x) {
    if constexpr (count<V> == 1)
        return static_cast<To>(x);
    else
        return __builtin_convertvector(x, To);
}
template <class V>
inline V magnitude(V x) {
    if constexpr (count<V> == 1)
        return std::abs(x);
    else
        return std::bit_cast<V>(std::bit_cast<Bits<V>>(x) & std::numeric_limits<Value<Bits<V>>>::max());
}
// x with the signs of the lanes where `signs` is negative flipped.
template <class V, class... Signs>
inline V flipped(V x, Signs... signs) {
    constexpr Value<Bits<V>> sign_bit = std::numeric_limits<Value<Bits<V>>>::min();
    return std::bit_cast<V>(std::bit_cast<Bits<V>>(x) ^ Bits<V>{(signs < 0 ? sign_bit : 0)...});
}
// b where a is NaN.
template <class V>
inline V greater(V a, V b) {
#ifdef __AVX512F__
    if constexpr (sizeof(V) == 64 && count<V> == 8) return (V)_mm512_maskz_max_pd(0xff, (__m512d)a, (__m512d)b);
#endif
#ifdef __SSE2__
    if constexpr (sizeof(V) == 16 && count<V> == 2) return (V)_mm_max_pd((__m128d)a, (__m128d)b);
#endif
    return a > b ? a : b;
}

// Whether a comparison holds in every lane.
template <class M>
inline bool all(M mask) {
    if constexpr (count<M> == 1) return mask;
#ifdef __AVX512DQ__
    else if constexpr (sizeof(M) == 64 && count<M> == 8)
        return _mm512_movepi64_mask((__m512i)mask) == 0xff;
#endif
#ifdef __AVX__
    else if constexpr (sizeof(M) == 32 && count<M> == 4)
        return _mm256_movemask_pd((__m256d)mask) == 0xf;
    else if constexpr (sizeof(M) == 32 && count<M> == 8)
        return _mm256_movemask_ps((__m256)mask) == 0xff;
#endif
#ifdef __SSE2__
    else if constexpr (sizeof(M) == 16 && count<M> == 2)
        return _mm_movemask_pd((__m128d)mask) == 3;
    else if constexpr (sizeof(M) == 16 && count<M> == 4)
        return _mm_movemask_ps((__m128)mask) == 0xf;
#endif
    else {
        Value<M> each = -1;
        for (int i = 0; i < count<M>; ++i) each &= mask[i];
        return each != 0;
    }
}
template <class V>
inline bool all_between(V x, Value<V> low, Value<V> high) {
    return all((x >= low) & (x < high));
}

template <class V>
inline bool all_finite(V x) {
#if defined(__AVX512DQ__) && defined(__AVX512VL__)
    constexpr int not_finite = 0x99;  // quiet and signalling NaN, either infinity
    if constexpr (sizeof(V) == 64 && count<V> == 8)
        return _mm512_fpclass_pd_mask((__m512d)x, not_finite) == 0;
    else if constexpr (sizeof(V) == 16 && count<V> == 2)
        return _mm_fpclass_pd_mask((__m128d)x, not_finite) == 0;
    else
#endif
        return all(magnitude(x) < every<V>(std::numeric_limits<Value<V>>::infinity()));
}

// x where `sign` is positive, else 0. A number is masked as a vector is: its sign cannot be predicted, and compilers
// would branch.
template <class V>
inline V where_positive(V sign, V x) {
    if constexpr (count<V> == 1) {
        using Two = Lanes<Value<V>, 16 / sizeof(V)>;
        return where_positive(Two{sign}, Two{x})[0];
    } else {
        return std::bit_cast<V>(std::bit_cast<Bits<V>>(x) & (sign > V{}));
    }
}

template <class V>
inline V square_root(V x) {
    if constexpr (count<V> == 1) return std::sqrt(x);
#ifdef __AVX512F__
    else if constexpr (sizeof(V) == 64 && count<V> == 8)
        return (V)_mm512_maskz_sqrt_pd(0xff, (__m512d)x);
#endif
    else {
        V root{};
        for (int i = 0; i < count<V>; ++i) root[i] = std::sqrt(x[i]);
        return root;
    }
}

// f lane by lane, for what is rare.
template <class Function, class V, class... Vs>
[[gnu::noinline]] V one_by_one(Function f, V first, Vs... others) {
    if constexpr (count<V> == 1) {
        return f(first, others...);
    } else {
        V result{};
        for (int i = 0; i < count<V>; ++i) result[i] = f(first[i], others[i]...);
        return result;
    }
}

// a b - product for product = fl(a b) between 2^-960 and 2^1022, exactly: it is a multiple of 2^-106 |product|.
#ifdef __FMA__
inline double product_error(double a, double b, double product) { return std::fma(a, b, -product); }
inline Lanes<double, 2> product_error(Lanes<double, 2> a, Lanes<double, 2> b, Lanes<double, 2> product) {
    return (Lanes<double, 2>)_mm_fmsub_pd((__m128d)a, (__m128d)b, (__m128d)product);
}
#ifdef __AVX__
inline Lanes<double, 4> product_error(Lanes<double, 4> a, Lanes<double, 4> b, Lanes<double, 4> product) {
    return (Lanes<double, 4>)_mm256_fmsub_pd((__m256d)a, (__m256d)b, (__m256d)product);
}
#endif
#ifdef __AVX512F__
inline Lanes<double, 8> product_error(Lanes<double, 8> a, Lanes<double, 8> b, Lanes<double, 8> product) {
    return (Lanes<double, 8>)_mm512_fmsub_pd((__m512d)a, (__m512d)b, (__m512d)product);
}
#endif
template <class V>
inline bool has_product_error(V, V, V product) {
    return all_between(magnitude(product), 0x1p-960, 0x1p1022);
}
#else
// Dekker's (1971), by halves of 26 bits, of which the splitting must not overflow: where there is no instruction, the
// library's fma is as exact but many times slower.
template <class V>
inline V product_error(V a, V b, V product) {
    constexpr double splitter = 0x1p27 + 1;
    const V a_scaled = splitter * a, a_high = a_scaled - (a_scaled - a), a_low = a - a_high;
    const V b_scaled = splitter * b, b_high = b_scaled - (b_scaled - b), b_low = b - b_high;
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}
template <class V>
inline bool has_product_error(V a, V b, V product) {
    return all_between(magnitude(product), 0x1p-960, 0x1p1022) &&
           all_between(greater(magnitude(a), magnitude(b)), 0, 0x1p990);
}
#endif

// The same of two products at once. A NaN in p passes `lesser` and fails there, one in q fails in `greater`.
template <class V>
inline bool have_product_errors([[maybe_unused]] V a, [[maybe_unused]] V b, V product, [[maybe_unused]] V c,
                                [[maybe_unused]] V d, V other) {
    const V p = magnitude(product), q = magnitude(other);
    const V lesser = q < p ? q : p;
#ifndef __FMA__
    if (!all_between(greater(greater(magnitude(a), magnitude(b)), greater(magnitude(c), magnitude(d))), 0, 0x1p990))
        return false;
#endif
    return all((lesser >= 0x1p-960) & (greater(p, q) < 0x1p1022));
}

}  // namespace lanes
}  // namespace raybound
