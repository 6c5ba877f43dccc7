// The sphere |y| = R about the local origin.  F(y) = |y|^2 - R^2.
#pragma once

#include "raybound/shapes/quadratic.h"
#include "raybound/shapes/surface.h"

namespace raybound {

template <class T>
inline Banded<T> sphere_form(const Vec3<T>& y, T radius, const Vec3<T>& error) {
    const T squared = dot(y, y), r2 = radius * radius;
    return {squared - r2, square_band(y, squared + r2, error)};
}

// What the quadratic consists of. Discriminant by Lagrange's identity: (f.d)^2 - |d|^2 (|f|^2 - R^2) =
// R^2 |d|^2 - |f x d|^2, which keeps its digits when the origin is far away.
template <class T>
struct SphereTerms {
    T a, b, r2;
    Vec3<T> moment;
};

template <class T>
inline SphereTerms<T> sphere_terms(const Vec3<T>& f, const Vec3<T>& d, T radius) {
    return {dot(d, d), dot(f, d), radius * radius, cross(f, d)};
}

template <class T>
inline Quadratic<T> sphere_quadratic(const LocalRay<T>& ray, T radius) {
    const Vec3<T>&f = ray.origin, &d = ray.direction;
    const SphereTerms<T> terms = sphere_terms(f, d, radius);
    Quadratic<T> q;
    q.a = terms.a;
    q.b = terms.b;
    q.c = sphere_form(f, radius, ray.origin_error);
    q.b_band = dot_band(f, d, ray.origin_error, ray.direction_error);
    q.discriminant = discriminant_form(terms.r2 * q.a, terms.r2 * square_band(d, q.a, ray.direction_error),
                                       dot(terms.moment, terms.moment), norm1(terms.moment),
                                       moment_band(f, d, ray.origin_error, ray.direction_error));
    return q;
}

// The filter for spheres without a frame: the same terms, with bands from norms, which are cheaper and no narrower
// (`error` bounds the sum of the errors of f's components, `reach` is the sum of d's).
template <class T>
inline Mask<T> sphere_missed(const Vec3<T>& center, T radius, const Vec3<T>& origin, const Vec3<T>& d, T reach) {
    const Vec3<T> f = origin - center;
    const SphereTerms<T> terms = sphere_terms(f, d, radius);
    const T size = norm1(f), error = (size + norm1(center)) * gamma<T>(3);
    const T squares = dot(f, f), moment_band = (gamma<T>(5) * size + error) * reach;
    const T c = squares - terms.r2, c_band = gamma<T>(7) * (squares + terms.r2) + (T(2) * size + error) * error;
    const T whole = terms.r2 * terms.a, moment_squared = dot(terms.moment, terms.moment);
    const Banded<T> discriminant =
        discriminant_form(whole, gamma<T>(8) * whole * T(2), moment_squared, norm1(terms.moment), moment_band);
    return (discriminant.value < -discriminant.band) | ((c > c_band) & (terms.b > moment_band));
}

// A point from a sphere's centre, with one rounding of each.
template <class T>
inline Vec3<T> sphere_point_error(const Vec3<T>& y, const Vec3<T>& center) {
    return (absolute(y) + absolute(center)) * gamma<T>(2);
}

// A ray in the coordinates of a sphere without a frame.
template <class T>
inline LocalRay<T> sphere_ray(const Vec3<T>& center, const Vec3<T>& origin, const Vec3<T>& direction) {
    const Vec3<T> y = origin - center;
    return {y, direction, sphere_point_error(y, center), {}};
}

template <class T>
inline Span<T> sphere_span(const LocalRay<T>& ray, T radius) {
    const Quadratic<T> q = sphere_quadratic(ray, radius);
    return none(is_real(q)) ? no_span<T>() : between(solve(q), 0);
}

template <class T>
inline Exit<T> sphere_exit(const LocalRay<T>& ray, T radius) {
    return {last_root(sphere_quadratic(ray, radius)), Index<T>(0)};
}

// The part of it ahead of the origin: the same, but nothing is said of a line whose crossings lie behind, which most
// rays that leave a sphere are to it.
template <class T>
inline Span<T> sphere_span_ahead(const LocalRay<T>& ray, T radius) {
    const Quadratic<T> q = sphere_quadratic(ray, radius);
    const RootSigns<T> signs = root_signs(q);
    if (none(signs.real & signs.high_ahead)) return no_span<T>();
    return between(solve(q), 0);
}

template <class T>
inline Surface<T> sphere_surface(const Vec3<T>& y, const Vec3<T>& d, T radius, const Vec3<T>& error) {
    return {sphere_form(y, radius, error), y * T(2), dot(d, d)};
}

// u: longitude from +x, counter-clockwise seen from +z; v: from the south pole (0) to the north pole (1).
template <class T>
inline UV<T> sphere_uv(const Vec3<T>& y, T radius) {
    const T cosine = minimum(maximum(y.z / radius, T(-1)), T(1));
    return {turn(y.y, y.x), T(1) - acos(cosine) * T(1 / elementary::pi)};
}

}  // namespace raybound
