// Closed intervals of real numbers with IEEE 1788-2015's set-based arithmetic, tight to the bit: sums, products,
// quotients, squares, roots and fused products. Powers and elementary functions: interval_functions.h.
#pragma once

#include <concepts>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "raybound/numbers/arithmetic.h"
#include "raybound/numbers/number.h"
#include "raybound/numbers/rounding.h"
#include "raybound/numbers/verdict.h"

namespace raybound {

// The reals x with inf <= x <= sup; infinite ends are no members. The empty interval is [+inf, -inf].
//
// Invariant: kept as the pair (-inf, sup), so that both ends round up and a sum is one operation on two lanes; either
// -inf > -infinity and sup > -infinity, and -inf + sup >= 0, or both are -infinity (empty); no NaN.
//
// With Arithmetic::float32 the ends also bound every float32 execution (arithmetic.h): rounding to nearest is monotone,
// so it is enough that the ends rounded to float32 lie inside. An execution may reach infinity where an end is
// infinite.
template <std::floating_point T, Arithmetic A = Arithmetic::real, class Rounding = DirectedRounding>
class Interval {
  public:
    using Value = T;
    using Ends = Lanes<T, 2>;
    static constexpr Arithmetic arithmetic = A;

    Interval() : ends_{} {}
    Interval(T inf, T sup) : ends_{-inf, sup} {}

    // The least interval that holds x, and x rounded to float32 where that counts. Of infinity it is that of numbers
    // larger than all finite ones, of NaN the entire line.
    template <class S>
        requires std::floating_point<S> || (std::integral<S> && sizeof(S) <= 4)  // exact in double
    Interval(S x) : ends_{-static_cast<T>(x), static_cast<T>(x)} {
        if constexpr (!std::is_same_v<S, T>) *this = outward(static_cast<double>(x), static_cast<double>(x));
        if (!(ends_[1] - ends_[1] == 0)) *this = of_special(ends_[1]);
        *this = with_float32(ends_);
    }

    // For values from outside. Throws std::invalid_argument if an end is NaN, if they are reversed, or if no real
    // number lies between them.
    static Interval checked(T inf, T sup) {
        if (!(inf <= sup && inf < infinity<T> && sup > -infinity<T>))
            throw std::invalid_argument("Interval: inf must be <= sup with a real number between them, got inf = " +
                                        std::to_string(inf) + ", sup = " + std::to_string(sup));
        return {inf, sup};
    }
    static Interval empty() { return {infinity<T>, -infinity<T>}; }
    static Interval entire() { return {-infinity<T>, infinity<T>}; }
    // The result of an operation on the real line that is [inf, sup], perhaps empty.
    static Interval outward(double inf, double sup) {
        const Lanes<double, 2> ends{-inf, sup};
        if constexpr (std::is_same_v<T, float>)
            return Interval(rounding::float_above(ends));
        else
            return with_float32(ends);
    }

    T inf() const { return 0 - ends_[0]; }  // never -0, as sup
    T sup() const { return 0 + ends_[1]; }
    bool is_empty() const { return ends_[1] == -infinity<T>; }
    bool is_entire() const { return ends_[0] == infinity<T> && ends_[1] == infinity<T>; }
    bool contains(T x) const { return -ends_[0] <= x && x <= ends_[1] && x - x == 0; }
    bool contains_zero() const { return ends_[0] >= 0 && ends_[1] >= 0; }

    // All NaN for the empty interval. mid is finite and rounded to nearest, rad and wid are rounded up.
    T mid() const {
        const T low = inf(), high = sup();
        if (is_empty()) return std::numeric_limits<T>::quiet_NaN();
        if (low == -high) return 0;
        if (low == -infinity<T>) return -std::numeric_limits<T>::max();
        if (high == infinity<T>) return std::numeric_limits<T>::max();
        const T sum = low + high;
        return sum - sum == 0 ? sum / 2 : low / 2 + high / 2;
    }
    T rad() const { return maximum(Rounding::subtract_up(mid(), inf()), Rounding::subtract_up(sup(), mid())); }
    T wid() const { return is_empty() ? std::numeric_limits<T>::quiet_NaN() : Rounding::add_up(ends_[1], ends_[0]); }
    T mag() const {
        return is_empty() ? std::numeric_limits<T>::quiet_NaN() : maximum(std::abs(ends_[0]), std::abs(ends_[1]));
    }
    T mig() const {
        if (is_empty()) return std::numeric_limits<T>::quiet_NaN();
        return maximum(maximum(-ends_[0], -ends_[1]), T(0));
    }

