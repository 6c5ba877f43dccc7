// Integer powers and Ward's lobe of Taylor models.
#pragma once

#include "raybound/numbers/taylor_functions.h"
#include "raybound/numbers/taylor_select.h"

namespace raybound {

namespace taylor {

// x^n for n >= 0, within n units of roundoff of itself (and `underflow_bound`).
inline double power(double x, int n) {
    double result = 1;
    for (double factor = x; n > 0; factor *= factor, n >>= 1)
        if (n & 1) result *= factor;
    return result;
}

// The range of x^n over [low, high] for n >= 1.
inline Ends power_ends(double low, double high, int n) {
    const double slack = n * 0x1p-52, a = power(low, n), b = power(high, n);
    const double top = n % 2 == 0 ? std::fmax(a, b) : b;
    const double bottom = n % 2 == 1 ? a : low > 0 ? a : high < 0 ? b : 0;
    return {bottom - slack * std::abs(bottom) - underflow_bound, top + slack * std::abs(top) + underflow_bound};
}

// a^-n for n >= 1, as executions invert a^n: `powers`, its range, does not reach 0 and is tame, so that nothing
// overflows or underflows in between. With v = x^-n: v' = -n v / x, v'' = n (n + 1) v / x^2, and |v'''| =
// n (n + 1) (n + 2) |v / x^3| is greatest where |x| is least.
template <int N, Arithmetic A>
inline TaylorModel<N, A> inverse_power(const TaylorModel<N, A>& a, int n, const Ends& powers) {
    const double c = a.constant(), least = std::fmax(a.low(), -a.high()), error = n * 0x1p-51;
    const double value = 1 / power(c, n), first = -n * (value / c), half_second = 0.5 * n * (n + 1.0) * (value / c / c);
    const double sixth_third =
        n * (n + 1.0) * (n + 2.0) * (1.0 / 6) / (power(least, n) * (least * least * least)) * (1 + error) * upward;
    const double low = 1 / powers.high, high = 1 / powers.low;
    const auto ends = [&] { return Ends{low - 0x1p-52 * std::abs(low), high + 0x1p-52 * std::abs(high)}; };
    return compose(a,
                   {value, error * std::abs(value), first, half_second, sixth_third, error * std::abs(first),
                    error * std::abs(half_second)},
                   ends, 2 * n + 1);
}

}  // namespace taylor

// The n-th power, as repeated squaring executes it: at most 2 |n| roundings.
template <int N, Arithmetic A>
inline TaylorModel<N, A> power(const TaylorModel<N, A>& a, int n) {
    using Model = TaylorModel<N, A>;
    if (n < -(1 << 20) || n > (1 << 20) || !a.is_known()) return n == 0 ? Model(1) : Model::entire();
    const double low = a.low(), high = a.high(), c = a.constant(), largest = std::fmax(-low, high);
    if (n < 0) {
        const Ends powers = taylor::power_ends(low, high, -n);
        const bool is_tamed = is_tame(powers.low) && is_tame(powers.high) && is_tame(c);
        if (n < -1 && (low > 0 || high < 0) && is_tamed) return taylor::inverse_power(a, -n, powers);
        return reciprocal(power(a, -n));
    }
    if (n <= 2) return n == 0 ? Model(1) : n == 1 ? a : square(a);
    const auto ends = [&] { return taylor::power_ends(low, high, n); };
    const double tail = taylor::power(c, n - 2), value = tail * c * c;
    const double third = taylor::power(largest, n - 3) * (1 + n * 0x1p-51);
    if (!is_tame(tail) || !is_tame(value) || !is_tame(third)) return within<N, A>(ends(), 2 * n);
    const double error = n * 0x1p-52, first = n * tail * c, half_second = 0.5 * n * (n - 1) * tail;
    const double sixth_third = n * (n - 1.0) * (n - 2.0) * (1.0 / 6) * third * upward;
    return compose(a,
                   {value, error * std::abs(value), first, half_second, sixth_third, error * std::abs(first),
                    error * std::abs(half_second)},
                   ends, 2 * n);
}

// exp((1 - 1/x^2) / sigma^2), a function of x^2 (thesis 4.3.7, with the sign of tan^2 corrected). As one operator: with
// p = (1 - 1/x^2) / sigma^2 its third derivative is e^p (p'^3 + 3 p' p'' + p'''), of which p'p'' is negative. It is
// bounded on eight pieces of the range, where e^p is small where the rest is large. An execution computes it in a wider
// type and rounds once.
template <int N, Arithmetic A>
inline TaylorModel<N, A> ward_lobe(const TaylorModel<N, A>& cosine, double sigma) {
    static_assert(A != Arithmetic::float64, "an execution in double rounds the exponent, which nothing here bounds");
    if (!cosine.is_known()) return cosine;
    if (cosine.high() < 0) return ward_lobe(-cosine, sigma);
    const double low = cosine.low(), high = cosine.high(), s2 = sigma * sigma, x = cosine.constant();
    const auto exponent = [s2](double y) { return -((1 - y) * (1 + y)) / (y * y * s2); };
    const auto lobe = [&](double y) {  // enclosed: seven roundings in the exponent, one of its ends
        const double e = exponent(y), error = 0x1p-49 * std::abs(e);
        return exp_range(e - error, e + error);
    };
    const double farthest = std::fmax(-low, high);
    if (!(is_tame(farthest) && is_tame(s2) && exponent(farthest) < 600)) return TaylorModel<N, A>::entire();
    if (!(low > 0x1p-20)) return within<N, A>({0, lobe(farthest).sup}, 2);
    const Range at = lobe(x);
    const double value = taylor::middle(at), x2 = 1 / (x * x), slope = 2 * x2 / (x * s2);
    const double half_second = 0.5 * (slope * slope - 6 * x2 * x2 / s2);
    double third = 0;
    constexpr int pieces = 8;
    for (int i = 0; i < pieces; ++i) {
        const double y = (low + (high - low) * (double(i) / pieces)) * (1 - 0x1p-50);
        const double end = i + 1 == pieces ? high : low + (high - low) * (double(i + 1) / pieces) * (1 + 0x1p-50);
        const double inverse = 1 / (y * y), p1 = 2 * inverse / (y * s2), p2 = 6 * inverse * inverse / s2;
        const double p3 = 4 * p2 / y;
        third = std::fmax(third, lobe(end).sup * std::fmax(p1 * p1 * p1 + p3, 3 * p1 * p2));
    }
    const double relative = (at.sup - at.inf) + 0x1p-48 * value;  // of the value, and so of the derivatives
    const double magnitude = slope * slope + 6 * x2 * x2 / s2;
    return compose(
        cosine,
        {value, at.sup - at.inf, slope * value, half_second * value, third * (1.0 / 6) * upward, relative * slope,
         relative * magnitude},
        [&] { return Ends{lobe(low).inf, lobe(high).sup}; }, 2);
}

}  // namespace raybound
