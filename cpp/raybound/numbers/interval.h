// Closed intervals of real numbers, IEEE 1788-2015's set-based ones: the operations of arithmetic are tight to the bit.
#pragma once

#include <algorithm>
#include <concepts>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "raybound/numbers/arithmetic.h"
#include "raybound/numbers/number.h"
#include "raybound/numbers/rounding.h"
#include "raybound/numbers/verdict.h"

namespace raybound {

// The reals x with inf <= x <= sup: infinite ends are not members. Empty is [+inf, -inf].
// With Arithmetic::float32 the ends also bound every float32 execution (arithmetic.h): as rounding to nearest is
// monotone, it is enough that the ends rounded to float32 lie inside.
template <std::floating_point T, Arithmetic A = Arithmetic::real, class Rounding = DirectedRounding>
class Interval {
  public:
    using Value = T;
    static constexpr Arithmetic arithmetic = A;
    static constexpr bool also_float32 = A == Arithmetic::float32 && !std::is_same_v<T, float>;
    static constexpr T largest_finite = std::numeric_limits<T>::max();

    constexpr Interval() : inf_(0), sup_(0) {}
    constexpr Interval(T inf, T sup) : inf_(inf), sup_(sup) {}

    // The tightest interval that holds x, and x rounded to float32 where executions in it count. Infinity becomes the
    // interval of numbers too large, NaN the entire line.
    template <class S>
        requires std::is_arithmetic_v<S>
    constexpr Interval(S x) : inf_(static_cast<T>(x)), sup_(inf_) {
        if constexpr (std::is_same_v<T, float> && !std::is_same_v<S, float>) {
            const auto wide = static_cast<double>(x);
            if (double(inf_) > wide) inf_ = next_float_down(inf_);
            if (double(sup_) < wide) sup_ = next_float_up(sup_);
        }
        if (!(inf_ > -infinity<T> && sup_ < infinity<T>)) {
            inf_ = inf_ == infinity<T> ? largest_finite : inf_ > -infinity<T> ? inf_ : -infinity<T>;
            sup_ = sup_ == -infinity<T> ? -largest_finite : sup_ < infinity<T> ? sup_ : infinity<T>;
        }
        if constexpr (also_float32) *this = rounded(inf_, sup_);
    }

    // For values from outside. Throws std::invalid_argument if an end is NaN, if they are reversed, or if no real
    // number lies between them.
    static Interval checked(T inf, T sup) {
        if (!(inf <= sup && inf < infinity<T> && sup > -infinity<T>))
            throw std::invalid_argument("Interval: inf must be <= sup and both numbers, got inf = " +
                                        std::to_string(inf) + ", sup = " + std::to_string(sup));
        return {inf, sup};
    }
    static constexpr Interval empty() { return {infinity<T>, -infinity<T>}; }
    static constexpr Interval entire() { return {-infinity<T>, infinity<T>}; }

    // The result of an operation with these ends, already rounded outward.
    static constexpr Interval rounded(T inf, T sup) {
        if constexpr (also_float32)
            return {std::min(inf, T(static_cast<float>(inf))), std::max(sup, T(static_cast<float>(sup)))};
        return {inf, sup};
    }

    constexpr T inf() const { return inf_; }
    constexpr T sup() const { return sup_; }
    constexpr bool is_empty() const { return !(inf_ <= sup_); }
    constexpr bool is_entire() const { return inf_ == -infinity<T> && sup_ == infinity<T>; }
    constexpr bool contains(T x) const { return inf_ <= x && x <= sup_ && x - x == 0; }
    constexpr bool contains_zero() const { return inf_ <= 0 && sup_ >= 0; }

