// Radiance along a bundle of rays that meet one surface, directly or in a mirror, and see one light: the base tracer's
// formulas along a known ray tree, over any number type. Instantiated with a Taylor model it bounds a whole cell.
#pragma once

#include <array>

#include "raybound/trace/shading.h"

namespace raybound {

enum class SurfaceKind : std::uint8_t { sphere, plane };

struct CellSurface {
    SurfaceKind kind = SurfaceKind::sphere;
    Vec3f center;            // or a point of the plane
    Vec3f normal;            // of the plane, a unit vector on the side of the rays
    float radius = 1;        // of the sphere, seen from outside
    Material material;       // without texture
    bool is_mirror = false;  // reflects only: radiance is that of the next surface
};

struct CellScene {
    std::vector<CellSurface> surfaces;  // in the order in which rays meet them; all but the last are mirrors
    Light light;
    Vec3f ambient;
};

// Rays whose origins and directions are affine functions of N variables.
template <int N>
struct RayFamily {
    Vec3d origin, direction;
    std::array<Vec3d, std::size_t(N)> origin_slopes, direction_slopes;
};

template <class T>
struct BundleRay {
    Vec3<T> origin, direction;
};

// The ray for the variables x, as floats: direction a unit vector. (In W, rounded to T once, like a camera's.)
template <class T, int N>
BundleRay<T> family_ray(const RayFamily<N>& family, const std::array<Wide<T>, std::size_t(N)>& x);

// The radiance along the ray. Whether it meets the surfaces and the light shines is the caller's to know: where it is
// not certain, range types give what cannot be bounded.
template <class T>
Vec3<T> cell_radiance(const CellScene& scene, const BundleRay<T>& ray);

}  // namespace raybound
