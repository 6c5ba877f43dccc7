// How the coefficients of a quadratic polynomial in N = 2 or 4 variables lie in vectors of four doubles, so that a
// product is a handful of vector operations: 1/2 and 2 registers of 512 bits, or as many of 256 as the processor has.
//
//   N = 2:  [c l1 l2 0] [q1 q2 x12 0]
//   N = 4:  [c x12 x34 0] [l1 l2 l3 l4] [q1 q2 q3 q4] [x13 x24 x14 x23]
//
// for c + sum l_i x_i + sum q_i x_i^2 + sum_{i<j} x_ij x_i x_j. Unused lanes are zero, always.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace raybound {

typedef double Four __attribute__((vector_size(32)));

// For what is a few instructions: as calls they would pass coefficients through memory.
#define RAYBOUND_INLINE [[gnu::always_inline]] inline

namespace four {

template <int... lane>
RAYBOUND_INLINE Four permute(Four v) {
    return __builtin_shufflevector(v, v, lane...);
}
RAYBOUND_INLINE Four broadcast(double x) { return Four{x, x, x, x}; }

typedef std::int64_t Bits __attribute__((vector_size(32)));
RAYBOUND_INLINE Four keep(Four v, Bits mask) { return std::bit_cast<Four>(std::bit_cast<Bits>(v) & mask); }
RAYBOUND_INLINE Four absolute(Four v) {
    constexpr std::int64_t sign_off = 0x7fffffffffffffff;
    return keep(v, Bits{sign_off, sign_off, sign_off, sign_off});
}

// The sums of two vectors' lanes.
struct Sums {
    double first, second;
};
RAYBOUND_INLINE Sums sums(Four a, Four b) {
    const Four pairs = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
    return {pairs[0] + pairs[2], pairs[1] + pairs[3]};
}

inline constexpr Bits middle{0, -1, -1, 0}, not_first{0, -1, -1, -1};

}  // namespace four

// Where a coefficient lies.
struct TaylorPlace {
    int part, lane;
};

template <int N>
struct TaylorLayout;

template <>
struct TaylorLayout<2> {
    static constexpr int parts = 2;
    static constexpr TaylorPlace linear(int i) { return {0, 1 + i}; }
    static constexpr TaylorPlace pure(int i) { return {1, i}; }
    static constexpr TaylorPlace mixed(int, int) { return {1, 2}; }
};

template <>
struct TaylorLayout<4> {
    static constexpr int parts = 4;
    static constexpr TaylorPlace linear(int i) { return {1, i}; }
    static constexpr TaylorPlace pure(int i) { return {2, i}; }
    static constexpr TaylorPlace mixed(int i, int j) {
        constexpr TaylorPlace places[4][4] = {{{}, {0, 1}, {3, 0}, {3, 2}},
                                              {{0, 1}, {}, {3, 3}, {3, 1}},
                                              {{3, 0}, {3, 3}, {}, {0, 2}},
                                              {{3, 2}, {3, 1}, {0, 2}, {}}};
        return places[i][j];
    }
};

// The polynomial's coefficients, without any bound of error.
template <int N>
struct TaylorPolynomial {
    using Layout = TaylorLayout<N>;
    Four part[Layout::parts];

    // Copied part by part: as one block of bytes they would be read in pieces wider than those just written, which
    // stalls processors (measured: half of all time).
    RAYBOUND_INLINE TaylorPolynomial() {
        for (int i = 0; i < Layout::parts; ++i) part[i] = Four{};
    }
    RAYBOUND_INLINE TaylorPolynomial(const TaylorPolynomial& o) {
        for (int i = 0; i < Layout::parts; ++i) part[i] = o.part[i];
    }
    RAYBOUND_INLINE TaylorPolynomial& operator=(const TaylorPolynomial& o) {
        for (int i = 0; i < Layout::parts; ++i) part[i] = o.part[i];
        return *this;
    }