    // NaN of the empty interval, as IEEE 1788 has it. mid is finite and rounded to nearest, rad and wid are rounded up.
    constexpr T mid() const {
        if (is_empty()) return std::numeric_limits<T>::quiet_NaN();
        if (inf_ == -sup_) return 0;
        if (inf_ == -infinity<T>) return -largest_finite;
        if (sup_ == infinity<T>) return largest_finite;
        const T sum = inf_ + sup_;
        return sum - sum == 0 ? sum / 2 : inf_ / 2 + sup_ / 2;
    }
    T rad() const {
        const T m = mid();
        return is_empty() ? m : std::max(Rounding::subtract_up(m, inf_), Rounding::subtract_up(sup_, m));
    }
    T wid() const { return is_empty() ? std::numeric_limits<T>::quiet_NaN() : Rounding::subtract_up(sup_, inf_); }
    constexpr T mag() const {
        return is_empty() ? std::numeric_limits<T>::quiet_NaN() : std::max(std::abs(inf_), std::abs(sup_));
    }
    constexpr T mig() const {
        if (is_empty()) return std::numeric_limits<T>::quiet_NaN();
        return contains_zero() ? T(0) : std::min(std::abs(inf_), std::abs(sup_));
    }

    friend bool operator==(const Interval& a, const Interval& b) {
        return (a.inf_ == b.inf_ && a.sup_ == b.sup_) || (a.is_empty() && b.is_empty());
    }

    friend Interval operator-(const Interval& a) { return {-a.sup_, -a.inf_}; }
    friend Interval operator+(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return empty();
        return rounded(Rounding::add_down(a.inf_, b.inf_), Rounding::add_up(a.sup_, b.sup_));
    }
    friend Interval operator-(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return empty();
        return rounded(Rounding::subtract_down(a.inf_, b.sup_), Rounding::subtract_up(a.sup_, b.inf_));
    }
    friend Interval operator*(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return empty();
        return rounded(std::min(std::min(product_down(a.inf_, b.inf_), product_down(a.inf_, b.sup_)),
                                std::min(product_down(a.sup_, b.inf_), product_down(a.sup_, b.sup_))),
                       std::max(std::max(product_up(a.inf_, b.inf_), product_up(a.inf_, b.sup_)),
                                std::max(product_up(a.sup_, b.inf_), product_up(a.sup_, b.sup_))));
    }
    // A divisor that holds 0 leaves it out, so that 1 / [0, 1] is [1, inf] and x / [0, 0] is empty; in float32, where
    // executions divide by 0 of either sign, the result is the entire line.
    friend Interval operator/(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return empty();
        if (b.inf_ > 0) return divide_by_positive(a, b);
        if (b.sup_ < 0) return divide_by_positive(-a, -b);
        if (A == Arithmetic::float32) return entire();
        if (b.inf_ == 0 && b.sup_ == 0) return empty();
        if (a.inf_ == 0 && a.sup_ == 0) return {T(0), T(0)};
        if (b.inf_ == 0) return divide_by_zero_to(a, b.sup_);
        if (b.sup_ == 0) return divide_by_zero_to(-a, -b.inf_);
        return entire();
    }

    // Of every x of a and y of b: x < y. Nothing is known of no values.
    friend Verdict operator<(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return Verdict::unknown;
        return a.sup_ < b.inf_ ? Verdict::yes : a.inf_ >= b.sup_ ? Verdict::no : Verdict::unknown;
    }
    friend Verdict operator<=(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return Verdict::unknown;
        return a.sup_ <= b.inf_ ? Verdict::yes : a.inf_ > b.sup_ ? Verdict::no : Verdict::unknown;
    }
    friend Verdict operator>(const Interval& a, const Interval& b) { return b < a; }
    friend Verdict operator>=(const Interval& a, const Interval& b) { return b <= a; }

