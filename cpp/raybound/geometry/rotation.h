// Rotations, in double.
#pragma once

#include "raybound/geometry/matrix.h"
#include "raybound/numbers/elementary.h"

namespace raybound {

// v turned about the unit vector k, counter-clockwise seen from its tip (Rodrigues).
inline Vec3d rotated(const Vec3d& v, const Vec3d& k, double degrees) {
    const double angle = degrees * (elementary::pi / 180), c = std::cos(angle), s = std::sin(angle);
    return v * c + cross(k, v) * s + k * (dot(k, v) * (1 - c));
}

inline Affine rotation(const Vec3d& k, double degrees) {
    return {
        from_columns(rotated({1, 0, 0}, k, degrees), rotated({0, 1, 0}, k, degrees), rotated({0, 0, 1}, k, degrees)),
        {}};
}

}  // namespace raybound
