// The solid cylinder x^2 + y^2 <= R^2, 0 <= z <= R in its own coordinates.
// Faces: 0 side, 1 base (z = 0), 2 top.  F(y) = x^2 + y^2 - R^2 on the side.
#pragma once

#include "raybound/shapes/surface.h"

namespace raybound {

// Across the axis.
template <class T>
inline Vec3<T> flat(const Vec3<T>& v) {
    return {v.x, v.y, T(0)};
}

template <class T>
inline Banded<T> cylinder_form(const Vec3<T>& y, T radius, const Vec3<T>& error) {
    const T squared = y.x * y.x + y.y * y.y, r2 = radius * radius;
    return {squared - r2, square_band(flat(y), squared + r2, flat(error))};
}

// As for the sphere, in two dimensions: discriminant R^2 a - (f x d)_z^2.
template <class T>
inline Quadratic<T> cylinder_quadratic(const LocalRay<T>& ray, T radius) {
    const Vec3<T> f = flat(ray.origin), d = flat(ray.direction);
    const Vec3<T> f_error = flat(ray.origin_error), d_error = flat(ray.direction_error);
    const T moment = f.x * d.y - f.y * d.x, r2 = radius * radius;
    Quadratic<T> q;
    q.a = d.x * d.x + d.y * d.y;
    q.b = f.x * d.x + f.y * d.y;
    q.c = cylinder_form(f, radius, f_error);
    q.b_band = dot_band(f, d, f_error, d_error);
    q.discriminant = discriminant_form(r2 * q.a, r2 * square_band(d, q.a, d_error), moment * moment, abs(moment),
                                       moment_band(f, d, f_error, d_error));
    return q;
}

// A ray this close to the axis's direction drifts sideways by less than 2^-40 of its way: it is inside or outside for
// good, and the quadratic would only divide by the noise.
template <class T>
inline Mask<T> along_axis(const Vec3<T>& d) {
    return d.x * d.x + d.y * d.y <= T(0x1p-80) * d.z * d.z;
}

template <class T>
inline Span<T> cylinder_side_span(const LocalRay<T>& ray, T radius) {
    const Quadratic<T> q = cylinder_quadratic(ray, radius);
    const Mask<T> along = along_axis(ray.direction);
    if (none(is_real(q) | along)) return no_span<T>();
    Span<T> span = between(solve(q), 0);
    span.t_in = select(along, -infinity<T>, span.t_in);
    span.t_out = select(along, infinity<T>, span.t_out);
    span.hit = select(along, q.c.value <= T(0), span.hit);
    return span;
}

template <class T>
inline Span<T> cap_span(const LocalRay<T>& ray, T height) {
    return slab_span(ray, 2, T(0), height, 1);
}

template <class T>
inline Span<T> cylinder_span(const LocalRay<T>& ray, T radius) {
    const Span<T> side = cylinder_side_span(ray, radius);
    return none(side.hit) ? side : clip(side, cap_span(ray, radius));
}

template <class T>
inline Exit<T> cylinder_exit(const LocalRay<T>& ray, T radius) {
    const T side = select(along_axis(ray.direction), infinity<T>, last_root(cylinder_quadratic(ray, radius)));
    return earlier(Exit<T>{side, Index<T>(0)}, exit_of(cap_span(ray, radius)));
}

template <class T>
inline Surface<T> cap_surface(const Vec3<T>& y, int face, T height, const Vec3<T>& error) {
    return axis_plane_surface(y, 2, face == 2 ? height : T(0), face == 2 ? T(1) : T(-1), error);
}

template <class T>
inline Surface<T> cylinder_surface(const Vec3<T>& y, const Vec3<T>& d, int face, T radius, const Vec3<T>& error) {
    if (face != 0) return cap_surface(y, face, radius, error);
    return {cylinder_form(y, radius, error), {T(2) * y.x, T(2) * y.y, T(0)}, d.x * d.x + d.y * d.y};
}

// Side: u around the axis, v along it. Caps: the square around the disk, seen from outside.
template <class T>
inline UV<T> cylinder_uv(const Vec3<T>& y, int face, T radius) {
    if (face == 0) return {turn(y.y, y.x), unit_clamp(y.z / radius)};
    return disk_uv(face == 2 ? y.x : -y.x, y.y, radius);
}

}  // namespace raybound
