// Hit points and their errors by the closed forms of seeds/000, 3.9.4, to measure ours beside: nothing here draws.
//
// In the shape's own coordinates, where all is computed in T: a sphere's point is scaled onto it, gamma_5 of each
// coordinate (eq. 3.13); a cylinder's, across its axis, gamma_3; a disk's, and a cap's, is put on its plane, 0; a
// triangle's is interpolated by its barycentric coordinates, gamma_7 sum |b v| (eq. 3.14). Then the point is mapped to
// the world by eq. 3.16. Two things are better than there: t is the deciding type's, rounded once, and the sums of
// eq. 3.16 are rounded up. One is as there: matrices are taken to be exact in T.
#pragma once

#include <optional>

#include "raybound/geometry/transform_error.h"
#include "raybound/shapes/intersect.h"
#include "raybound/shapes/leaf.h"
#include "raybound/shapes/mesh_hit.h"

namespace raybound {

template <class T>
inline WithError<T> sphere_closed_form(const Vec3<T>& y, T radius) {
    const Vec3<T> p = y * (radius / length(y));
    return {p, absolute(p) * gamma<T>(5)};
}

template <class T>
inline WithError<T> cylinder_closed_form(const Vec3<T>& y, T radius) {
    const Vec3<T> across = flat(y) * (radius / length(flat(y)));
    return {{across.x, across.y, y.z}, absolute(across) * gamma<T>(3)};
}

template <class T>
inline WithError<T> plane_closed_form(const Vec3<T>& y, T height) {
    return {{y.x, y.y, height}, {}};
}

// With edge functions that are rounded once, where the seeds' are computed in T: their error moves the point within
// the plane only.
template <class T>
inline WithError<T> triangle_closed_form(const Corners<T>& v, const Piercing& edges) {
    const T a(edges.a), b(edges.b), c(edges.c), inverse = T(1) / (a + b + c);
    const auto mixed = [&](const Corners<T>& p) { return (p.a * a + p.b * b + p.c * c) * inverse; };
    const Corners<T> sizes{absolute(v.a), absolute(v.b), absolute(v.c)};
    return {mixed(v), mixed(sizes) * gamma<T>(7)};  // edge functions and their sum have one sign
}

// From a leaf's own coordinates to the world.
inline Affine placement_of(const Geometry& geometry, const Leaf& leaf) {
    if (leaf.kind == LeafKind::mesh) return geometry.meshes[leaf.polygon].placement;
    if (leaf.frame < 0) return {{}, leaf.first};
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    return {inverse(frame.linear_wide), frame.center_wide};
}

template <class T>
inline WithError<T> face_closed_form(const Geometry& geometry, const Leaf& leaf, std::int32_t face,
                                     const WideRay<T>& ray) {
    const MeshData& mesh = *geometry.meshes[leaf.polygon].data;
    const PermutedLine line = mesh_line(geometry, leaf, ray.wide);
    return triangle_closed_form(mesh.corners<T>(face), pierce_face(mesh.corners<double>(face), line));
}

template <class T>
inline std::optional<WithError<T>> own_closed_form(const Geometry& geometry, const Leaf& leaf,
                                                   const Crossing<Wide<T>>& crossing, const WideRay<T>& ray) {
    if (leaf.kind == LeafKind::mesh) return face_closed_form(geometry, leaf, crossing.face, ray);
    const bool round = leaf.kind == LeafKind::sphere || leaf.kind == LeafKind::cylinder;
    if (!round && leaf.kind != LeafKind::disk) return std::nullopt;
    const LocalRay<T> own = leaf_ray(geometry, leaf, ray.narrow);
    const Vec3<T> y = own.origin + own.direction * T(crossing.t);
    const T radius(leaf.frame < 0 ? leaf.radius() : double(geometry.frames[std::size_t(leaf.frame)].radius));
    if (leaf.kind == LeafKind::sphere) return sphere_closed_form(y, radius);
    if (leaf.kind == LeafKind::cylinder && crossing.face == 0) return cylinder_closed_form(y, radius);
    return plane_closed_form(y, crossing.face == 2 ? radius : T(0));
}

// The point of a crossing in the world; nothing for shapes without a closed form.
template <class T>
inline std::optional<WithError<T>> closed_form(const Geometry& geometry, const Crossing<Wide<T>>& crossing,
                                               const WideRay<T>& ray) {
    const Leaf& leaf = geometry.leaves[crossing.leaf];
    const std::optional<WithError<T>> own = own_closed_form(geometry, leaf, crossing, ray);
    if (!own) return own;
    const Affine place = placement_of(geometry, leaf);
    return transformed(Mat3<T>(place.linear), Vec3<T>(place.offset), *own);
}

}  // namespace raybound
