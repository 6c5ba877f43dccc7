// Smooth functions of linear intervals (derivation D21): Hansen's first-order rule and the thesis's second-order rule
// (thesis 4.3.5) over any function that can bound its derivatives.
#pragma once

#include "raybound/numbers/linear_interval_choices.h"
#include "raybound/numbers/linear_interval_products.h"
#include "raybound/numbers/smooth_functions.h"

namespace raybound {

namespace linear_intervals {

// f(k + d) for k in the constant and d = sum_i L_i x_i, by
//   hansen        f(k) + s d             s = (f(y) - f(k)) / (y - k), the slope
//   second_order  f(k) + f'(k) d + c d^2, c = (f(y) - f(k) - f'(k) (y - k)) / (y - k)^2, the curvature; 0 <= d^2 <=
//   reach^2.
// The thesis folds the pure squares and the mixed terms of d^2 apart and so lets it fall below zero; and its folding
// into slopes (last equation of 4.3.5) prints sum x_i^2 l_i^2 for sum dx_i^2 l_i^2 / 2 in K, and misses the factor 1/2
// of its own derivation in L.
template <int N, LinearRule R, class Function>
inline LinearInterval<N, R> compose(const Function& f, const LinearInterval<N, R>& x) {
    using Result = LinearInterval<N, R>;
    if (x.is_entire() || !f.is_defined(x.range())) return Result::entire();
    const Bound plain = f.value(x.range()), between = hull(x.constant(), x.range());
    if (!f.is_smooth(between)) return Result(plain);
    Bound constant = f.value(x.constant());
    typename Result::Slopes slopes;
    if constexpr (R == LinearRule::hansen) {
        const Bound slope = f.slope(x.constant(), between);
        for (int i = 0; i < N; ++i) slopes[i] = slope * x.slope(i);
    } else {
        const Bound derivative = f.derivative(x.constant()), curvature = f.curvature(x.constant(), between);
        for (int i = 0; i < N; ++i) slopes[i] = derivative * x.slope(i);
        if constexpr (R == LinearRule::second_order) {
            constant = constant + curvature * square_of_reach(x.reach());
        } else {
            const auto folded = fold_into_slopes(x.slopes(), x.slopes());
            for (int i = 0; i < N; ++i) {
                constant = constant + curvature * square_of_reach(x.slope(i).mag());
                slopes[i] = slopes[i] + curvature * folded.slopes[i];
            }
        }
    }
    return {constant, slopes, plain};
}

}  // namespace linear_intervals

template <int N, LinearRule R>
inline LinearInterval<N, R> sqrt(const LinearInterval<N, R>& x) {
    return linear_intervals::compose(smooth::SquareRoot{}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> rsqrt(const LinearInterval<N, R>& x) {
    return linear_intervals::compose(smooth::ReciprocalSquareRoot{}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> reciprocal(const LinearInterval<N, R>& x) {
    return linear_intervals::compose(smooth::Reciprocal{}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> exp(const LinearInterval<N, R>& x) {
    return linear_intervals::compose(smooth::Exponential{}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> log(const LinearInterval<N, R>& x) {
    return linear_intervals::compose(smooth::Logarithm{}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> sin(const LinearInterval<N, R>& x) {
    return linear_intervals::compose(smooth::Sine{}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> cos(const LinearInterval<N, R>& x) {
    return linear_intervals::compose(smooth::Cosine{}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> tan(const LinearInterval<N, R>& x) {
    return linear_intervals::compose(smooth::Tangent{}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> asin(const LinearInterval<N, R>& x) {
    return linear_intervals::compose(smooth::ArcSine{}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> acos(const LinearInterval<N, R>& x) {
    return linear_intervals::compose(smooth::ArcCosine{}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> atan(const LinearInterval<N, R>& x) {
    return linear_intervals::compose(smooth::ArcTangent{}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> power(const LinearInterval<N, R>& x, int exponent) {
    if (exponent == 2) return square(x);
    return linear_intervals::compose(smooth::Power{exponent}, x);
}
template <int N, LinearRule R>
inline LinearInterval<N, R> fma(const LinearInterval<N, R>& a, const LinearInterval<N, R>& b,
                                const LinearInterval<N, R>& c) {
    return a * b + c;
}
// exp((1 - 1/cosine^2) / sigma^2), 0 at 0. Throws std::invalid_argument unless sigma > 0.
template <int N, LinearRule R>
inline LinearInterval<N, R> ward_lobe(const LinearInterval<N, R>& cosine, double sigma) {
    return linear_intervals::compose(smooth::WardLobe(sigma), cosine);
}

static_assert(Number<LinearInterval<4, LinearRule::hansen>> && Number<LinearInterval<4, LinearRule::second_order>>);

}  // namespace raybound
