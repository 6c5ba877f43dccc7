// How well the crossing of a face is known along a ray.
#pragma once

#include "raybound/shapes/leaf.h"

namespace raybound {

// How far the root t of a face's F along the ray can be from the true one. With |F(t)| <= r: for a slope s = F'(t) and
// curvature k the nearest root is within 2 r / |s| where the roots are real, and within sqrt(r / |k|) always, since the
// product of the distances to both roots is |F(t) / k| (derivation D3).
template <class T>
inline T root_error(T residual, T slope, T curvature) {
    const T by_slope = T(2) * residual / abs(slope), by_curvature = sqrt(residual / abs(curvature));
    const T bound = select(by_curvature < by_slope, by_curvature, by_slope);
    return select(residual > T(0), bound, T(0));
}

// The same for a crossing found by the kernel: the residual is F where the crossing is, its band, and the rounding of
// that point. (How far the leaf is off the user's surface, surface_error, is not in it: surface_point adds that.)
template <class T>
inline T boundary_error(const Geometry& geometry, const Leaf& leaf, int face, T t, const Ray<T>& ray) {
    const Mask<T> finite = abs(t) < infinity<T>;
    if (none(finite)) return T(0);
    const Vec3<T> way = ray.direction * t, p = ray.origin + way;
    const Surface<T> surface = leaf_surface(geometry, leaf, face, p, ray.direction);
    const T rounding = gamma<T>(3) * dot(absolute(surface.gradient), absolute(ray.origin) + absolute(way));
    const T residual = abs(surface.form.value) + surface.form.band + rounding;
    return select(finite, root_error(residual, dot(surface.gradient, ray.direction), surface.curvature), T(0));
}

}  // namespace raybound
