// Comparisons and choices between linear intervals: abs, minimum, maximum, select (derivation D21, last part).
#pragma once

#include "raybound/numbers/linear_interval.h"

namespace raybound {

namespace linear_intervals {

// |x| - s x for inf <= x <= sup and -1 <= s <= 1: 0 at x = 0, and greatest at an end.
inline Interval<double> gap_of_absolute(const Interval<double>& x, double s) {
    const double right = multiply_up(x.sup(), subtract_up(1.0, s)), left = multiply_up(-x.inf(), add_up(1.0, s));
    return {0, std::max(right, left)};
}

// The slope of |x|'s chord over the range: it makes the gap equal at both ends, -2 inf sup / (sup - inf) at x = 0. Any
// number within [-1, 1] would do.
inline double chord_of_absolute(const Interval<double>& x) {
    const double chord = x.mid() / x.rad();
    return chord >= -1 && chord <= 1 ? chord : 0;
}

}  // namespace linear_intervals

// By the difference, so that what both have in common cancels.
template <int N, LinearRule R>
inline Verdict operator<(const LinearInterval<N, R>& a, const LinearInterval<N, R>& b) {
    return (a - b).range() < Interval<double>(0.0);
}
template <int N, LinearRule R>
inline Verdict operator<=(const LinearInterval<N, R>& a, const LinearInterval<N, R>& b) {
    return (a - b).range() <= Interval<double>(0.0);
}
template <int N, LinearRule R>
inline Verdict operator>(const LinearInterval<N, R>& a, const LinearInterval<N, R>& b) {
    return b < a;
}
template <int N, LinearRule R>
inline Verdict operator>=(const LinearInterval<N, R>& a, const LinearInterval<N, R>& b) {
    return b <= a;
}

// Where it cannot be told which: the hull of both.
template <int N, LinearRule R>
inline LinearInterval<N, R> select(Verdict which, const LinearInterval<N, R>& yes, const LinearInterval<N, R>& no) {
    if (which != Verdict::unknown) return which == Verdict::yes ? yes : no;
    typename LinearInterval<N, R>::Slopes slopes;
    for (int i = 0; i < N; ++i) slopes[i] = hull(yes.slope(i), no.slope(i));
    return {hull(yes.constant(), no.constant()), slopes, hull(yes.range(), no.range())};
}

// |x| = s x + [0, gap] with the chord's slope s where x changes sign.
template <int N, LinearRule R>
inline LinearInterval<N, R> abs(const LinearInterval<N, R>& x) {
    if (x.range().inf() >= 0) return x;
    if (x.range().sup() <= 0) return -x;
    if (x.is_entire()) return x;
    const double s = linear_intervals::chord_of_absolute(x.range());
    const LinearInterval<N, R> chord = x * s;
    return {chord.constant() + linear_intervals::gap_of_absolute(x.range(), s), chord.slopes(), abs(x.range())};
}

// max(a, b) = (a + b + |a - b|) / 2, with |a - b| = s (a - b) + [0, gap] where the difference changes sign.
template <int N, LinearRule R>
inline LinearInterval<N, R> maximum(const LinearInterval<N, R>& a, const LinearInterval<N, R>& b) {
    using Bound = Interval<double>;
    if (a.is_entire() || b.is_entire()) return LinearInterval<N, R>::entire();
    const Bound difference = (a - b).range();
    if (difference.inf() >= 0) return a;
    if (difference.sup() <= 0) return b;
    const double s = linear_intervals::chord_of_absolute(difference);
    const Bound of_a = (Bound(1.0) + Bound(s)) * Bound(0.5), of_b = (Bound(1.0) - Bound(s)) * Bound(0.5);
    const Bound gap = linear_intervals::gap_of_absolute(difference, s) * Bound(0.5);
    typename LinearInterval<N, R>::Slopes slopes;
    for (int i = 0; i < N; ++i) slopes[i] = a.slope(i) * of_a + b.slope(i) * of_b;
    return {a.constant() * of_a + b.constant() * of_b + gap, slopes, maximum(a.range(), b.range())};
}
template <int N, LinearRule R>
inline LinearInterval<N, R> minimum(const LinearInterval<N, R>& a, const LinearInterval<N, R>& b) {
    return -maximum(-a, -b);
}

}  // namespace raybound
