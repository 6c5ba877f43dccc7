// The disk z = 0, x^2 + y^2 <= R^2 in its own coordinates. One face, with its normal toward +z.
#pragma once

#include "raybound/shapes/surface.h"

namespace raybound {

// A single crossing, t_in; there is no way out. `climb` is how fast the height changes along the ray: where its sign is
// unsure the ray is parallel.
template <class T>
inline Span<T> sheet_span(const Banded<T>& height, const Banded<T>& climb, Mask<T> inside) {
    const Mask<T> parallel = abs(climb.value) <= climb.band;
    Span<T> span;
    span.t_in = -(height.value / climb.value);
    span.t_out = infinity<T>;
    span.face_in = span.face_out = Index<T>(0);
    span.hit = inside & !parallel;
    span.in_ahead = (abs(height.value) > height.band) & ((height.value > T(0)) != (climb.value > T(0)));
    span.out_ahead = Mask<T>(false);
    return span;
}

template <class T>
inline Span<T> disk_span(const LocalRay<T>& ray, T radius) {
    const Vec3<T>&f = ray.origin, &d = ray.direction;
    const T t = -(f.z / d.z);
    const T x = f.x + t * d.x, y = f.y + t * d.y;
    return sheet_span(Banded<T>{f.z, ray.origin_error.z}, Banded<T>{d.z, ray.direction_error.z},
                      x * x + y * y <= radius * radius);
}

template <class T>
inline Surface<T> disk_surface(const Vec3<T>& y, const Vec3<T>& error) {
    return axis_plane_surface(y, 2, T(0), T(1), error);
}

}  // namespace raybound
