// What a Taylor model says: its range, how far multilinear interpolation can be off, its value at a point; and the same
// function over a part of the domain, or over other variables (cpp/derivations.md, D33).
#pragma once

#include <algorithm>

#include "raybound/numbers/interval.h"
#include "raybound/numbers/taylor_model.h"

namespace raybound {

// The least and largest value of l x + q x^2 for |x| <= 1, rounded outward: at the ends, or at -l / (2 q) if it lies
// between them.
inline Interval<double> quadratic_range(double l, double q) {
    const double slope = std::abs(l), bend = std::abs(q);
    const double vertex = slope < 2 * bend ? 0.25 * slope * (slope / bend) * upward : 0;
    const Interval<double> up(-std::fmax(slope - bend, vertex), bend + slope);
    const Interval<double> x = q < 0 ? -up : up;
    const double slack = 0x1p-51 * (slope + bend) + underflow_bound;
    return x + Interval<double>(-slack, slack);
}

// All values over the cell: the pure parts of each variable exactly, the mixed ones by their absolute values.
template <int N, Arithmetic A>
inline Interval<double> range(const TaylorModel<N, A>& f) {
    if (!f.is_known()) return Interval<double>::entire();
    Interval<double> sum(f.constant());
    double rest = 0;
    for (int i = 0; i < N; ++i) {
        sum = sum + quadratic_range(f.linear(i), f.pure(i));
        for (int j = i + 1; j < N; ++j) rest += std::abs(f.mixed(i, j));
    }
    rest = (rest + f.remainder()) * upward;
    const Interval<double> whole = sum + Interval<double>(-rest, rest);
    return {std::fmax(whole.inf(), f.low()), std::fmin(whole.sup(), f.high())};
}

// A bound of |f - If|, where If interpolates f multilinearly between the cell's corners: exact on 1, x_i and x_i x_j,
// off by q_i (1 - x_i^2) in each pure square, and by the remainder at the point and at the corners.
template <int N, Arithmetic A>
inline double interpolation_bound(const TaylorModel<N, A>& f) {
    double positive = 0, negative = 0;
    for (int i = 0; i < N; ++i) {
        positive += std::fmax(f.pure(i), 0.0);
        negative += std::fmax(-f.pure(i), 0.0);
    }
    return (std::fmax(positive, negative) + 2 * f.remainder()) * upward;
}

// The value at a point of [-1, 1]^N: what is evaluated in double, widened by its roundings (at most 14 for each term,
// two of each coordinate included) and by the remainder.
template <int N, Arithmetic A>
inline Interval<double> value_at(const TaylorModel<N, A>& f, const double* x) {
    if (!f.is_known()) return Interval<double>::entire();
    double sum = f.constant();
    for (int i = 0; i < N; ++i) {
        double inner = f.linear(i) + f.pure(i) * x[i];
        for (int j = i + 1; j < N; ++j) inner += f.mixed(i, j) * x[j];
        sum += inner * x[i];
    }
    if (!std::isfinite(sum)) return range(f);
    const Interval<double> off(0, (f.remainder() + 0x1p-48 * f.known() + underflow_bound) * upward);
    return Interval<double>(sum) + off - off;
}

// The same function of variables y, where each x_i is a function of y with values in [-1, 1]: an affine map, such as a
// part of the cell or a fixed eye's dependence between coordinates, leaves nothing out.
template <int N, Arithmetic A, int M>
inline TaylorModel<M, A> substitute(const TaylorModel<N, A>& f,
                                    const std::array<TaylorModel<M, Arithmetic::real>, std::size_t(N)>& x) {
    using Real = TaylorModel<M, Arithmetic::real>;
    if (!f.is_known()) return TaylorModel<M, A>::entire();
    Real sum(f.constant());
    for (std::size_t i = 0; i < N; ++i) {
        Real inner = Real(f.linear(int(i))) + Real(f.pure(int(i))) * x[i];
        for (std::size_t j = i + 1; j < N; ++j) inner = inner + Real(f.mixed(int(i), int(j))) * x[j];
        sum = sum + inner * x[i];
    }
    return TaylorModel<M, A>(Real::certified(sum.polynomial(), sum.remainder() + f.remainder()));
}

// The normalised coordinates of a cell as functions of new variables y_j = centers[j] + radii[j] eta_j:
// xi_i = (constants[i] + sum_j slopes[i][j] y_j - center_i) / radius_i.
template <int M>
inline TaylorModel<M> normalised_coordinate(double center, double radius, double constant, const double* slopes,
                                            const double* centers, const double* radii) {
    using Real = TaylorModel<M>;
    if (radius == 0) return Real(0);
    Real x(constant);
    for (int j = 0; j < M; ++j) x = x + Real(slopes[j]) * Real::variable(j, centers[j], radii[j]);
    return (x - Real(center)) / Real(radius);
}

}  // namespace raybound
