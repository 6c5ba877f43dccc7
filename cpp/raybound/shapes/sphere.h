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

// Discriminant by Lagrange's identity: (f.d)^2 - |d|^2 (|f|^2 - R^2) = R^2 |d|^2 - |f x d|^2, which keeps its digits
// when the origin is far away.
template <class T>
inline Quadratic<T> sphere_quadratic(const LocalRay<T>& ray, T radius) {
    const Vec3<T>&f = ray.origin, &d = ray.direction;
    const Vec3<T> moment = cross(f, d);
    Quadratic<T> q;
    const T r2 = radius * radius;
    q.a = dot(d, d);
    q.b = dot(f, d);
    q.c = sphere_form(f, radius, ray.origin_error);
    q.b_band = dot_band(f, d, ray.origin_error, ray.direction_error);
    q.discriminant = discriminant_form(r2 * q.a, r2 * square_band(d, q.a, ray.direction_error), dot(moment, moment),
                                       norm1(moment), moment_band(f, d, ray.origin_error, ray.direction_error));
    return q;
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
    return between(solve(sphere_quadratic(ray, radius)), 0);
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