    // The same set.
    bool is_same(const Interval& other) const { return lanes::all(ends_ == other.ends_); }

    friend Interval operator-(const Interval& x) { return Interval(swapped(x.ends_)); }
    friend Interval operator+(const Interval& a, const Interval& b) { return sum(a.ends_, b.ends_); }
    friend Interval operator-(const Interval& a, const Interval& b) { return sum(a.ends_, swapped(b.ends_)); }
    friend Interval operator*(const Interval& a, const Interval& b) {
        if constexpr (std::is_same_v<Rounding, PortableRounding>) {
            const Factors f = factors(a, b);
            Ends greater;
            if (Rounding::try_greater_product_up(f.inf, f.of_inf, f.sup, f.of_sup, greater)) [[likely]]
                return with_float32(greater);
            return products_apart(a, b);
        }
        return of_products(a, b, Rounding::template multiply_up<Ends>);
    }
    friend Interval fma(const Interval& a, const Interval& b, const Interval& c) {
        if (c.is_empty()) return empty();
        return of_products(a, b, [&](Ends x, Ends y) { return Rounding::fma_up(x, y, c.ends_); });
    }
    // A divisor's 0 is left out: 1 / [0, 1] is [1, inf], 1 / [0, 0] is empty. In float32, where executions divide by
    // zeros of either sign, the result is the entire line.
    friend Interval operator/(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return empty();
        if (b.ends_[0] < 0) return quotient(a.ends_, b);
        if (b.ends_[1] < 0) return quotient(swapped(a.ends_), -b);
        return quotient_at_zero(a, b);
    }

    // Of every x in a and every y in b: x < y. Of no values, nothing is known.
    friend Verdict operator<(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return Verdict::unknown;
        return a.sup() < b.inf() ? Verdict::yes : a.inf() >= b.sup() ? Verdict::no : Verdict::unknown;
    }
    friend Verdict operator<=(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return Verdict::unknown;
        return a.sup() <= b.inf() ? Verdict::yes : a.inf() > b.sup() ? Verdict::no : Verdict::unknown;
    }
    friend Verdict operator>(const Interval& a, const Interval& b) { return b < a; }
    friend Verdict operator>=(const Interval& a, const Interval& b) { return b <= a; }

    friend Interval hull(const Interval& a, const Interval& b) { return Interval(lanes::greater(a.ends_, b.ends_)); }
    friend Interval intersection(const Interval& a, const Interval& b) {
        const Ends both = a.ends_ < b.ends_ ? a.ends_ : b.ends_;
        return -both[0] <= both[1] ? Interval(both) : empty();
    }
    friend Interval select(Verdict which, const Interval& yes, const Interval& no) {
        return which == Verdict::unknown ? hull(yes, no) : which == Verdict::yes ? yes : no;
    }
    friend Interval minimum(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return empty();
        return {minimum(a.inf(), b.inf()), minimum(a.sup(), b.sup())};
    }
    friend Interval maximum(const Interval& a, const Interval& b) {
        if (a.is_empty() || b.is_empty()) return empty();
        return {maximum(a.inf(), b.inf()), maximum(a.sup(), b.sup())};
    }
    friend Interval abs(const Interval& x) { return x.is_empty() ? empty() : Interval(x.mig(), x.mag()); }

    friend Interval square(const Interval& x) {
        if (x.is_empty()) return empty();
        const T least = x.mig(), most = x.mag();
        return with_float32(Rounding::multiply_up(Ends{-least, most}, Ends{least, most}));
    }
    // Of the part of x that is not negative.
    friend Interval sqrt(const Interval& x) {
        if (!(x.sup() >= 0)) return empty();
        return with_float32(Ends{-Rounding::sqrt_down(maximum(x.inf(), T(0))), Rounding::sqrt_up(x.sup())});
    }
    friend Interval reciprocal(const Interval& x) { return Interval(T(1)) / x; }
    // Of the positive part of x: at most 2 ulp wider per side than the tightest, as it rounds twice.
    friend Interval rsqrt(const Interval& x) { return reciprocal(sqrt(x)); }

  private:
    explicit Interval(Ends ends) : ends_(ends) {}

    static Ends swapped(Ends x) { return Ends{x[1], x[0]}; }

