// Eight numbers side by side: the compiler's vector types as a number type for kernels. Lane by lane the same bits as
// the scalar type, on every instruction level.
#pragma once

#include <bit>
#include <cstdint>
#include <type_traits>
#ifdef __AVX__
#include <immintrin.h>
#endif

#include "raybound/numbers/float_bits.h"

namespace raybound {

inline constexpr int pack_width = 8;

template <class T>
struct PackStorage {
    typedef T type __attribute__((vector_size(sizeof(T) * pack_width)));
};

template <class T>
using PackVector = typename PackStorage<T>::type;

template <class T>
constexpr PackVector<T> in_every_lane(T x) {
    return PackVector<T>{x, x, x, x, x, x, x, x};
}

// What a comparison of packs gives: all bits of a lane, or none.
template <class T>
struct PackMask {
    using Integer = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
    PackVector<Integer> lanes;

    PackMask() = default;
    constexpr PackMask(PackVector<Integer> all_or_none) : lanes(all_or_none) {}
    explicit PackMask(bool every) : lanes(in_every_lane(every ? Integer(-1) : Integer(0))) {}
    template <class S>
    explicit PackMask(const PackMask<S>& o) : lanes(__builtin_convertvector(o.lanes, PackVector<Integer>)) {}

    PackMask operator&(const PackMask& o) const { return {lanes & o.lanes}; }
    PackMask operator|(const PackMask& o) const { return {lanes | o.lanes}; }
    PackMask operator!=(const PackMask& o) const { return {lanes ^ o.lanes}; }
    PackMask operator!() const { return {~lanes}; }
};

// One bit for each lane, the first lane's lowest.
template <class T>
inline std::uint32_t bits(const PackMask<T>& mask) {
#ifdef __AVX512DQ__  // one instruction there; it takes the sign bits, which are the lanes' own
    if constexpr (sizeof(T) == 8) return _mm512_movepi64_mask(std::bit_cast<__m512i>(mask.lanes));
#endif
#ifdef __AVX__
    return std::uint32_t(_mm256_movemask_ps(std::bit_cast<__m256>(PackMask<float>(mask).lanes)));
#else
    typedef std::int8_t Bytes __attribute__((vector_size(pack_width)));
    const auto bytes = std::bit_cast<std::uint64_t>(__builtin_convertvector(mask.lanes, Bytes));
    return std::uint32_t(((bytes & 0x8040201008040201u) * 0x0101010101010101u) >> 56);
#endif
}

// The lanes of a set of bits.
template <class T>
inline PackMask<T> lanes_of(std::uint32_t set) {
    using Integer = typename PackMask<T>::Integer;
    constexpr PackVector<Integer> bit{1, 2, 4, 8, 16, 32, 64, 128};
    return {(in_every_lane(Integer(set)) & bit) != 0};
}

template <class T>
inline bool none(const PackMask<T>& mask) {
    return bits(mask) == 0;
}

template <class T>
struct alignas(sizeof(T) * pack_width) Pack {
    PackVector<T> v;

    constexpr Pack() : v{} {}
    constexpr Pack(PackVector<T> lanes) : v(lanes) {}
    constexpr explicit Pack(T x) : v(in_every_lane(x)) {}
    template <class S>
    explicit Pack(const Pack<S>& o) : v(__builtin_convertvector(o.v, PackVector<T>)) {}
    template <class S>
    static Pack load(const S* p) {
        typedef S Unaligned __attribute__((vector_size(sizeof(S) * pack_width), aligned(alignof(S)), may_alias));
        return {__builtin_convertvector(*reinterpret_cast<const Unaligned*>(p), PackVector<T>)};
    }
    T operator[](int lane) const { return v[lane]; }

