// A smooth function of a Taylor model: expanded around the constant term to second order, the rest bounded by the third
// derivative over the argument's range (certified-interpolants.md, section 2; cpp/derivations.md, D31).
#pragma once

#include "raybound/numbers/taylor_model.h"

namespace raybound {

// g at the constant term c, for an argument within c +- deviation. `first` and `half_second` (g' and g''/2 at c) are
// within 2^-50 of themselves, or have the bounds of error given; `sixth_third` bounds |g'''|/6 over the range.
struct Expansion {
    double value, value_error, first, half_second, sixth_third;
    double first_error = 0, half_second_error = 0;
};

struct Ends {
    double low, high;
};

// Numbers whose first few powers neither overflow nor underflow: beyond them only ranges are used.
inline bool is_tame(double x) { return std::abs(x) > 0x1p-120 && std::abs(x) < 0x1p120; }

// All of a range, as the result of an operation.
template <int N, Arithmetic A>
inline TaylorModel<N, A> within(const Ends& ends, double roundings) {
    const double middle = ends.low * 0.5 + ends.high * 0.5;
    const double radius = std::fmax(ends.high - middle, middle - ends.low);
    TaylorPolynomial<N> constant;
    constant.part[0][0] = middle;
    return TaylorModel<N, A>::executed(constant, radius + 0x1p-52 * std::abs(middle) + underflow_bound, roundings);
}

// g(a). With D = A_1 + A_2 + [-r, r]: value + first D + half_second D^2 + sixth_third [-1, 1] |D|^3, of which
// first (A_1 + A_2) + half_second A_1^2 is kept. Where the remainder is no smaller than the linear part, the function's
// range, which `ends()` gives, may say more and is taken instead. The execution's result is off by `roundings` units of
// roundoff.
template <int N, Arithmetic A, class RangeEnds>
inline TaylorModel<N, A> compose(const TaylorModel<N, A>& a, const Expansion& g, RangeEnds ends, double roundings = 1) {
    const double n1 = a.first_norm(), n2 = a.second_norm(), r = a.remainder(), known = n1 + n2, deviation = known + r;
    const double first = std::abs(g.first) + g.first_error, squares = n1 * n1;
    const double half_second = std::abs(g.half_second) + g.half_second_error;
    const double rounding = (0x1p-49 * (std::abs(g.value) + first * known + half_second * squares) + g.value_error) +
                            (g.first_error * known + g.half_second_error * squares) + underflow_bound;
    const double cut = half_second * (n2 * (2 * n1 + n2)) + rounding;
    const double remainder =
        first * r + half_second * (r * (2 * known + r)) + (cut + g.sixth_third * (deviation * deviation * deviation));
    if (!(remainder < 0.5 * (first * known))) [[unlikely]] {
        const Ends range = ends();
        if (!(remainder < 0.5 * (range.high - range.low))) return within<N, A>(range, roundings);
    }
    TaylorPolynomial<N> polynomial = a.polynomial().without_constant() * g.first;
    add_linear_product(polynomial, a.polynomial(), a.polynomial(), g.half_second);
    polynomial.part[0][0] = g.value;
    return TaylorModel<N, A>::executed(polynomial, remainder, roundings);
}

}  // namespace raybound
