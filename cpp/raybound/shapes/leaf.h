// Dispatch over the kinds of leaves: spans, surfaces and (u,v), each formula in the shape's own header.
#pragma once

#include "raybound/shapes/box.h"
#include "raybound/shapes/cone.h"
#include "raybound/shapes/cylinder.h"
#include "raybound/shapes/disk.h"
#include "raybound/shapes/geometry.h"
#include "raybound/shapes/polygon.h"
#include "raybound/shapes/sphere.h"

namespace raybound {

// In T or, for packs, in T's lanes.
template <class T>
inline decltype(auto) frame_linear(const Frame& frame) {
    if constexpr (std::is_same_v<T, float>)
        return (frame.linear);
    else if constexpr (std::is_same_v<T, double>)
        return (frame.linear_wide);
    else
        return Mat3<T>(frame_linear<Scalar<T>>(frame));
}
template <class T>
inline decltype(auto) frame_center(const Frame& frame) {
    if constexpr (std::is_same_v<T, float>)
        return (frame.center);
    else if constexpr (std::is_same_v<T, double>)
        return (frame.center_wide);
    else
        return Vec3<T>(frame_center<Scalar<T>>(frame));
}

// A point in local coordinates with the bound of its components' error: one rounding of the difference, three of the
// product, one of the matrix's entries and one of the centre (derivation D1).
template <class T>
struct LocalPoint {
    Vec3<T> y;
    Vec3<T> error;
};

template <class T>
inline LocalPoint<T> to_local(const Frame& frame, const Vec3<T>& p) {
    const Vec3<T>& center = frame_center<T>(frame);
    const Vec3<T> r = p - center;
    const T reach = gamma<T>(6) * norm1(r) + gamma<T>(1) * norm1(center);
    return {frame_linear<T>(frame) * r, Vec3<T>(frame.row_norm) * reach};
}

template <class T>
inline LocalRay<T> local_ray(const Frame& frame, const Ray<T>& ray) {
    const LocalPoint<T> origin = to_local(frame, ray.origin);
    const Vec3<T> d = frame_linear<T>(frame) * ray.direction;
    return {origin.y, d, origin.error, Vec3<T>(frame.row_norm) * (gamma<T>(5) * norm1(ray.direction))};
}

// Without a frame.
template <class T>
inline LocalPoint<T> to_sphere(const Leaf& leaf, const Vec3<T>& p) {
    const Vec3<T> center(leaf.first), y = p - center;
    return {y, sphere_point_error(y, center)};
}

template <class T>
inline Span<T> framed_span(const Leaf& leaf, const Frame& frame, const LocalRay<T>& ray) {
    const T radius = T(frame.radius);
    switch (leaf.kind) {
        case LeafKind::sphere:
            return sphere_span(ray, radius);
        case LeafKind::box:
            return box_span(ray, {-radius, -radius, -radius}, {radius, radius, radius});
        case LeafKind::cylinder:
            return cylinder_span(ray, radius);
        case LeafKind::cone:
            return cone_span(ray, radius, T(frame.slope));
        default:
            return disk_span(ray, radius);
    }
}

// A ray in the coordinates of a leaf that is not a polygon.
template <class T>
inline LocalRay<T> leaf_ray(const Geometry& geometry, const Leaf& leaf, const Ray<T>& ray) {
    if (leaf.frame >= 0) return local_ray(geometry.frames[std::size_t(leaf.frame)], ray);
    if (leaf.kind == LeafKind::box) return {ray.origin, ray.direction, Vec3<T>{}, Vec3<T>{}};
    return sphere_ray(Vec3<T>(leaf.first), ray.origin, ray.direction);
}

template <class T>
inline Span<T> leaf_span(const Geometry& geometry, const Leaf& leaf, const Ray<T>& ray) {
    if (leaf.kind == LeafKind::polygon) {
        const PolygonPlane& plane = geometry.polygons[leaf.polygon];
        return polygon_span(plane, geometry.polygon_vertices(plane), ray);
    }
    const LocalRay<T> local = leaf_ray(geometry, leaf, ray);
    if (leaf.frame >= 0) return framed_span(leaf, geometry.frames[std::size_t(leaf.frame)], local);
    if (leaf.kind == LeafKind::sphere) return sphere_span(local, T(leaf.radius()));
    return box_span(local, Vec3<T>(leaf.first), Vec3<T>(leaf.second));
}

// What a search for the first crossing ahead needs of it.
template <class T>
inline Span<T> leaf_span_ahead(const Geometry& geometry, const Leaf& leaf, const Ray<T>& ray) {
    if (leaf.kind == LeafKind::sphere && leaf.frame < 0)
        return sphere_span_ahead(sphere_ray(Vec3<T>(leaf.first), ray.origin, ray.direction), T(leaf.radius()));
    return leaf_span(geometry, leaf, ray);
}

// Where a ray that is inside a solid leaf leaves it, whatever its rounded origin says.
template <class T>
[[gnu::noinline]] Exit<T> leaf_exit(const Geometry& geometry, const Leaf& leaf, const Ray<T>& ray) {
    const LocalRay<T> local = leaf_ray(geometry, leaf, ray);
    if (leaf.frame < 0) {
        if (leaf.kind == LeafKind::sphere) return sphere_exit(local, T(leaf.radius()));
        return exit_of(box_span(local, Vec3<T>(leaf.first), Vec3<T>(leaf.second)));
    }
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    const T radius = T(frame.radius);
    if constexpr (std::is_same_v<Mask<T>, bool>)  // (quadrics are asked ray by ray)
        if (leaf.kind == LeafKind::quadric) return quadric_exit(geometry.quadrics[leaf.polygon], local);
    switch (leaf.kind) {
        case LeafKind::sphere:
            return sphere_exit(local, radius);
        case LeafKind::cylinder:
            return cylinder_exit(local, radius);
        case LeafKind::cone:
            return cone_exit(local, radius, T(frame.slope));
        default:
            return exit_of(box_span(local, {-radius, -radius, -radius}, {radius, radius, radius}));
    }
}

// What a line has inside of a quadric, which need not be convex.
template <class T>
inline Spans<T> quadric_leaf_spans(const Geometry& geometry, const Leaf& leaf, const Ray<T>& ray) {
    return quadric_spans(geometry.quadrics[leaf.polygon], leaf_ray(geometry, leaf, ray));
}

// A cheap filter in T before the deciding type is asked: no only if the ray *certainly* does not meet the leaf's
// quadric (derivation D2). Flat faces have none: their own box is filter enough.
template <class T>
inline Mask<T> may_cross(const Geometry& geometry, const Leaf& leaf, const Ray<T>& ray) {
    if (leaf.kind == LeafKind::quadric)
        return !quadric_missed(geometry.quadrics[leaf.polygon], leaf_ray(geometry, leaf, ray));
    if (leaf.kind != LeafKind::sphere && leaf.kind != LeafKind::cylinder && leaf.kind != LeafKind::cone) return true;
    const LocalRay<T> local = leaf_ray(geometry, leaf, ray);
    const T radius = leaf.frame >= 0 ? T(geometry.frames[std::size_t(leaf.frame)].radius) : T(leaf.radius());
    if (leaf.kind == LeafKind::sphere) return !certainly_missed(sphere_quadratic(local, radius));
    if (leaf.kind == LeafKind::cylinder) return !certainly_missed(cylinder_quadratic(local, radius));
    const Quadratic<T> q = cone_quadratic(local, radius, T(geometry.frames[std::size_t(leaf.frame)].slope));
    return !(q.discriminant.value < -q.discriminant.band);
}

template <class T>
inline Surface<T> framed_surface(const Leaf& leaf, const Frame& frame, int face, const LocalPoint<T>& p,
                                 const Vec3<T>& d) {
    const T radius = T(frame.radius);
    switch (leaf.kind) {
        case LeafKind::sphere:
            return sphere_surface(p.y, d, radius, p.error);
        case LeafKind::box:
            return box_surface(p.y, face, {-radius, -radius, -radius}, {radius, radius, radius}, p.error);
        case LeafKind::cylinder:
            return cylinder_surface(p.y, d, face, radius, p.error);
        case LeafKind::cone:
            return cone_surface(p.y, d, face, radius, T(frame.slope), p.error);
        default:
            return disk_surface(p.y, p.error);
    }
}

// The plane of a mesh's face: F(y) = n . (y - a), with n = (b - a) x (c - a).
template <class T>
inline Surface<T> face_surface(const Corners<T>& corners, const Vec3<T>& y, const Vec3<T>& error) {
    const Vec3<T> ab = corners.b - corners.a, ac = corners.c - corners.a, r = y - corners.a;
    const Vec3<T> normal = cross(ab, ac), p = absolute(ab), q = absolute(ac);
    const Vec3<T> size{p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x};  // of n's products
    const T band = gamma<T>(10) * dot(size, absolute(r)) + dot(absolute(normal), error);
    return {{dot(normal, r), band}, normal, T(0)};
}

template <class T>
inline Surface<T> mesh_surface(const Geometry& geometry, const Leaf& leaf, int face, const Vec3<T>& p) {
    const Corners<T> corners = geometry.meshes[leaf.polygon].data->template corners<T>(face);
    if (leaf.frame < 0) return face_surface(corners, p, {});
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    const LocalPoint<T> local = to_local(frame, p);
    Surface<T> surface = face_surface(corners, local.y, local.error);
    surface.gradient = transpose_times(frame_linear<T>(frame), surface.gradient);
    return surface;
}

// The surface function of a face at a world point; its gradient comes back in world coordinates.
template <class T>
inline Surface<T> leaf_surface(const Geometry& geometry, const Leaf& leaf, int face, const Vec3<T>& p,
                               const Vec3<T>& direction) {
    if (leaf.kind == LeafKind::polygon) {
        const PolygonPlane& plane = geometry.polygons[leaf.polygon];
        return polygon_surface(plane, Vec3<T>(geometry.vertices[plane.first_vertex]), p);
    }
    if (leaf.kind == LeafKind::mesh) return mesh_surface(geometry, leaf, face, p);
    if (leaf.frame >= 0) {
        const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
        const Mat3<T>& linear = frame_linear<T>(frame);
        const LocalPoint<T> local = to_local(frame, p);
        const Vec3<T> d = linear * direction;
        Surface<T> surface = leaf.kind == LeafKind::quadric
                                 ? quadric_surface(geometry.quadrics[leaf.polygon], local.y, d, face, local.error)
                                 : framed_surface(leaf, frame, face, local, d);
        surface.gradient = transpose_times(linear, surface.gradient);
        return surface;
    }
    if (leaf.kind == LeafKind::sphere) {
        const LocalPoint<T> local = to_sphere(leaf, p);
        return sphere_surface(local.y, direction, T(leaf.radius()), local.error);
    }
    return box_surface(p, face, Vec3<T>(leaf.first), Vec3<T>(leaf.second), Vec3<T>{});
}

// The second-order coefficient of a face's form along a direction, alone.
template <class T>
inline T leaf_curvature(const Geometry& geometry, const Leaf& leaf, int face, const Vec3<T>& p,
                        const Vec3<T>& direction) {
    if (leaf.kind == LeafKind::sphere && leaf.frame < 0) return dot(direction, direction);
    if (leaf.kind == LeafKind::polygon || leaf.kind == LeafKind::box || leaf.kind == LeafKind::disk) return T(0);
    return leaf_surface(geometry, leaf, face, p, direction).curvature;
}

template <class T>
inline UV<T> framed_uv(const Leaf& leaf, const Frame& frame, int face, const Vec3<T>& y) {
    const T radius = T(frame.radius);
    switch (leaf.kind) {
        case LeafKind::sphere:
            return sphere_uv(y, radius);
        case LeafKind::box:
            return box_uv(y, face, {-radius, -radius, -radius}, {radius, radius, radius});
        case LeafKind::cylinder:
            return cylinder_uv(y, face, radius);
        case LeafKind::cone:
            return cone_uv(y, face, radius, T(frame.top_radius));
        default:
            return disk_uv(y.x, y.y, radius);
    }
}

template <class T>
inline UV<T> leaf_uv(const Geometry& geometry, const Leaf& leaf, int face, const Vec3<T>& p) {
    if (leaf.kind == LeafKind::polygon) {
        const PolygonPlane& plane = geometry.polygons[leaf.polygon];
        return polygon_uv(plane, Vec3<T>(geometry.vertices[plane.first_vertex]), p);
    }
    if (leaf.frame >= 0) {
        const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
        const Vec3<T> y = to_local(frame, p).y;
        if (leaf.kind == LeafKind::quadric) return quadric_uv(geometry.quadrics[leaf.polygon], y, face);
        return framed_uv(leaf, frame, face, y);
    }
    if (leaf.kind == LeafKind::sphere) return sphere_uv(to_sphere(leaf, p).y, T(leaf.radius()));
    return box_uv(p, face, Vec3<T>(leaf.first), Vec3<T>(leaf.second));
}

}  // namespace raybound
