// A face of a shape as the zero set of a function F, negative inside: what hit points are polished with.
#pragma once

#include "raybound/numbers/elementary.h"
#include "raybound/shapes/quadratic.h"

namespace raybound {

// F at a point (with the bound of its error), its gradient there, and its second-order coefficient along a direction d
// (F(y + s d) = F + s gradient.d + s^2 curvature).
template <class T>
struct Surface {
    Banded<T> form;
    Vec3<T> gradient;
    T curvature;
};

template <class T>
struct UV {
    T u{}, v{};
};

// Rounding may put a coordinate outside of [0, 1] by an ulp: not to be, for textures that repeat.
template <class T>
inline T unit_clamp(T x) {
    return minimum(maximum(x, T(0)), T(1));
}

// The angle of (x, y) as a fraction of a turn in [0, 1].
template <class T>
inline T turn(T y, T x) {
    const T fraction = atan2(y, x) * T(0.5 / elementary::pi);
    return select(fraction < T(0), fraction + T(1), fraction);
}

// The plane where coordinate `axis` is `level`; `sign` +1 if the solid lies below.
template <class T>
inline Surface<T> axis_plane_surface(const Vec3<T>& y, int axis, T level, T sign, const Vec3<T>& error) {
    Vec3<T> gradient;
    gradient[axis] = sign;
    return {{sign * (y[axis] - level), error[axis] + gamma<T>(1) * abs(y[axis] - level)}, gradient, T(0)};
}

// The square around a disk, from 0 to 1; the centre of a disk without extent is its middle.
template <class T>
inline T disk_coordinate(T x, T radius) {
    const T fraction = select(radius > T(0), x / radius, T(0));
    return unit_clamp((fraction + T(1)) * T(0.5));
}
template <class T>
inline UV<T> disk_uv(T x, T y, T radius) {
    return {disk_coordinate(x, radius), disk_coordinate(y, radius)};
}

}  // namespace raybound
