// The box lower <= y <= upper. Faces: 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z.
#pragma once

#include "raybound/shapes/surface.h"

namespace raybound {

template <class T>
[[gnu::always_inline]] inline Span<T> box_span(const LocalRay<T>& ray, const Vec3<T>& lower, const Vec3<T>& upper) {
    const Span<T> x = slab_span(ray, 0, lower.x, upper.x, 0);
    const Span<T> y = slab_span(ray, 1, lower.y, upper.y, 2);
    const Span<T> z = slab_span(ray, 2, lower.z, upper.z, 4);
    return clip(clip(x, y), z);
}

template <class T>
inline Surface<T> box_surface(const Vec3<T>& y, int face, const Vec3<T>& lower, const Vec3<T>& upper,
                              const Vec3<T>& error) {
    const int axis = face / 2;
    const bool high = face % 2 == 1;
    return axis_plane_surface(y, axis, high ? upper[axis] : lower[axis], high ? T(1) : T(-1), error);
}

// Each face carries [0, 1]^2, seen from outside with u to the right and v up (z for the sides, y for top and bottom).
template <class T>
inline UV<T> box_uv(const Vec3<T>& y, int face, const Vec3<T>& lower, const Vec3<T>& upper) {
    const Vec3<T> size = upper - lower, along = y - lower;
    const Vec3<T> s{unit_clamp(along.x / size.x), unit_clamp(along.y / size.y), unit_clamp(along.z / size.z)};
    switch (face) {
        case 0:
            return {T(1) - s.y, s.z};
        case 1:
            return {s.y, s.z};
        case 2:
            return {s.x, s.z};
        case 3:
            return {T(1) - s.x, s.z};
        case 4:
            return {T(1) - s.x, s.y};
        default:
            return {s.x, s.y};
    }
}

}  // namespace raybound
