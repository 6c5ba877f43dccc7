// Products, quotients and squares of linear intervals (derivation D20).
#pragma once

#include "raybound/numbers/linear_interval.h"

namespace raybound {

namespace linear_intervals {

using Bound = Interval<double>;

inline Bound symmetric(double size) { return {-size, size}; }

// (sum_i |L_i|)^2 bounds (sum_i L_i x_i)^2, which is no less than 0.
inline Bound square_of_reach(double reach) { return {0, multiply_up(reach, reach)}; }

// Encloses (sum_i u_i x_i)(sum_i v_i x_i): a difference of two squares, 4 p u v = (p u + v)^2 - (p u - v)^2 for every
// p > 0; the best p makes both forms equally large.
template <std::size_t N>
inline Bound product_of_forms(const std::array<Bound, N>& u, const std::array<Bound, N>& v) {
    double u_size = 0, v_size = 0;
    for (std::size_t i = 0; i < N; ++i) u_size = add_up(u_size, u[i].mag()), v_size = add_up(v_size, v[i].mag());
    if (u_size == 0 || v_size == 0) return Bound(0.0);
    const double p = v_size / u_size;
    if (!(p > 0 && p < infinity<double>)) return symmetric(multiply_up(u_size, v_size));
    double sum = 0, difference = 0;
    for (std::size_t i = 0; i < N; ++i) {
        const Bound scaled = u[i] * Bound(p);
        sum = add_up(sum, (scaled + v[i]).mag());
        difference = add_up(difference, (scaled - v[i]).mag());
    }
    return (square_of_reach(sum) - square_of_reach(difference)) / (Bound(p) * Bound(4.0));
}

// Hansen's folding of the same product (thesis 4.3.5): x_i^2 u_i v_i to the constant, x_i x_j u_i v_j to slope i.
template <std::size_t N>
struct FoldedForms {
    Bound constant;
    std::array<Bound, N> slopes;
};

template <std::size_t N>
inline FoldedForms<N> fold_into_slopes(const std::array<Bound, N>& u, const std::array<Bound, N>& v) {
    FoldedForms<N> folded{Bound(0.0), {}};
    for (std::size_t i = 0; i < N; ++i) {
        double others = 0;
        for (std::size_t j = 0; j < N; ++j)
            if (j != i) others = add_up(others, v[j].mag());
        folded.constant = folded.constant + hull(Bound(0.0), u[i] * v[i]);
        folded.slopes[i] = symmetric(multiply_up(u[i].mag(), others));
    }
    return folded;
}

}  // namespace linear_intervals

template <int N, LinearRule R>
inline LinearInterval<N, R> operator*(const LinearInterval<N, R>& a, const LinearInterval<N, R>& b) {
    if (a.is_entire() || b.is_entire()) return LinearInterval<N, R>::entire();
    if (a.reach() == 0) return b.scaled(a.constant());
    if (b.reach() == 0) return a.scaled(b.constant());
    auto constant = a.constant() * b.constant();
    typename LinearInterval<N, R>::Slopes slopes;
    for (int i = 0; i < N; ++i) slopes[i] = a.constant() * b.slope(i) + b.constant() * a.slope(i);
    if constexpr (R == LinearRule::second_order) {
        constant = constant + linear_intervals::product_of_forms(a.slopes(), b.slopes());
    } else {
        const auto folded = linear_intervals::fold_into_slopes(a.slopes(), b.slopes());
        constant = constant + folded.constant;
        for (int i = 0; i < N; ++i) slopes[i] = slopes[i] + folded.slopes[i];
    }
    return {constant, slopes, a.range() * b.range()};
}

// With q = a_0 / b_0 and the form w = sum_i (a_i - q b_i) x_i, exactly
//     a / b = q + w / b = q + w / b_0 - w (b - b_0) / (b_0 b).
template <int N, LinearRule R>
inline LinearInterval<N, R> operator/(const LinearInterval<N, R>& a, const LinearInterval<N, R>& b) {
    using Result = LinearInterval<N, R>;
    if (a.is_entire() || b.is_entire() || b.range().contains_zero()) return Result::entire();
    const auto plain = a.range() / b.range();
    if (b.constant().contains_zero()) return Result(plain);
    auto constant = a.constant() / b.constant();
    typename Result::Slopes slopes;
    for (int i = 0; i < N; ++i) slopes[i] = a.slope(i) - constant * b.slope(i);
    if constexpr (R == LinearRule::second_order) {
        constant = constant - linear_intervals::product_of_forms(slopes, b.slopes()) / (b.constant() * b.range());
        for (int i = 0; i < N; ++i) slopes[i] = slopes[i] / b.constant();
    } else {
        for (int i = 0; i < N; ++i) slopes[i] = slopes[i] / b.range();
    }
    return {constant, slopes, plain};
}

template <int N, LinearRule R>
inline LinearInterval<N, R> square(const LinearInterval<N, R>& x) {
    if (x.is_entire()) return x;
    auto constant = square(x.constant());
    typename LinearInterval<N, R>::Slopes slopes;
    const auto twice = x.constant() * linear_intervals::Bound(2.0);
    for (int i = 0; i < N; ++i) slopes[i] = twice * x.slope(i);
    if constexpr (R == LinearRule::second_order) {
        constant = constant + linear_intervals::square_of_reach(x.reach());
    } else {
        const auto folded = linear_intervals::fold_into_slopes(x.slopes(), x.slopes());
        for (int i = 0; i < N; ++i) {
            constant = constant + linear_intervals::square_of_reach(x.slope(i).mag());
            slopes[i] = slopes[i] + folded.slopes[i];
        }
    }
    return {constant, slopes, square(x.range())};
}

}  // namespace raybound