    friend Pack operator+(const Pack& a, const Pack& b) { return {a.v + b.v}; }
    friend Pack operator-(const Pack& a, const Pack& b) { return {a.v - b.v}; }
    friend Pack operator*(const Pack& a, const Pack& b) { return {a.v * b.v}; }
    friend Pack operator/(const Pack& a, const Pack& b) { return {a.v / b.v}; }
    friend Pack operator-(const Pack& a) { return {-a.v}; }
    friend PackMask<T> operator<(const Pack& a, const Pack& b) { return {a.v < b.v}; }
    friend PackMask<T> operator<=(const Pack& a, const Pack& b) { return {a.v <= b.v}; }
    friend PackMask<T> operator>(const Pack& a, const Pack& b) { return {a.v > b.v}; }
    friend PackMask<T> operator>=(const Pack& a, const Pack& b) { return {a.v >= b.v}; }
    friend constexpr PackMask<T> operator==(const Pack& a, const Pack& b) { return {a.v == b.v}; }
};

template <class T>
inline constexpr Pack<T> infinity<Pack<T>>{infinity<T>};

// Small integers, one for each lane of a Pack<T>.
template <class T>
struct PackIndex {
    using Integer = typename PackMask<T>::Integer;
    PackVector<Integer> v;

    PackIndex() : v{} {}
    PackIndex(int i) : v(in_every_lane(Integer(i))) {}
    PackIndex(PackVector<Integer> lanes) : v(lanes) {}
    explicit PackIndex(const Pack<T>& a) : v(__builtin_convertvector(a.v, PackVector<Integer>)) {}
    int operator[](int lane) const { return int(v[lane]); }

    friend PackIndex operator+(const PackIndex& a, const PackIndex& b) { return {a.v + b.v}; }
    friend PackIndex operator-(const PackIndex& a, const PackIndex& b) { return {a.v - b.v}; }
    friend PackMask<T> operator<(const PackIndex& a, const PackIndex& b) { return {a.v < b.v}; }
    friend PackMask<T> operator>=(const PackIndex& a, const PackIndex& b) { return {a.v >= b.v}; }
    friend PackMask<T> operator==(const PackIndex& a, const PackIndex& b) { return {a.v == b.v}; }
};

template <class T>
struct NumberTraits<Pack<T>> {
    using Mask = PackMask<T>;
    using Wide = Pack<typename NumberTraits<T>::Wide>;
    static constexpr T unit_roundoff = NumberTraits<T>::unit_roundoff;
};

template <class T>
struct ScalarOf<Pack<T>> {
    using type = T;
};
template <class T>
struct IndexOf<Pack<T>> {
    using type = PackIndex<T>;
};

template <class T>
    requires(!std::is_same_v<Scalar<T>, T>)
inline T gamma(int n) {
    return T(gamma<Scalar<T>>(n));
}

template <class T>
inline Pack<T> minimum(const Pack<T>& a, const Pack<T>& b) {
    return {b.v < a.v ? b.v : a.v};
}
template <class T>
inline Pack<T> maximum(const Pack<T>& a, const Pack<T>& b) {
    return {b.v > a.v ? b.v : a.v};
}
template <class T>
inline Pack<T> select(const PackMask<T>& mask, const Pack<T>& yes, const Pack<T>& no) {
    return {mask.lanes ? yes.v : no.v};
}
template <class T>
inline PackIndex<T> select(const PackMask<T>& mask, const PackIndex<T>& yes, const PackIndex<T>& no) {
    return {mask.lanes ? yes.v : no.v};
}
template <class T>
inline PackMask<T> select(const PackMask<T>& mask, const PackMask<T>& yes, const PackMask<T>& no) {
    return {(mask.lanes & yes.lanes) | (~mask.lanes & no.lanes)};
}
template <class T>
inline Pack<T> abs(const Pack<T>& a) {
    using Integer = typename PackMask<T>::Integer;
    constexpr Integer sign_off = std::numeric_limits<Integer>::max();
    return {std::bit_cast<PackVector<T>>(std::bit_cast<PackVector<Integer>>(a.v) & sign_off)};
}
template <class T>
inline Pack<T> square(const Pack<T>& a) {
    return a * a;
}

}  // namespace raybound
