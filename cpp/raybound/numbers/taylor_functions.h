// The operations of Taylor models: roots and reciprocals, the elementary functions, and those that are not smooth.
#pragma once

#include "raybound/numbers/elementary.h"
#include "raybound/numbers/elementary_range.h"
#include "raybound/numbers/taylor_compose.h"

namespace raybound {

namespace taylor {

// Functions of an argument that keeps away from 0: `ratio` bounds |c| / (least |argument|), and powers of it the growth
// of a derivative over the range; ratio^(k + 1/2) <= ratio^k (1 + ratio) / 2. With q = deviation / |c| it is 1 / (1 -
// q), which is at most 1 + q + 2 q^2 for q <= 1/2.
template <int N, Arithmetic A>
inline bool is_positive_and_tame(const TaylorModel<N, A>& a) {
    return a.low() > 0 && is_tame(a.constant()) && is_tame(a.low());
}
template <int N, Arithmetic A>
inline double ratio(const TaylorModel<N, A>& a, double inverse) {
    const double q = a.deviation() * std::abs(inverse) * upward;
    if (q < 0.5) [[likely]]
        return (1 + q + 2 * (q * q)) * upward;
    return std::abs(a.constant()) / (std::abs(a.constant()) - a.deviation() * upward) * upward;
}

// From enclosures of a function and of its derivatives at the constant term.
inline double middle(const Range& x) { return 0.5 * x.inf + 0.5 * x.sup; }
inline double radius(const Range& x) { return (x.sup - x.inf) * upward; }
template <int N, Arithmetic A>
inline Ends ends(const TaylorModel<N, A>& a, Range (*function)(double, double)) {
    const Range range = function(a.low(), a.high());
    return {range.inf, range.sup};
}

}  // namespace taylor

template <int N, Arithmetic A>
inline TaylorModel<N, A> sqrt(const TaylorModel<N, A>& a) {
    const double low = a.low(), high = a.high();
    if (a.is_constant() && a.constant() == 0) return a;
    if (!(low >= 0)) return TaylorModel<N, A>::entire();
    const auto ends = [&] { return Ends{std::sqrt(low) * (1 - 0x1p-51), std::sqrt(high) * (1 + 0x1p-51)}; };
    if (!taylor::is_positive_and_tame(a)) return within<N, A>(ends(), 1);
    const double root = std::sqrt(a.constant()), inverse = 1 / a.constant(), ratio = taylor::ratio(a, inverse);
    const double first = 0.5 * root * inverse, half_second = -0.25 * first * inverse;
    const double sixth_third = -0.5 * half_second * inverse * (ratio * ratio * (0.5 + 0.5 * ratio)) * upward;
    return compose(a, {root, 0, first, half_second, sixth_third}, ends);
}

template <int N, Arithmetic A>
inline TaylorModel<N, A> reciprocal(const TaylorModel<N, A>& a, double roundings = 1) {
    const double low = a.low(), high = a.high();
    if (!(low > 0 || high < 0)) return TaylorModel<N, A>::entire();
    const auto ends = [&] {
        const double one_low = 1 / high, one_high = 1 / low;
        return Ends{one_low - 0x1p-52 * std::abs(one_low), one_high + 0x1p-52 * std::abs(one_high)};
    };
    if (!is_tame(low) || !is_tame(high)) return within<N, A>(ends(), roundings);
    const double inverse = 1 / a.constant(), squared = inverse * inverse, ratio = taylor::ratio(a, inverse);
    const double sixth_third = squared * squared * (ratio * ratio) * (ratio * ratio) * upward;
    return compose(a, {inverse, 0, -squared, squared * inverse, sixth_third}, ends, roundings);
}

// One rounding in an execution: the reciprocal's own is not committed, so its factor is one of real numbers.
template <int N, Arithmetic A>
inline TaylorModel<N, A> operator/(const TaylorModel<N, A>& a, const TaylorModel<N, A>& b) {
    if (a.is_constant() && a.constant() == 1) return reciprocal(b);
    // The same everywhere, up to a remainder r of at most half of it: |1/(c + e) - 1/c| <= r / (|c| (|c| - r)).
    const double c = b.constant(), r = b.remainder();
    if (b.first_norm() + b.second_norm() == 0 && is_tame(c) && r <= 0.5 * std::abs(c)) {
        const double inverse = 1 / c, size = std::abs(inverse);
        return a *
               TaylorModel<N, A>::certified(TaylorModel<N, A>(inverse).polynomial(), (2 * r * size + 0x1p-52) * size);
    }
    return a * reciprocal(b, 0);
}

// As 1 / sqrt(x) is executed: two roundings.
template <int N, Arithmetic A>
inline TaylorModel<N, A> rsqrt(const TaylorModel<N, A>& a) {
    const double low = a.low();
    if (!(low > 0)) return TaylorModel<N, A>::entire();
    const auto ends = [&] { return Ends{1 / std::sqrt(a.high()) * (1 - 0x1p-50), 1 / std::sqrt(low) * (1 + 0x1p-50)}; };
    if (!taylor::is_positive_and_tame(a)) return within<N, A>(ends(), 2);
    const double c = a.constant(), value = 1 / std::sqrt(c), inverse = 1 / c, ratio = taylor::ratio(a, inverse);
    const double first = -0.5 * value * inverse;
    const double sixth_third =
        0.3125 * value * (inverse * inverse * inverse) * (ratio * ratio * ratio) * (0.5 + 0.5 * ratio) * upward;
    return compose(a, {value, 0, first, -0.75 * first * inverse, sixth_third}, ends, 2);
}

template <int N, Arithmetic A>
inline TaylorModel<N, A> square(const TaylorModel<N, A>& a) {
    return a * a;
}

// a b + c; an execution rounds the product and the sum (contraction is off everywhere).
template <int N, Arithmetic A>
inline TaylorModel<N, A> fma(const TaylorModel<N, A>& a, const TaylorModel<N, A>& b, const TaylorModel<N, A>& c) {
    return a * b + c;
}

namespace taylor {
// e^c and a bound of its error: for float executions, whose roundings hide it, by the kernels' own, within 2^-36.
struct Value {
    double value, error;
};
template <Arithmetic A>
inline Value exp_at_constant(double c) {
    if constexpr (A == Arithmetic::float32) {
        const double value = elementary::exp_kernel(c);
        return {value, value * 0x1p-36 * upward};
    }
    const Range at = exp_range(c, c);
    return {middle(at), radius(at)};
}
template <Arithmetic A>
inline double exp_above(double x) {
    if (!(x < 700)) return exp_range(x, x).sup;  // the kernel ends at 745
    const auto [value, error] = exp_at_constant<A>(x);
    return (value + error) * upward;
}
}  // namespace taylor

// The functions with an enclosure of their own at a point. An execution is off by two units of roundoff.
template <int N, Arithmetic A>
inline TaylorModel<N, A> exp(const TaylorModel<N, A>& a) {
    const double c = a.constant(), deviation = a.deviation();
    if (!(a.high() < 700 && c > -700)) {
        if (!(a.high() < 700)) return TaylorModel<N, A>::entire();
        return within<N, A>(taylor::ends(a, exp_range), 2);
    }
    const auto [value, error] = taylor::exp_at_constant<A>(c);
    // e^d <= 1 + d + d^2 for d <= 1.79.
    const double growth = deviation < 1 ? 1 + deviation + deviation * deviation : taylor::exp_above<A>(deviation);
    const double high = value * growth * (1 + 0x1p-30);
    const auto ends = [&] { return Ends{std::fmax(value / growth * (1 - 0x1p-30) - underflow_bound, 0.0), high}; };
    return compose(a, {value, error, value, 0.5 * value, high * (1.0 / 6) * upward, error, error}, ends, 2);
}

template <int N, Arithmetic A>
inline TaylorModel<N, A> log(const TaylorModel<N, A>& a) {
    if (!(a.low() > 0)) return TaylorModel<N, A>::entire();
    const auto ends = [&] { return taylor::ends(a, log_range); };
    if (!taylor::is_positive_and_tame(a)) return within<N, A>(ends(), 2);
    const double c = a.constant(), first = 1 / c, ratio = taylor::ratio(a, first);
    const Range at = log_range(c, c);
    const double sixth_third = (1.0 / 3) * (first * first * first) * (ratio * ratio * ratio) * upward;
    return compose(a, {taylor::middle(at), taylor::radius(at), first, -0.5 * first * first, sixth_third}, ends, 2);
}

// |sin'''| = |cos| and |cos'''| = |sin| are at most 1, and at most their value at c plus the deviation.
template <int N, Arithmetic A>
inline TaylorModel<N, A> sin(const TaylorModel<N, A>& a) {
    if (!a.is_known()) return a;
    const double c = a.constant();
    const Range s = sin_range(c, c), k = cos_range(c, c);
    const double value = taylor::middle(s), slope = taylor::middle(k), error = taylor::radius(s) + taylor::radius(k);
    const double third = std::fmin(1.0, (std::abs(slope) + error + a.deviation()) * upward);
    return compose(
        a, {value, error, slope, -0.5 * value, third * (1.0 / 6) * upward, error, error},
        [&] { return taylor::ends(a, sin_range); }, 2);
}
template <int N, Arithmetic A>
inline TaylorModel<N, A> cos(const TaylorModel<N, A>& a) {
    if (!a.is_known()) return a;
    const double c = a.constant();
    const Range s = sin_range(c, c), k = cos_range(c, c);
    const double value = taylor::middle(k), sine = taylor::middle(s), error = taylor::radius(s) + taylor::radius(k);
    const double third = std::fmin(1.0, (std::abs(sine) + error + a.deviation()) * upward);
    return compose(
        a, {value, error, -sine, -0.5 * value, third * (1.0 / 6) * upward, error, error},
        [&] { return taylor::ends(a, cos_range); }, 2);
}

// With t = tan x: t' = 1 + t^2, t'' = 2 t t', t''' = 2 t' (1 + 3 t^2), which grows with |t|.
template <int N, Arithmetic A>
inline TaylorModel<N, A> tan(const TaylorModel<N, A>& a) {
    if (!a.is_known()) return a;
    const Ends range = taylor::ends(a, tan_range);
    const double largest = std::fmax(std::abs(range.low), std::abs(range.high));
    if (!(largest < 0x1p60)) return largest < 0x1p500 ? within<N, A>(range, 2) : TaylorModel<N, A>::entire();
    const Range at = tan_range(a.constant(), a.constant());
    const double t = taylor::middle(at), first = 1 + t * t,
                 error = taylor::radius(at) * 8 * (first * (1 + std::abs(t)));
    const double squared = largest * largest;
    const double sixth_third = (1.0 / 3) * (1 + squared) * (1 + 3 * squared) * upward;
    return compose(a, {t, error, first, t * first, sixth_third, error, error}, [&] { return range; }, 2);
}

// asin' = w for w = (1 - x^2)^(-1/2), asin'' = x w^3, asin''' = (1 + 2 x^2) w^5, which grows with |x|; acos' = -asin'.
namespace taylor {
template <int N, Arithmetic A>
inline TaylorModel<N, A> arc(const TaylorModel<N, A>& a, double sign, Range (*function)(double, double)) {
    if (!(a.low() >= -1 && a.high() <= 1)) return TaylorModel<N, A>::entire();
    const auto ends = [&] { return taylor::ends(a, function); };
    const double x = a.constant(), last = std::fmax(-a.low(), a.high()), gap = (1 - last) * (1 + last);
    if (!(gap > 0x1p-40)) return within<N, A>(ends(), 2);
    const Range at = function(x, x);
    const double w = 1 / std::sqrt((1 - x) * (1 + x)), v = 1 / gap;
    const double sixth_third = (1 + 2 * last * last) * (v * v * std::sqrt(v)) * (1.0 / 6) * upward;
    const double half_second = sign * 0.5 * x * (w * w * w), error = 0x1p-49 * std::abs(half_second);  // 14 roundings
    return compose(a, {middle(at), radius(at), sign * w, half_second, sixth_third, 0, error}, ends, 2);
}
}  // namespace taylor

template <int N, Arithmetic A>
inline TaylorModel<N, A> asin(const TaylorModel<N, A>& a) {
    return taylor::arc(a, 1, asin_range);
}
template <int N, Arithmetic A>
inline TaylorModel<N, A> acos(const TaylorModel<N, A>& a) {
    return taylor::arc(a, -1, acos_range);
}

// atan' = v for v = 1 / (1 + x^2), atan'' = -2 x v^2, atan''' = (6 x^2 - 2) v^3, which is at most 2.
template <int N, Arithmetic A>
inline TaylorModel<N, A> atan(const TaylorModel<N, A>& a) {
    if (!a.is_known()) return a;
    const auto ends = [&] { return taylor::ends(a, atan_range); };
    const double x = a.constant(), first_x = std::fmax(0.0, std::abs(x) - a.deviation() * upward) * (1 - 0x1p-40);
    const double last_x = std::abs(x) + a.deviation();
    if (!(last_x < 0x1p60)) return within<N, A>(ends(), 2);
    const Range at = atan_range(x, x);
    const double v = 1 / (1 + x * x), least_square = 1 + first_x * first_x;
    const double third =
        std::fmin(2.0, (6 * last_x * last_x + 2) / (least_square * least_square * least_square) * upward);
    return compose(a, {taylor::middle(at), taylor::radius(at), v, -x * (v * v), third * (1.0 / 6) * upward}, ends, 2);
}

}  // namespace raybound
