// Roots of a t^2 + b t + c with running errors (seeds/000 and 002, 3.9.1: Quadratic on EFloat).
//
// The seeds' function takes the discriminant of the coefficients' values, and a negative one for a miss. Here it is
// enclosed over all that the coefficients may be, and where its sign is not certain the answer is unknown.
#pragma once

#include "raybound/numbers/running_error_functions.h"

namespace raybound {

// The plain kernel: discriminant and root in W, the roots from the coefficient that does not cancel, t0 <= t1. Returns
// whether the discriminant is not negative; where it is, the roots are those of a discriminant 0.
template <std::floating_point W, std::floating_point T>
inline bool solve_quadratic(T a, T b, T c, T& t0, T& t1) {
    const W discriminant = W(b) * W(b) - W(4) * W(a) * W(c);
    const T root = static_cast<T>(std::sqrt(maximum(W(0), discriminant)));
    const T stable = T(-0.5) * (b < T(0) ? b - root : b + root);
    const T first = stable / a, second = stable == T(0) ? first : c / stable;
    t0 = minimum(first, second);
    t1 = maximum(first, second);
    return discriminant >= W(0);
}

namespace running_errors {

using Bound = Interval<double>;

struct RootBounds {
    Verdict real;
    Bound low, high;
};

// (-b + root) / (2 a), and the same root as 2 c / (-b - root), which is narrow where the first form cancels.
inline Bound root_bound(const Bound& a, const Bound& b, const Bound& c, const Bound& root) {
    const Bound two(2.0), direct = (root - b) / (two * a), divisor = -b - root;
    return divisor.contains_zero() ? direct : intersection(direct, two * c / divisor);
}

// The roots of all polynomials with coefficients in a, b and c; entire if there may be none or one of them at infinity.
inline RootBounds root_bounds(const Bound& a, const Bound& b, const Bound& c) {
    const Bound discriminant = square(b) - Bound(4.0) * a * c;
    const Verdict real = discriminant >= Bound(0.0);
    if (none(real)) return {real, Bound::entire(), Bound::entire()};
    if (a.contains_zero()) return {Verdict::unknown, Bound::entire(), Bound::entire()};
    const Bound root = sqrt(discriminant);  // of its part that is not negative
    const Bound plus = root_bound(a, b, c, root), minus = root_bound(a, b, c, -root);
    return a.inf() > 0 ? RootBounds{real, minus, plus} : RootBounds{real, plus, minus};
}

// How far the shadow's root t may be off in units in the last place: its discriminant d is off by a few of
// b^2 + 4 |a c|, hence sqrt(d) by that over 2 sqrt(d), and t by that over 2 |a|.
inline int root_slack(long double a, long double b, long double c, long double t) {
    const long double size = b * b + 4 * std::abs(a * c), root = std::sqrt(std::max(0.0L, b * b - 4 * a * c));
    const long double slack = 8 + 4 * size / (root * std::abs(a * t));
    return slack < 1e9L ? static_cast<int>(slack) : 1000000000;
}

template <class Number, class Enclosure>
inline void shadow_roots(const Number& a, const Number& b, const Number& c, Number& t0, const Enclosure& low,
                         Number& t1, const Enclosure& high) {
    const long double exact_a = a.shadow().reference.value, exact_b = b.shadow().reference.value,
                      exact_c = c.shadow().reference.value;
    long double first, second;
    solve_quadratic<long double>(exact_a, exact_b, exact_c, first, second);
    t0.follow("quadratic", root_slack(exact_a, exact_b, exact_c, first), first, low, a, b, c);
    t1.follow("quadratic", root_slack(exact_a, exact_b, exact_c, second), second, high, a, b, c);
}

}  // namespace running_errors

// Whether both roots are real (unknown too where a may be 0: one of them may be at infinity), and the roots t0 <= t1,
// whose enclosures hold the exact ones if those are real. For a certain miss they are flagged.
template <std::floating_point T, class Shadow>
inline RunningVerdict quadratic(const RunningError<T, Shadow>& a, const RunningError<T, Shadow>& b,
                                const RunningError<T, Shadow>& c, RunningError<T, Shadow>* t0,
                                RunningError<T, Shadow>* t1) {
    using Enclosure = Interval<T>;
    const auto widened = [](const auto& x) { return running_errors::Bound(x.lower(), x.upper()); };
    const auto rounded = [](const auto& x) { return hull(Enclosure(x.inf()), Enclosure(x.sup())); };
    const auto bounds = running_errors::root_bounds(widened(a), widened(b), widened(c));
    const Enclosure low = rounded(bounds.low), high = rounded(bounds.high);
    T first, second;
    const bool computed = solve_quadratic<double>(a.value(), b.value(), c.value(), first, second);
    *t0 = RunningError<T, Shadow>(first, low);
    *t1 = RunningError<T, Shadow>(second, high);
    if constexpr (Shadow::checks)
        if (bounds.real == Verdict::yes) running_errors::shadow_roots(a, b, c, *t0, low, *t1, high);
    return {bounds.real, computed};
}

}  // namespace raybound
