// Affine maps of points, vectors and rays, with bounds of what rounding does to them (seeds/000, 3.9.4).
//
// The matrix is exact as it stands in T. Bounds are sums over intervals, hence rounded up; they hold where products
// underflow, too, which the seeds leave out. Where a result overflows the bound is infinite. Measured by
// tests/numbers/test_transform_errors.py: the largest error seen is 0.69 of its bound, the median 0.1.
#pragma once

#include "raybound/geometry/matrix.h"
#include "raybound/geometry/ray.h"
#include "raybound/numbers/interval.h"

namespace raybound {

// A point or vector, and bounds of the absolute errors of its components.
template <class T>
struct WithError {
    Vec3<T> value, error;
};

// In the order of the seeds, by pairs: no term is rounded more than three times.
template <class T>
constexpr T affine_row(const Vec3<T>& row, const T& shift, const Vec3<T>& p) {
    return (row.x * p.x + row.y * p.y) + (row.z * p.z + shift);
}

// (gamma_3 + 1) sum |m| error + gamma_3 (sum |m p| + |shift|), eq. 3.16; without error, eq. 3.15. Each of three
// products may lose half a subnormal: two of them, with room for the sums.
template <std::floating_point T>
inline T affine_row_error(const Vec3<T>& row, T shift, const WithError<T>& p) {
    using Bound = Interval<T>;
    const Vec3<Bound> size(absolute(row));
    const Bound rounding(gamma<T>(3)), terms = affine_row(size, Bound(abs(shift)), Vec3<Bound>(absolute(p.value)));
    const Bound underflow(2 * std::numeric_limits<T>::denorm_min());
    return ((rounding + Bound(T(1))) * dot(size, Vec3<Bound>(p.error)) + rounding * terms + underflow).sup();
}

// m p + offset. The identity rounds nothing. A vector is a point with offset 0.
template <std::floating_point T>
inline WithError<T> transformed(const Mat3<T>& m, const Vec3<T>& offset, const WithError<T>& p) {
    if (m == Mat3<T>{} && offset == Vec3<T>{}) return p;
    WithError<T> result;
    for (int i = 0; i < 3; ++i) {
        result.value[i] = affine_row(m.row[i], offset[i], p.value);
        const bool finite = std::isfinite(result.value[i]);
        result.error[i] = finite ? affine_row_error(m.row[i], offset[i], p) : infinity<T>;
    }
    return result;
}

// The image of a ray. Its origin is that of the image moved forward by `moved` along the direction.
template <class T>
struct TransformedRay {
    WithError<T> origin, direction;
    T moved, t_max;
};

// How far along d the box of an error reaches: |d| . error / |d|^2, rounded up. 0 where d is so small that it cannot be
// told.
template <std::floating_point T>
inline T reach_along(const Vec3<T>& d, const Vec3<T>& error) {
    using Bound = Interval<T>;
    const Vec3<Bound> size(absolute(d));
    const T reach = (dot(size, Vec3<Bound>(error)) / dot(size, size)).sup();
    return std::isfinite(reach) ? reach : T(0);
}

// p + d t, rounded forward, and the error of that as a point of the exact ray from near p along near d.
template <std::floating_point T>
inline WithError<T> advanced(const WithError<T>& p, const WithError<T>& d, T t) {
    using Bound = Interval<T>;
    if (t == 0) return p;
    WithError<T> result;
    for (int i = 0; i < 3; ++i) {
        const T offset = d.value[i] * t;
        result.value[i] = step_away(p.value[i], offset, offset);
        const Bound exact = Bound(p.value[i]) + Bound(d.value[i]) * Bound(t);
        const Bound own((Bound(result.value[i]) - exact).mag());
        result.error[i] = (own + Bound(p.error[i]) + Bound(d.error[i]) * Bound(t)).sup();
    }
    return result;
}

// The origin is moved to the front of its error box, so that what the box may hold lies behind it, and t_max comes
// nearer by as much (rounded down).
template <std::floating_point T>
inline TransformedRay<T> transformed_ray(const Mat3<T>& m, const Vec3<T>& offset, const WithError<T>& origin,
                                         const WithError<T>& direction, T t_max) {
    const WithError<T> o = transformed(m, offset, origin), d = transformed(m, Vec3<T>{}, direction);
    const T moved = reach_along(d.value, o.error);
    return {advanced(o, d, moved), d, moved, subtract_down(t_max, moved)};
}

}  // namespace raybound