    double constant() const { return part[0][0]; }
    double at(TaylorPlace place) const { return part[place.part][place.lane]; }
    void set(TaylorPlace place, double x) { part[place.part][place.lane] = x; }
    double linear(int i) const { return at(Layout::linear(i)); }
    double pure(int i) const { return at(Layout::pure(i)); }
    double mixed(int i, int j) const { return at(Layout::mixed(i, j)); }

    RAYBOUND_INLINE friend TaylorPolynomial operator+(const TaylorPolynomial& a, const TaylorPolynomial& b) {
        TaylorPolynomial sum;
        for (int i = 0; i < Layout::parts; ++i) sum.part[i] = a.part[i] + b.part[i];
        return sum;
    }
    RAYBOUND_INLINE friend TaylorPolynomial operator-(const TaylorPolynomial& a, const TaylorPolynomial& b) {
        TaylorPolynomial difference;
        for (int i = 0; i < Layout::parts; ++i) difference.part[i] = a.part[i] - b.part[i];
        return difference;
    }
    RAYBOUND_INLINE friend TaylorPolynomial operator*(const TaylorPolynomial& a, double s) {
        TaylorPolynomial scaled;
        for (int i = 0; i < Layout::parts; ++i) scaled.part[i] = a.part[i] * s;
        return scaled;
    }
    RAYBOUND_INLINE TaylorPolynomial without_constant() const {
        TaylorPolynomial rest = *this;
        rest.part[0] = four::keep(part[0], four::not_first);
        return rest;
    }

    // The sums of the absolute coefficients of degree 1 and 2.
    RAYBOUND_INLINE four::Sums norms() const {
        if constexpr (N == 2) {
            return four::sums(four::absolute(four::keep(part[0], four::middle)), four::absolute(part[1]));
        } else {
            return four::sums(four::absolute(part[1]), four::absolute(part[2]) + four::absolute(part[3]) +
                                                           four::absolute(four::keep(part[0], four::middle)));
        }
    }
};

// Adds the products of the linear parts of a and b, times `factor`, which are of degree 2.
template <int N>
RAYBOUND_INLINE void add_linear_product(TaylorPolynomial<N>& sum, const TaylorPolynomial<N>& a,
                                        const TaylorPolynomial<N>& b, double factor) {
    using four::permute;
    if constexpr (N == 2) {
        const Four la = a.part[0] * factor, lb = b.part[0];
        sum.part[1] = sum.part[1] + (permute<1, 2, 1, 3>(la) * permute<1, 2, 2, 3>(lb) +
                                     permute<3, 3, 2, 3>(la) * permute<3, 3, 1, 3>(lb));
    } else {
        const Four la = a.part[1] * factor, lb = b.part[1];
        sum.part[0] = sum.part[0] + four::keep(permute<0, 0, 2, 0>(la) * permute<0, 1, 3, 0>(lb) +
                                                   permute<0, 1, 3, 0>(la) * permute<0, 0, 2, 0>(lb),
                                               four::middle);
        sum.part[2] = sum.part[2] + la * lb;
        sum.part[3] = sum.part[3] + (permute<0, 1, 0, 1>(la) * permute<2, 3, 3, 2>(lb) +
                                     permute<2, 3, 3, 2>(la) * permute<0, 1, 0, 1>(lb));
    }
}

// All of the product up to degree 2. Of the sum of absolute values of what is added up here, which is at most
// (|a0| + |A1| + |A2|)(|b0| + |B1| + |B2|), each coefficient is off by at most gamma_5.
template <int N>
RAYBOUND_INLINE TaylorPolynomial<N> product(const TaylorPolynomial<N>& a, const TaylorPolynomial<N>& b) {
    TaylorPolynomial<N> product = b * a.constant() + a.without_constant() * b.constant();
    add_linear_product(product, a, b, 1);
    return product;
}

}  // namespace raybound
