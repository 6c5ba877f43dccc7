// Roots of a t^2 + 2 b t + c along a ray, with what can be said for certain about their signs (derivation D2).
#pragma once

#include "raybound/shapes/span.h"

namespace raybound {

// The value of a surface function with a bound of its error.
template <class T>
struct Banded {
    T value, band;
};

template <class T>
struct Quadratic {
    T a, b;
    Banded<T> c, discriminant;  // b^2 - a c, from a form that does not cancel (Lagrange's identity)
    T b_band;
};

// Which roots exist and lie ahead.
template <class T>
struct RootSigns {
    Mask<T> real, low_ahead, high_ahead;
};

template <class T>
struct Roots {
    T low, high;
    Mask<T> real, low_ahead, high_ahead;
};

template <class T>
inline Mask<T> is_real(const Quadratic<T>& q) {
    return q.discriminant.value >= T(0);
}

// Signs of roots follow from those of a, b and c alone, not from rounded roots. With P = c/a the product and
// S = -2b/a the sum: P > 0 gives two roots of the sign of S, P < 0 one of each. Where |c| is within its band (the
// origin is on the surface) one root is "at the origin" and not ahead; the other has the sign of S.
template <class T>
[[gnu::always_inline]] inline RootSigns<T> root_signs(const Quadratic<T>& q) {
    const T sign = copysign(T(1), q.a);
    const T product = q.c.value * sign, sum = -q.b * sign;
    const Mask<T> at_surface = abs(q.c.value) <= q.c.band;
    const Mask<T> rising = sum > select(at_surface, q.b_band, T(0));
#ifdef RAYBOUND_SABOTAGE_PREDICATE
    const Mask<T> low = (product > -q.c.band) & rising;  // the sabotage build: unknown is read as yes
#else
    const Mask<T> low = (product > q.c.band) & rising;
#endif
    return {is_real(q), low, Mask<T>((product < -q.c.band) | rising)};
}

// -(b +- sqrt(discriminant)) with the sign of b, where nothing cancels: this over a is one root, c over this the other.
template <class T>
inline T stable_numerator(const T& b, const T& discriminant) {
    const T root = sqrt(maximum(T(0), discriminant));
    return -(b + copysign(root, b));
}

template <class T>
[[gnu::always_inline]] inline Roots<T> solve(const Quadratic<T>& q) {
    const RootSigns<T> signs = root_signs(q);
    const T stable = stable_numerator(q.b, q.discriminant.value);
    const T first = stable / q.a;
    const T second = select(stable == T(0), first, q.c.value / stable);
    return {minimum(first, second), maximum(first, second), signs.real, signs.low_ahead, signs.high_ahead};
}

// |f . d computed - exact| where the components of f and d have the given errors: three products and two sums, and the
// errors of the factors.
template <class T>
inline T dot_band(const Vec3<T>& f, const Vec3<T>& d, const Vec3<T>& f_error, const Vec3<T>& d_error) {
    const Vec3<T> f_size = absolute(f), d_size = absolute(d);
    return gamma<T>(4) * dot(f_size, d_size) + dot(f_error, d_size) + dot(d_error, f_size + f_error);
}

// The same for any component of f x d, from norms: it is only a filter's.
template <class T>
inline T moment_band(const Vec3<T>& f, const Vec3<T>& d, const Vec3<T>& f_error, const Vec3<T>& d_error) {
    const T f_norm = norm1(f), d_norm = norm1(d), f_off = norm1(f_error), d_off = norm1(d_error);
    return gamma<T>(4) * f_norm * d_norm + f_off * d_norm + d_off * (f_norm + f_off);
}

// The same for f . f - R^2, where `squares` is f . f + R^2.
template <class T>
inline T square_band(const Vec3<T>& f, T squares, const Vec3<T>& f_error) {
    return gamma<T>(6) * squares + dot(absolute(f) * T(2) + f_error, f_error);
}

// The discriminant as `whole` - |moment|^2 with whole = R^2 a: bands of the moment's components (two products each,
// whose factors carry errors: twice dot_band) and of whole.
template <class T>
inline Banded<T> discriminant_form(T whole, T whole_band, T moment_squared, T moment_norm, T moment_band) {
    const T band = whole_band + gamma<T>(5) * moment_squared + (T(2) * moment_norm + T(3) * moment_band) * moment_band;
    return {whole - moment_squared, band};
}

// The filter for a number type that is not the one that decides: the line certainly misses the surface, or the ray
// certainly leaves it behind (for surfaces that only a > 0 can hit twice).
template <class T>
inline Mask<T> certainly_missed(const Quadratic<T>& q) {
    return (q.discriminant.value < -q.discriminant.band) | ((q.a > T(0)) & (q.c.value > q.c.band) & (q.b > q.b_band));
}

// Where a ray that is inside leaves: at the later root. A line that misses, by rounding, does so where it is closest.
template <class T>
inline T last_root(const Quadratic<T>& q) {
    return select(is_real(q), solve(q).high, -(q.b / q.a));
}

template <class T>
inline Span<T> between(const Roots<T>& roots, int face) {
    return {roots.low, roots.high, face, face, roots.real, roots.low_ahead, roots.high_ahead};
}

template <class T>
inline Span<T> no_span() {
    const Mask<T> no(false);
    return {T(0), T(0), 0, 0, no, no, no};
}

}  // namespace raybound