    friend Interval hull(const Interval& a, const Interval& b) {
        return {std::min(a.inf_, b.inf_), std::max(a.sup_, b.sup_)};
    }
    friend Interval intersection(const Interval& a, const Interval& b) {
        const Interval both{std::max(a.inf_, b.inf_), std::min(a.sup_, b.sup_)};
        return both.is_empty() ? empty() : both;
    }
    friend Interval select(Verdict which, const Interval& yes, const Interval& no) {
        return which == Verdict::unknown ? hull(yes, no) : which == Verdict::yes ? yes : no;
    }
    friend Interval minimum(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return empty();
        return {std::min(a.inf_, b.inf_), std::min(a.sup_, b.sup_)};
    }
    friend Interval maximum(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return empty();
        return {std::max(a.inf_, b.inf_), std::max(a.sup_, b.sup_)};
    }
    friend Interval abs(const Interval& x) { return x.is_empty() ? empty() : Interval{x.mig(), x.mag()}; }
    friend Interval square(const Interval& x) {
        if (x.is_empty()) return empty();
        const T least = x.mig(), most = x.mag();
        return rounded(Rounding::multiply_down(least, least), Rounding::multiply_up(most, most));
    }
    // Of the part of x that is not negative.
    friend Interval sqrt(const Interval& x) {
        if (!(x.sup_ >= 0)) return empty();
        return rounded(Rounding::sqrt_down(std::max(x.inf_, T(0))), Rounding::sqrt_up(x.sup_));
    }
    friend Interval reciprocal(const Interval& x) { return Interval(T(1)) / x; }
    // 1 / sqrt(x) of the positive part of x, at most 2 ulp wider per side than the tightest.
    friend Interval rsqrt(const Interval& x) { return reciprocal(sqrt(x)); }
    friend Interval fma(const Interval& a, const Interval& b, const Interval& c) {
        if (a.is_empty() || b.is_empty() || c.is_empty()) return empty();
        const auto down = [&](T x, T y) { return x == 0 || y == 0 ? c.inf_ : Rounding::fma_down(x, y, c.inf_); };
        const auto up = [&](T x, T y) { return x == 0 || y == 0 ? c.sup_ : Rounding::fma_up(x, y, c.sup_); };
        return rounded(corner_hull(a, b, down).inf_, corner_hull(a, b, up).sup_);
    }

  private:
    // 0 times an infinite end is 0: the end is no member.
    static T product_down(T x, T y) { return x == 0 || y == 0 ? T(0) : Rounding::multiply_down(x, y); }
    static T product_up(T x, T y) { return x == 0 || y == 0 ? T(0) : Rounding::multiply_up(x, y); }

    template <class F>
    static Interval corner_hull(const Interval& a, const Interval& b, F f) {
        const T v[] = {f(a.inf_, b.inf_), f(a.inf_, b.sup_), f(a.sup_, b.inf_), f(a.sup_, b.sup_)};
        T low = infinity<T>, high = -infinity<T>;
        for (T x : v) {
            if (x != x) return entire();  // infinities of both signs meet
            low = std::min(low, x), high = std::max(high, x);
        }
        return {low, high};
    }
    static Interval divide_by_positive(const Interval& a, const Interval& b) {
        return rounded(Rounding::divide_down(a.inf_, a.inf_ >= 0 ? b.sup_ : b.inf_),
                       Rounding::divide_up(a.sup_, a.sup_ >= 0 ? b.inf_ : b.sup_));
    }
    static Interval divide_by_zero_to(const Interval& a, T sup) {
        if (a.inf_ >= 0) return rounded(Rounding::divide_down(a.inf_, sup), infinity<T>);
        if (a.sup_ <= 0) return rounded(-infinity<T>, Rounding::divide_up(a.sup_, sup));
        return entire();
    }

    T inf_, sup_;
};

template <std::floating_point T, Arithmetic A, class Rounding>
struct NumberTraits<Interval<T, A, Rounding>> {
    using Mask = Verdict;
    using Wide = Interval<double, A, Rounding>;
    static constexpr T unit_roundoff = NumberTraits<T>::unit_roundoff;
};

static_assert(Number<Interval<float>> && Number<Interval<double>>);

}  // namespace raybound
