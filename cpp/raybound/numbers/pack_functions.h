// The functions of packs beyond arithmetic: roots, bits, neighbours and elementary functions, lane by lane the same
// bits as the scalar functions of these names.
#pragma once

#include <cstring>

#include "raybound/numbers/elementary.h"
#include "raybound/numbers/pack.h"

namespace raybound {

namespace packs {

template <class T>
using Integers = PackVector<typename PackMask<T>::Integer>;

template <class T>
inline Integers<T> to_bits(const Pack<T>& a) {
    return std::bit_cast<Integers<T>>(a.v);
}
template <class T>
inline Pack<T> from_bits(Integers<T> bits) {
    return {std::bit_cast<PackVector<T>>(bits)};
}
template <class T>
inline constexpr auto sign_bit = std::numeric_limits<typename PackMask<T>::Integer>::min();

}  // namespace packs

// A function of single lanes, where there is no operation of packs. (Compilers make one instruction of a loop over an
// array where they have one.)
template <class T, class Function>
inline Pack<T> lane_by_lane(const Pack<T>& a, const Function& function) {
    T lanes[pack_width];
    std::memcpy(lanes, &a.v, sizeof lanes);
    for (T& lane : lanes) lane = function(lane);
    Pack<T> result;
    std::memcpy(&result.v, lanes, sizeof lanes);
    return result;
}

template <class T>
inline Pack<T> sqrt(const Pack<T>& a) {
#ifdef __AVX512F__
    if constexpr (sizeof(T) == 8)
        return {std::bit_cast<PackVector<T>>(_mm512_maskz_sqrt_pd(0xff, std::bit_cast<__m512d>(a.v)))};
#endif
#ifdef __AVX__
    if constexpr (sizeof(T) == 4) return {std::bit_cast<PackVector<T>>(_mm256_sqrt_ps(std::bit_cast<__m256>(a.v)))};
#endif
    return lane_by_lane(a, [](T x) { return std::sqrt(x); });
}
template <class T>
inline Pack<T> rsqrt(const Pack<T>& a) {
    return Pack<T>(T(1)) / sqrt(a);
}
template <class T>
inline Pack<T> floor(const Pack<T>& a) {
    return lane_by_lane(a, [](T x) { return std::floor(x); });
}

template <class T>
inline Pack<T> copysign(const Pack<T>& size, const Pack<T>& sign) {
    using namespace packs;
    return from_bits<T>((to_bits(size) & ~sign_bit<T>) | (to_bits(sign) & sign_bit<T>));
}

// The power of two at or below |x|, for x normal.
template <class T>
inline Pack<T> power_of_two_below(const Pack<T>& x) {
    using namespace packs;
    return from_bits<T>(to_bits(x) & to_bits(infinity<Pack<T>>));
}

template <class T>
inline Pack<T> next_float_up(const Pack<T>& x) {
    using namespace packs;
    const Pack<T> zero;
    const Integers<T> bits = to_bits(x);
    const Pack<T> moved = from_bits<T>((x > zero).lanes ? bits + 1 : bits - 1);
    const Pack<T> up = select(x == zero, Pack<T>(std::numeric_limits<T>::denorm_min()), moved);
    return select(x < infinity<Pack<T>>, up, x);
}
template <class T>
inline Pack<T> next_float_down(const Pack<T>& x) {
    return -next_float_up(-x);
}

// As for one double (elementary.h): 2^k for the integer k in the low bits.
inline Pack<double> power_of_two(const Pack<double>& shifted) {
    return packs::from_bits<double>((packs::to_bits(shifted) + 1023) << 52);
}

inline Pack<float> exp(const Pack<float>& x) { return elementary::rounded_exp(x); }
inline Pack<float> atan2(const Pack<float>& y, const Pack<float>& x) { return elementary::rounded_atan2(y, x); }
inline Pack<float> acos(const Pack<float>& x) { return elementary::rounded_acos(x); }

static_assert(Number<Pack<float>> && Number<Pack<double>>);

}  // namespace raybound
