// The solid cone, also truncated: x^2 + y^2 <= w^2 with w = R - slope z, 0 <= z <= R, in its own coordinates.
// slope = 1 - top_radius/radius: 1 is a full cone. Faces as for the cylinder.  F(y) = x^2 + y^2 - w^2 on the side.
#pragma once

#include "raybound/shapes/cylinder.h"

namespace raybound {

// (x, y, |R| + |slope z|), which bounds (x, y, w) and what w was rounded from; and errors of vectors turned into those
// of (x, y, w).
template <class T>
inline Vec3<T> cone_reach(const Vec3<T>& y, T radius, T slope) {
    return {y.x, y.y, radius + abs(slope * y.z)};
}
template <class T>
inline Vec3<T> cone_error(const Vec3<T>& error, T slope) {
    return {error.x, error.y, abs(slope) * error.z};
}

template <class T>
inline Banded<T> cone_form(const Vec3<T>& y, T radius, T slope, const Vec3<T>& error) {
    const T w = radius - slope * y.z;
    const Vec3<T> reach = cone_reach(y, radius, slope);
    const T squared = y.x * y.x + y.y * y.y, reach2 = reach.z * reach.z;
    return {squared - w * w, square_band(reach, squared + reach2, cone_error(error, slope)) + gamma<T>(4) * reach2};
}

// The indefinite form Q = diag(1, 1, -1) in (x, y, w). Lagrange's identity for it:
// Q(f,d)^2 - Q(f,f) Q(d,d) = (fx dw - fw dx)^2 + (fy dw - fw dy)^2 - (fx dy - fy dx)^2.
template <class T>
inline Quadratic<T> cone_quadratic(const LocalRay<T>& ray, T radius, T slope) {
    const Vec3<T>&f = ray.origin, &d = ray.direction;
    const T fw = radius - slope * f.z, dw = -(slope * d.z);
    const T mx = f.x * dw - fw * d.x, my = f.y * dw - fw * d.y, mz = f.x * d.y - f.y * d.x;
    const Vec3<T> reach = cone_reach(f, radius, slope), way{d.x, d.y, dw};
    const Vec3<T> f_error = cone_error(ray.origin_error, slope), d_error = cone_error(ray.direction_error, slope);
    const T sides = mx * mx + my * my;
    Quadratic<T> q;
    q.a = d.x * d.x + d.y * d.y - dw * dw;
    q.b = f.x * d.x + f.y * d.y - fw * dw;
    q.c = cone_form(f, radius, slope, ray.origin_error);
    q.b_band = T(2) * dot_band(reach, way, f_error, d_error);
    q.discriminant = discriminant_form(sides, gamma<T>(5) * sides, mz * mz, abs(mx) + abs(my) + abs(mz),
                                       T(2) * moment_band(reach, way, f_error, d_error));
    return q;
}

// Where a > 0 the line is inside one nappe between its roots. Where a < 0 it is inside beyond them, in both nappes; the
// solid is the nappe w >= 0, which the line enters at the higher root if w grows along it, else leaves at the lower.
// There the discriminant cannot be negative but by rounding. The caps cut the rest.
template <class T>
inline Span<T> cone_side_span(const LocalRay<T>& ray, T radius, T slope) {
    const Quadratic<T> q = cone_quadratic(ray, radius, slope);
    const Mask<T> steep = q.a<T(0), widening = -(slope * ray.direction.z)> T(0);
    if (none(is_real(q) | steep)) return no_span<T>();
    const Roots<T> roots = solve(q);
    Span<T> span = between(roots, 0);
    const Mask<T> enters = steep & widening, leaves = steep & !widening;
    span.t_in = select(enters, roots.high, select(leaves, -infinity<T>, roots.low));
    span.t_out = select(leaves, roots.low, select(enters, infinity<T>, roots.high));
    span.in_ahead = select(enters, roots.high_ahead, select(leaves, Mask<T>(false), roots.low_ahead));
    span.out_ahead = select(leaves, roots.low_ahead, select(enters, Mask<T>(false), roots.high_ahead));
    span.hit = roots.real | steep;
    return span;
}

template <class T>
inline Span<T> cone_span(const LocalRay<T>& ray, T radius, T slope) {
    const Span<T> side = cone_side_span(ray, radius, slope);
    return none(side.hit) ? side : clip(side, cap_span(ray, radius));
}

// (The nappes as for the span.)
template <class T>
inline Exit<T> cone_exit(const LocalRay<T>& ray, T radius, T slope) {
    const Quadratic<T> q = cone_quadratic(ray, radius, slope);
    const Mask<T> steep = q.a<T(0), widening = -(slope * ray.direction.z)> T(0);
    const T side = select(steep, select(widening, infinity<T>, solve(q).low), last_root(q));
    return earlier(Exit<T>{side, Index<T>(0)}, exit_of(cap_span(ray, radius)));
}

template <class T>
inline Surface<T> cone_surface(const Vec3<T>& y, const Vec3<T>& d, int face, T radius, T slope, const Vec3<T>& error) {
    if (face != 0) return cap_surface(y, face, radius, error);
    const T w = radius - slope * y.z, dw = -(slope * d.z);
    return {cone_form(y, radius, slope, error),
            {T(2) * y.x, T(2) * y.y, T(2) * slope * w},
            d.x * d.x + d.y * d.y - dw * dw};
}

template <class T>
inline UV<T> cone_uv(const Vec3<T>& y, int face, T radius, T top_radius) {
    if (face == 2) return disk_uv(y.x, y.y, top_radius);
    return cylinder_uv(y, face, radius);
}

}  // namespace raybound
