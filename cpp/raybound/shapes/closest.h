// The point of a triangle that is closest to a point (Ericson, Real-Time Collision Detection, 2005, 5.1.5).
#pragma once

#include "raybound/shapes/triangle.h"

namespace raybound {

// Weights of the corners, which add up to 1.
struct CornerWeights {
    double a = 0, b = 0, c = 0;
};

inline CornerWeights closest_weights(const Corners<double>& corners, const Vec3d& p) {
    const Vec3d ab = corners.b - corners.a, ac = corners.c - corners.a;
    const Vec3d ap = p - corners.a, bp = p - corners.b, cp = p - corners.c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                 d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    if (const double along = d4 - d3, back = d5 - d6; va <= 0 && along >= 0 && back >= 0)
        return {0, 1 - along / (along + back), along / (along + back)};
    const double sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

}  // namespace raybound