    static Interval with_float32(Ends ends) {
        if constexpr (A == Arithmetic::float32 && !std::is_same_v<T, float>) {
            using Narrow = Lanes<float, 2>;
            return Interval(lanes::greater(lanes::convert<Ends>(lanes::convert<Narrow>(ends)), ends));
        }
        return Interval(ends);
    }
    static Interval of_special(T x) {
        constexpr T largest = std::numeric_limits<T>::max();
        return {x > 0 ? largest : -infinity<T>, x < 0 ? -largest : infinity<T>};
    }

    // An empty operand makes -infinity in a lane, or NaN where it meets +infinity; a real sum makes neither.
    static Interval sum(Ends a, Ends b) {
        const Ends lowest = lanes::every<Ends>(-infinity<T>);
        return with_float32(lanes::greater(Rounding::add_up(a, b), lowest));
    }

    // Either end of a times that end of b which makes the product least, and greatest: two products in each lane, of
    // which the greater is wanted.
    struct Factors {
        Ends inf, of_inf, sup, of_sup;
    };
    static Factors factors(const Interval& a, const Interval& b) {
        const Ends zero{}, minus_inf = lanes::every<Ends>(a.ends_[0]), sup = lanes::every<Ends>(a.ends_[1]);
        const Ends ordered = lanes::flipped(b.ends_, -1, 1), reversed = swapped(ordered);
        return {lanes::flipped(minus_inf, 1, -1), minus_inf <= zero ? ordered : reversed, lanes::flipped(sup, -1, 1),
                sup >= zero ? ordered : reversed};
    }
    // Finite sums mean that neither is empty or unbounded.
    template <class Up>
    static Interval of_products(const Interval& a, const Interval& b, Up up) {
        if (!lanes::all_finite(a.ends_ + b.ends_)) [[unlikely]]
            return of_special_products(a, b, up);
        const Factors f = factors(a, b);
        return with_float32(lanes::greater(up(f.inf, f.of_inf), up(f.sup, f.of_sup)));
    }
    [[gnu::noinline]] static Interval products_apart(const Interval& a, const Interval& b) {
        return of_products(a, b, Rounding::template multiply_up<Ends>);
    }
    // 0 times an infinite end is 0: the end is no member.
    template <class Up>
    [[gnu::noinline]] static Interval of_special_products(const Interval& a, const Interval& b, Up up) {
        if (a.is_empty() || b.is_empty()) return empty();
        Ends most = lanes::every<Ends>(-infinity<T>);
        for (T x : {a.inf(), a.sup()})
            for (T y : {b.inf(), b.sup()}) {
                const T finite_y = x == 0 ? T(0) : y, finite_x = y == 0 ? T(0) : x;
                const Ends ends = up(Ends{-finite_x, finite_x}, lanes::every<Ends>(finite_y));
                for (int i = 0; i < 2; ++i)
                    most[i] = ends[i] <= most[i] ? most[i] : ends[i] == ends[i] ? ends[i] : infinity<T>;
            }
        return with_float32(most);
    }

    // a / b for b > 0: the ends of a, each by the end of b that keeps it outside.
    static Interval quotient(Ends a, const Interval& b) {
        const Ends divisors = a >= Ends{} ? lanes::every<Ends>(b.inf()) : lanes::every<Ends>(b.sup());
        return with_float32(Rounding::divide_up(a, divisors));
    }
    static Interval quotient_at_zero(const Interval& a, const Interval& b) {
        if (A == Arithmetic::float32) return entire();
        if (b.ends_[0] > 0 && b.ends_[1] > 0) return lanes::all(a.ends_ == Ends{}) ? a : entire();
        if (b.ends_[0] > 0) return quotient_at_zero(-a, -b);
        if (b.ends_[1] == 0) return empty();
        if (lanes::all(a.ends_ == Ends{})) return a;
        if (a.ends_[0] <= 0) return {Rounding::divide_down(a.inf(), b.sup()), infinity<T>};
        if (a.ends_[1] <= 0) return {-infinity<T>, Rounding::divide_up(a.sup(), b.sup())};
        return entire();
    }

    Ends ends_;
};

template <std::floating_point T, Arithmetic A, class Rounding>
struct NumberTraits<Interval<T, A, Rounding>> {
    using Mask = Verdict;
    using Wide = Interval<double, A, Rounding>;
    static constexpr T unit_roundoff = NumberTraits<T>::unit_roundoff;
};

static_assert(Number<Interval<float>> && Number<Interval<double>>);

}  // namespace raybound
