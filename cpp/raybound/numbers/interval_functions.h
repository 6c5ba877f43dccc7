// Functions of intervals beyond arithmetic: integer powers, the elementary functions, Ward's lobe. They end as
// interval.h's do: ranges over the part of x in the domain; with Arithmetic::float32 also what executions return there.
#pragma once

#include "raybound/numbers/elementary_range.h"
#include "raybound/numbers/interval.h"
#include "raybound/numbers/rounding_power.h"

namespace raybound {

template <class I>
concept AnyInterval = requires(I x) { []<class T, Arithmetic A, class R>(const Interval<T, A, R>&) {}(x); };

namespace interval_functions {

template <class I>
inline constexpr bool in_float32 = I::arithmetic == Arithmetic::float32;

// What float32 executions return where the real range is `range` and their result y (1 + d) + e, |d| <= gamma_n and
// |e| <= n times the least subnormal: both ends move by that much.
template <AnyInterval I>
I widen_for_float32(const I& range, double n) {
    using T = typename I::Value;
    if (range.is_empty()) return range;
    const double nu = n * 0x1p-24, absolute = n * 0x1p-149;
    if (!(nu < 0.25)) return {range.inf() >= 0 ? T(0) : -infinity<T>, range.sup() <= 0 ? T(0) : infinity<T>};
    const double relative = divide_up(nu, 1 - nu);
    const auto away = [&](double size) { return add_up(multiply_up(size, add_up(1.0, relative)), absolute); };
    const auto toward = [&](double size) {
        return maximum(subtract_down(multiply_down(size, subtract_down(1.0, relative)), absolute), 0.0);
    };
    const double low = double(range.inf()), high = double(range.sup());
    return I::outward(low > 0 ? toward(low) : -away(-low), high < 0 ? -toward(-high) : away(high));
}

// Of float elementary functions: at most 0.51 ulp (elementary.h), and 2 u of those that have no float version yet.
template <AnyInterval I, class RangeOf>
I elementary(const I& x, RangeOf range_of) {
    if (x.is_empty()) return x;
    const Range range = range_of(double(x.inf()), double(x.sup()));
    const I result = I::outward(range.inf, range.sup);
    if constexpr (in_float32<I>) return widen_for_float32(result, 2);
    return result;
}

}  // namespace interval_functions

template <AnyInterval I>
I exp(const I& x) {
    return interval_functions::elementary(x, exp_range);
}
// float32 executions return minus infinity at 0.
template <AnyInterval I>
I log(const I& x) {
    using T = typename I::Value;
    const I result = interval_functions::elementary(x, log_range);
    if (interval_functions::in_float32<I> && x.contains_zero())
        return hull(result, I(-infinity<T>, -std::numeric_limits<T>::max()));
    return result;
}
template <AnyInterval I>
I sin(const I& x) {
    return interval_functions::elementary(x, sin_range);
}
template <AnyInterval I>
I cos(const I& x) {
    return interval_functions::elementary(x, cos_range);
}
template <AnyInterval I>
I tan(const I& x) {
    return interval_functions::elementary(x, tan_range);
}
template <AnyInterval I>
I asin(const I& x) {
    return interval_functions::elementary(x, asin_range);
}
template <AnyInterval I>
I acos(const I& x) {
    return interval_functions::elementary(x, acos_range);
}
template <AnyInterval I>
I atan(const I& x) {
    return interval_functions::elementary(x, atan_range);
}

namespace interval_functions {

// x^n for x >= 0, where the range is from one end to the other.
template <AnyInterval I>
I power_of_sizes(typename I::Value least, typename I::Value most, int n) {
    using T = typename I::Value;
    const auto down = [n](T x) { return x == 0 ? T(0) : x == infinity<T> ? x : power_down(x, n); };
    const auto up = [n](T x) { return x == 0 ? T(0) : x == infinity<T> ? x : power_up(x, n); };
    if (n > 0) return {down(least), up(most)};
    if (most == 0) return I::empty();
    return {most == infinity<T> ? T(0) : down(most), least == 0 ? infinity<T> : up(least)};
}

template <AnyInterval I>
I real_power(const I& x, int n) {
    using T = typename I::Value;
    if (n == 0) return T(1);
    if (n % 2 == 0) return power_of_sizes<I>(x.mig(), x.mag(), n);
    if (x.inf() >= 0) return power_of_sizes<I>(x.inf(), x.sup(), n);
    if (x.sup() <= 0) return -power_of_sizes<I>(-x.sup(), -x.inf(), n);
    if (n < 0) return I::entire();
    return {-power_of_sizes<I>(T(0), -x.inf(), n).sup(), power_of_sizes<I>(T(0), x.sup(), n).sup()};
}

}  // namespace interval_functions

// x^n, tight to the bit; x^0 = 1. In float32 it holds the products in every order and a division before or after them:
// less than 2 |n| roundings. Where x^|n| overflows or underflows in between, so does the result nearly.
template <AnyInterval I>
I power(const I& x, int n) {
    using T = typename I::Value;
    if (x.is_empty()) return x;
    const I range = interval_functions::real_power(x, n);
    if constexpr (!interval_functions::in_float32<I>) return range;
    if (n == 0 || n == 1) return range;
    if (n > 0) return interval_functions::widen_for_float32(range, n);
    if (x.contains_zero()) return I::entire();
    I widened = interval_functions::widen_for_float32(range, -2 * double(n));
    if (range.mig() < T(0x1p-126)) widened = hull(widened, I(T(0)));
    if (range.sup() > T(0x1p126)) widened = hull(widened, I(T(0x1p125), infinity<T>));
    if (range.inf() < T(-0x1p126)) widened = hull(widened, I(-infinity<T>, T(-0x1p125)));
    return widened;
}

namespace interval_functions {

// (1 - 1 / c^2) / sigma^2 at one c > 0 as (c - 1) (c + 1) / (c^2 sigma^2), which does not cancel near 1.
inline Interval<double> lobe_exponent(double c, double sigma) {
    using I = Interval<double>;
    if (c < 2) return (I(c) - 1) * (I(c) + 1) / (square(I(c)) * square(I(sigma)));
    return (1 - (c < infinity<double> ? reciprocal(square(I(c))) : I(0))) / square(I(sigma));
}

// The same as a float32 execution goes, operation by operation.
inline Interval<double, Arithmetic::float32> float32_lobe_exponent(double c, double sigma) {
    using I = Interval<double, Arithmetic::float32>;
    const I squared = square(I(c)),
            inverse = squared.inf() > 0 ? reciprocal(squared) : I(reciprocal(I(squared.sup())).inf(), infinity<double>);
    return (1 - inverse) / square(I(sigma));
}

}  // namespace interval_functions

// exp((1 - 1/cosine^2) / sigma^2), Ward's lobe: a function of cosine^2 that grows with it, from 0 at 0. Throws
// std::invalid_argument unless sigma > 0.
template <AnyInterval I>
I ward_lobe(const I& cosine, double sigma) {
    using namespace interval_functions;
    if (!(sigma > 0 && sigma < infinity<double>))
        throw std::invalid_argument("ward_lobe: sigma must be positive and finite, got " + std::to_string(sigma));
    if (cosine.is_empty()) return cosine;
    const double least = double(cosine.mig()), most = double(cosine.mag());
    const double inf = least > 0 ? exp(lobe_exponent(least, sigma)).inf() : 0.0;
    const double sup = most > 0 ? exp(lobe_exponent(most, sigma)).sup() : 0.0;
    if constexpr (!in_float32<I>) return I::outward(inf, sup);
    const double float_inf = least > 0 ? exp(float32_lobe_exponent(least, sigma)).inf() : 0.0;
    const double float_sup = most > 0 ? exp(float32_lobe_exponent(most, sigma)).sup() : 0.0;
    return I::outward(minimum(inf, float_inf), maximum(sup, float_sup));
}

}  // namespace raybound
