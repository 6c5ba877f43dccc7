// Hit points: a crossing moved onto the surface, its normal, and bounds of their errors (derivation D3).
#pragma once

#include "raybound/shapes/boundary.h"
#include "raybound/shapes/intersect.h"

namespace raybound {

// From any point: the surface is no farther than a known point of the solid and the solid's size; near the apex of a
// cone, where the gradient vanishes, no farther than the apex.
template <class W>
W distance_anywhere(const Geometry& geometry, const Leaf& leaf, int face, const Vec3<W>& p) {
    if (leaf.frame < 0) return norm1(p - Vec3<W>(leaf.first)) + W(leaf.radius());
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    const LocalPoint<W> local = to_local(frame, p);
    const W radius(frame.radius), reach = W(2) * W(frame.inverse_norm);  // the norm is of components: sqrt(3) at most
    const W far = norm1(local.y) + norm1(local.error) + W(4) * radius + W(frame.top_radius);
    if (leaf.kind != LeafKind::cone || face != 0) return reach * far;
    const Vec3<W> apex{W(0), W(0), radius / W(frame.slope)};
    return reach * minimum(norm1(local.y - apex) + norm1(local.error), far);
}

// A bound of the second-order coefficient of a face's form along any unit vector of the world: quick to tell.
template <class W>
W largest_curvature(const Geometry& geometry, const Leaf& leaf, int face) {
    if (leaf.kind == LeafKind::sphere && leaf.frame < 0) return W(1) + W(0x1p-20);
    if (is_flat_face(leaf, face)) return W(0);
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    const Vec3<W> rows(frame.row_norm);
    const W stretch = dot(rows, rows) * (W(1) + W(0x1p-20));
    if (leaf.kind == LeafKind::quadric) return stretch * W(geometry.quadrics[leaf.polygon].norm);
    return leaf.kind == LeafKind::cone ? stretch * maximum(W(1), square(W(frame.slope))) : stretch;
}

// What |F| can be at a polished point (derivation D3). Four bands: the error of F there, that of F at the origin
// spawned from it, and as much again, so that the kernel is sure of its side.
template <class W>
inline W largest_residual(const Banded<W>& form, const W& margin) {
    return abs(form.value) + W(4) * form.band * margin;
}

// |F| / |grad F| bounds the distance to the surface where F along the normal is as good as linear from here to there.
template <class W>
inline Mask<W> is_flat(const W& residual, const W& curvature, const W& squared_gradient) {
    return residual * curvature <= W(0x1p-11) * squared_gradient;
}
template <class W>
inline W linear_distance(const W& residual, const W& squared_gradient) {
    return residual / sqrt(squared_gradient) * (W(1) + W(0x1p-10));
}

// How far a polished point can be from the surface (derivation D3).
template <class W>
W surface_distance(const Geometry& geometry, const Leaf& leaf, int face, const Vec3<W>& p, const Surface<W>& surface,
                   const Vec3<W>& normal) {
    const W squared = dot(surface.gradient, surface.gradient);
    const bool quadric = leaf.kind == LeafKind::quadric && face == 0;
    const W residual = largest_residual(surface.form, quadric ? quadric_margin<W> : W(1));
    const bool linear = is_flat(residual, largest_curvature<W>(geometry, leaf, face), squared) ||
                        is_flat(residual, abs(leaf_curvature(geometry, leaf, face, p, normal)), squared);
    const W distance = linear ? linear_distance(residual, squared) : distance_anywhere(geometry, leaf, face, p);
    if (!quadric) return distance;
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    const Quadric& form = geometry.quadrics[leaf.polygon];
    const W anyhow = quadric_distance(form, to_local(frame, p).y, surface.form, residual);
    return minimum(distance, W(2) * W(frame.inverse_norm) * anyhow);
}

// A point of the wide type on a face, and what is known there.
template <class W>
struct Polished {
    Vec3<W> point;
    Surface<W> surface;
};

// Newton steps along the gradient, p - F grad F / |grad F|^2, until F is within its band: none where the root is good,
// one or two where the origin is far away. A point where the gradient vanishes stays.
template <class W>
[[gnu::always_inline]] inline Polished<W> polish(const Geometry& geometry, const Leaf& leaf, int face, Vec3<W> p,
                                                 const Vec3<W>& direction) {
    Surface<W> surface = leaf_surface(geometry, leaf, face, p, direction);
    for (int step = 0; step < 8; ++step) {
        const Mask<W> off = abs(surface.form.value) > W(2) * surface.form.band;
        if (none(off)) break;
        const Vec3<W> moved = p - surface.gradient * (surface.form.value / dot(surface.gradient, surface.gradient));
        const Mask<W> finite = is_finite(moved);
        if (none(finite)) break;
        p = select(off & finite, moved, p);
        surface = leaf_surface(geometry, leaf, face, p, direction);
    }
    return {p, surface};
}

// (Its square may be out of range.)
template <class W>
inline Vec3<W> unit_gradient(const Vec3<W>& gradient, const W& largest_part) {
    return normalize(gradient * (W(1) / largest_part));
}

// Where the gradient vanishes, the axis at the apex of a cone; elsewhere (a point that fell on the centre of a sphere
// far below its own rounding) toward the viewer.
template <class W>
Vec3<W> unit_normal(const Geometry& geometry, const Leaf& leaf, const Surface<W>& surface, const Vec3<W>& direction) {
    if (leaf.kind == LeafKind::box && leaf.frame < 0) return surface.gradient;  // an axis
    const W largest_part = max_component(absolute(surface.gradient));
    if (largest_part > W(0)) return unit_gradient(surface.gradient, largest_part);
    if (leaf.kind != LeafKind::cone) return normalize(-direction);
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    return normalize(frame_linear<W>(frame).row[2] * W(frame.slope < 0 ? -1 : 1));
}

template <class T>
inline T round_up(const Wide<T>& x) {
    return minimum(next_float_up(T(x)), T(std::numeric_limits<Scalar<T>>::max()));
}
template <class T>
inline Vec3<T> round_up(const Vec3<Wide<T>>& v) {
    return {round_up<T>(v.x), round_up<T>(v.y), round_up<T>(v.z)};
}

// A crossing of a leaf's face, or several of the same.
template <class T>
struct FaceHit {
    const Leaf& leaf;
    int face;
    Wide<T> t;
    Mask<Wide<T>> entering;
};

template <class T>
inline T crossing_error(const Geometry& geometry, const FaceHit<T>& hit, const Ray<Wide<T>>& ray,
                        const Surface<Wide<T>>& surface, const Vec3<Wide<T>>& normal) {
    using W = Wide<T>;
    const W off_surface =
        root_error(W(hit.leaf.surface_error), dot(normal, ray.direction), surface.curvature / length(surface.gradient));
    return round_up<T>(abs(W(T(hit.t)) - hit.t) + off_surface +
                       boundary_error(geometry, hit.leaf, hit.face, hit.t, ray));
}

// What is known in the wide type, rounded once: `distance` is how far the polished point may be from the leaf's
// surface.
template <class T>
inline SurfacePoint<T> rounded_point(const Geometry& geometry, const FaceHit<T>& crossing, const Ray<Wide<T>>& ray,
                                     const Polished<Wide<T>>& polished, const Vec3<Wide<T>>& normal,
                                     const Wide<T>& distance, Wanted wanted) {
    using W = Wide<T>;
    const Leaf& leaf = crossing.leaf;
    SurfacePoint<T> hit;
    hit.t = T(crossing.t);
    hit.t_error = wanted.t_error ? crossing_error(geometry, crossing, ray, polished.surface, normal) : T(0);
    hit.point = Vec3<T>(polished.point);
    const Vec3<W> rounding = absolute(Vec3<W>(hit.point) - polished.point);
    hit.point_error = round_up<T>(absolute(normal) * (distance + W(leaf.surface_error)) + rounding);
    hit.normal = hit.shading = Vec3<T>(leaf.is_complement ? -normal : normal);
    hit.entering = Mask<T>(is_sheet(leaf) ? !(dot(ray.direction, normal) > W(0)) : crossing.entering);
    if (wanted.uv) hit.uv = leaf_uv(geometry, leaf, crossing.face, hit.point);
    return hit;
}

}  // namespace raybound
