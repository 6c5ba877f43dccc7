// Where rays meet primitives: which crossing counts, and the hit point with bounds of its errors.
#pragma once

#include "raybound/shapes/geometry.h"

namespace raybound {

// The first crossing of a primitive that certainly lies ahead of a ray's origin.
template <class T>
struct Crossing {
    T t;
    std::uint32_t leaf;
    std::int32_t face;         // of the leaf
    std::int32_t face_offset;  // of the leaf's faces within the object
    Mask<T> hit;
};

template <class T>
Crossing<T> first_crossing(const Geometry& geometry, const Primitive& primitive, const Ray<T>& ray);

// Does the primitive block the segment, certainly after its origin and certainly before its target? Found in T,
// confirmed in the wide type, for which both ends are exact.
template <class T>
Mask<T> blocks(const Geometry& geometry, const Primitive& primitive, const Ray<T>& ray);

// A hit with its error bounds. The box point +- point_error holds a point of the surface; t +- t_error holds the ray's
// crossing of it (derivation D3). `normal` is the outward unit normal.
template <class T>
struct SurfacePoint {
    T t, t_error;
    Vec3<T> point, point_error, normal;
    UV<T> uv;
};

template <class T>
SurfacePoint<T> surface_point(const Geometry& geometry, const Crossing<T>& crossing, const Ray<T>& ray);

}  // namespace raybound
