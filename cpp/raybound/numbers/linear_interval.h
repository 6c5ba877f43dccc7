// LinearInterval: linear bounds of a function over a cell (Hansen 1975; thesis 4.3.5).
//
// The cell is [-1, 1]^N; `variable` maps a centre and a radius onto it. A function f is enclosed by
//
//     f(x) in F(x) = K + sum_i L_i x_i   and   f(x) in range      for every x in [-1, 1]^N,
//
// with intervals K (the constant), L_i (the slopes, per radius of the cell) and `range`, which plain interval
// arithmetic computes beside F and which holds where F does worse. All ends are rounded outward.
//
// A LinearInterval is bounded or *entire*. Entire is the answer to a domain error (the root of a range that reaches
// below zero, a divisor that reaches zero) and to overflow, and it absorbs: what is computed from it is entire. So no
// later operation hides that something was undefined; `is_entire` is the flag, and there is no NaN.
//
// Derivations: D20 (products), D21 (functions), D22 (the bound of interpolation).
#pragma once

#include <algorithm>
#include <array>

#include "raybound/numbers/interval.h"

namespace raybound {

// How the terms of second order that a product or a function makes are folded back into K and L.
enum class LinearRule : unsigned char {
    hansen,               // into the slopes, by derivatives over the whole range
    second_order,         // into K, as one square: never wider at the corners than either of the others' foldings (D21)
    second_order_slopes,  // pure squares into K, mixed terms into the slopes (thesis, end of 4.3.5)
};

template <int N, LinearRule R = LinearRule::second_order>
class LinearInterval {
    static_assert(N >= 1);

  public:
    using Bound = Interval<double>;
    using Slopes = std::array<Bound, N>;
    static constexpr int variables = N;
    static constexpr LinearRule rule = R;

    LinearInterval() : LinearInterval(0.0) {}
    LinearInterval(double constant) : LinearInterval(Bound(constant)) {}
    explicit LinearInterval(const Bound& constant) : LinearInterval(constant, zero_slopes(), constant) {}
    // `range` holds f too, whatever K and the slopes say.
    LinearInterval(const Bound& constant, const Slopes& slopes, const Bound& range = Bound::entire())
        : constant_(constant), slope_(slopes), range_(intersection(range, linear_range())) {
        settle();
    }

    static LinearInterval entire() { return LinearInterval(Bound::entire()); }
    // The i-th variable over [center - radius, center + radius].
    static LinearInterval variable(int i, double center, double radius) {
        Slopes slopes = zero_slopes();
        slopes[i] = Bound(radius);
        return {Bound(center), slopes};
    }

    const Bound& constant() const { return constant_; }
    const Bound& slope(int i) const { return slope_[i]; }
    const Slopes& slopes() const { return slope_; }
    const Bound& range() const { return range_; }
    bool is_entire() const { return !is_bounded(constant_); }

    // sum_i |L_i|: how far f strays from K.
    double reach() const {
        double sum = 0;
        for (const Bound& slope : slope_) sum = add_up(sum, slope.mag());
        return sum;
    }
    // The range over the corners of the cell (the thesis's): that of F alone.
    Bound linear_range() const {
        const double size = reach();
        return constant_ + Bound(-size, size);
    }
    // The width of F at a corner, the same at each: w(K) + sum_i w(L_i).
    double corner_bound() const {
        double sum = constant_.wid();
        for (const Bound& slope : slope_) sum = add_up(sum, slope.wid());
        return sum;
    }
    // |f - If| for the multilinear interpolant If of f's values at the corners (D22).
    double interpolation_bound() const { return std::min(corner_bound(), range_.wid()); }

    // An enclosure of f at a point of the cell.
    Bound operator()(const std::array<double, N>& x) const {
        Bound value = constant_;
        for (int i = 0; i < N; ++i) value = value + slope_[i] * Bound(x[i]);
        return intersection(value, range_);
    }

    LinearInterval operator-() const {
        Slopes slopes;
        for (int i = 0; i < N; ++i) slopes[i] = -slope_[i];
        return {-constant_, slopes, -range_};
    }
    friend LinearInterval operator+(const LinearInterval& a, const LinearInterval& b) {
        Slopes slopes;
        for (int i = 0; i < N; ++i) slopes[i] = a.slope_[i] + b.slope_[i];
        return {a.constant_ + b.constant_, slopes, a.range_ + b.range_};
    }
    friend LinearInterval operator-(const LinearInterval& a, const LinearInterval& b) {
        Slopes slopes;
        for (int i = 0; i < N; ++i) slopes[i] = a.slope_[i] - b.slope_[i];
        return {a.constant_ - b.constant_, slopes, a.range_ - b.range_};
    }
    // Times a constant that lies in the interval.
    LinearInterval scaled(const Bound& factor) const {
        if (is_entire()) return *this;
        Slopes slopes;
        for (int i = 0; i < N; ++i) slopes[i] = slope_[i] * factor;
        return {constant_ * factor, slopes, range_ * factor};
    }
    friend LinearInterval operator*(const LinearInterval& a, double b) { return a.scaled(Bound(b)); }
    friend LinearInterval operator*(double a, const LinearInterval& b) { return b * a; }

  private:
    static bool is_bounded(const Bound& b) { return b.inf() > -infinity<double> && b.sup() < infinity<double>; }
    static Slopes zero_slopes() {
        Slopes slopes;
        slopes.fill(Bound(0.0));
        return slopes;
    }

    // Where the slopes are unbounded, or F is wider at the corners than the range, the range alone is kept.
    void settle() {
        if (corner_bound() < range_.wid()) return;
        if (range_.is_empty() || !is_bounded(range_)) range_ = Bound::entire();
        constant_ = range_;
        slope_ = zero_slopes();
    }

    Bound constant_;
    Slopes slope_;
    Bound range_;
};

template <int N, LinearRule R>
struct NumberTraits<LinearInterval<N, R>> {
    using Mask = Verdict;
    using Wide = LinearInterval<N, R>;
    static constexpr double unit_roundoff = NumberTraits<double>::unit_roundoff;
};

}  // namespace raybound
