// Taylor models where a function has a kink: comparisons, what holds either of two models, |x|, minimum and maximum
// (cpp/derivations.md, D32).
#pragma once

#include "raybound/numbers/taylor_model.h"

namespace raybound {

// b - a as real numbers: an execution's comparison rounds nothing.
template <int N, Arithmetic A>
inline TaylorModel<N, Arithmetic::real> exact_difference(const TaylorModel<N, A>& b, const TaylorModel<N, A>& a) {
    using Real = TaylorModel<N, Arithmetic::real>;
    return Real(b) - Real(a);
}

template <int N, Arithmetic A>
inline Verdict operator<(const TaylorModel<N, A>& a, const TaylorModel<N, A>& b) {
    if (a.high() < b.low()) return Verdict::yes;
    if (a.low() >= b.high()) return Verdict::no;
    const auto difference = exact_difference(b, a);
    return difference.low() > 0 ? Verdict::yes : difference.high() <= 0 ? Verdict::no : Verdict::unknown;
}
template <int N, Arithmetic A>
inline Verdict operator>(const TaylorModel<N, A>& a, const TaylorModel<N, A>& b) {
    return b < a;
}
template <int N, Arithmetic A>
inline Verdict operator>=(const TaylorModel<N, A>& a, const TaylorModel<N, A>& b) {
    return !(a < b);
}
template <int N, Arithmetic A>
inline Verdict operator<=(const TaylorModel<N, A>& a, const TaylorModel<N, A>& b) {
    return !(b < a);
}
template <int N, Arithmetic A>
inline Verdict operator==(const TaylorModel<N, A>& a, const TaylorModel<N, A>& b) {
    const auto difference = exact_difference(b, a);
    if (difference.low() > 0 || difference.high() < 0) return Verdict::no;
    return difference.is_constant() && difference.constant() == 0 ? Verdict::yes : Verdict::unknown;
}

// What holds both: their mean, and half of how far they are apart.
template <int N, Arithmetic A>
inline TaylorModel<N, A> hull(const TaylorModel<N, A>& a, const TaylorModel<N, A>& b) {
    using Real = TaylorModel<N, Arithmetic::real>;
    if (!a.is_known() || !b.is_known()) return TaylorModel<N, A>::entire();
    const Real half(0.5), x(a), y(b), mean = (x + y) * half, apart = (x - y) * half;
    const double rest = std::fmax(a.remainder(), b.remainder());
    const Real middle = Real::certified(mean.polynomial(), mean.remainder() - rest > 0 ? mean.remainder() : rest);
    return TaylorModel<N, A>(Real::certified(middle.polynomial(), middle.remainder() + apart.magnitude()));
}
template <int N, Arithmetic A>
inline TaylorModel<N, A> select(Verdict which, const TaylorModel<N, A>& yes, const TaylorModel<N, A>& no) {
    if (which == Verdict::unknown) return hull(yes, no);
    return which == Verdict::yes ? yes : no;
}

// |x|. Where x changes sign in [low, high] it lies within a band along the chord: s x + [0, -2 low high / (high - low)]
// with s = (high + low) / (high - low); the graph touches the band's lower edge at 0 and the upper one at the ends.
template <int N, Arithmetic A>
inline TaylorModel<N, A> abs(const TaylorModel<N, A>& a) {
    if (!a.is_known()) return a;
    const double low = a.low(), high = a.high();
    if (low >= 0) return a;
    if (high <= 0) return -a;
    using Real = TaylorModel<N, Arithmetic::real>;
    // Halved: high - low may overflow.
    const double width = 0.5 * high - 0.5 * low, slope = (0.5 * high + 0.5 * low) / width,
                 band = -low * (high / width) * upward + underflow_bound;
    const Real along = Real(a) * Real(slope) + Real(0.5 * band);
    // The band was derived for the exact slope: one rounded by u moves it by u |x| at most.
    const double moved = 0x1p-51 * std::fmax(-low, high);
    return TaylorModel<N, A>(Real::certified(along.polynomial(), along.remainder() + 0.5 * band + moved));
}

// The larger (or smaller) of two models: their mean and half of how far they are apart, if it is not the same one
// everywhere.
template <int N, Arithmetic A>
inline TaylorModel<N, A> maximum(const TaylorModel<N, A>& a, const TaylorModel<N, A>& b) {
    const Verdict less = a < b;
    if (less != Verdict::unknown) return less == Verdict::yes ? b : a;
    using Real = TaylorModel<N, Arithmetic::real>;
    const Real x(a), y(b);
    return TaylorModel<N, A>((x + y + abs(x - y)) * Real(0.5));
}
template <int N, Arithmetic A>
inline TaylorModel<N, A> minimum(const TaylorModel<N, A>& a, const TaylorModel<N, A>& b) {
    if (b.is_constant() && a.magnitude() * upward < b.constant()) return a;  // as where radiance is saturated
    const Verdict less = b < a;
    if (less != Verdict::unknown) return less == Verdict::yes ? b : a;
    using Real = TaylorModel<N, Arithmetic::real>;
    const Real x(a), y(b);
    return TaylorModel<N, A>((x + y - abs(x - y)) * Real(0.5));
}

// The magnitude of the first with the sign of the second.
template <int N, Arithmetic A>
inline TaylorModel<N, A> copysign(const TaylorModel<N, A>& magnitude, const TaylorModel<N, A>& sign) {
    const TaylorModel<N, A> size = abs(magnitude);
    return select(sign < TaylorModel<N, A>(0), -size, size);
}

}  // namespace raybound
