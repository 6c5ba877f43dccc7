// The convex polygon, in world coordinates. One face; the normal sees the vertices counter-clockwise.
#pragma once

#include <span>
#include <vector>

#include "raybound/shapes/disk.h"
#include "raybound/shapes/shear.h"

namespace raybound {

// The plane is F(x) = orientation * ((x_k - v_k) + m_i (x_i - v_i) + m_j (x_j - v_j)), k the dominant axis of the
// normal and |m| <= 1, with v the first vertex: no unit normal to round, and every point can be put on it exactly.
struct PolygonPlane {
    std::uint32_t first_vertex = 0, vertex_count = 0;
    int axis = 2;
    double slope_i = 0, slope_j = 0;
    float orientation = 1;
    Vec3f u_axis, v_axis;  // (u,v) = offset + axis . (p - v)
    float u_offset = 0, v_offset = 0;
};

// The normal of a closed polygon, twice its area long, on the side that sees the vertices counter-clockwise (Newell's
// sums, in double).
template <class T>
inline Vec3d newell_normal(const std::vector<Vec3<T>>& vertices) {
    const Vec3d first(vertices[0]);
    Vec3d sum;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        sum = sum + cross(Vec3d(vertices[i]) - first, Vec3d(vertices[(i + 1) % vertices.size()]) - first);
    return sum;
}

template <class T>
inline Banded<T> plane_form(const PolygonPlane& plane, const Vec3<T>& v, const Vec3<T>& p) {
    const int k = plane.axis, i = (k + 1) % 3, j = (k + 2) % 3;
    const T height = p[k] - v[k], along_i = T(plane.slope_i) * (p[i] - v[i]),
            along_j = T(plane.slope_j) * (p[j] - v[j]);
    return {T(plane.orientation) * (height + along_i + along_j),
            gamma<T>(5) * (abs(height) + abs(along_i) + abs(along_j))};
}

template <class T>
inline Vec3<T> plane_gradient(const PolygonPlane& plane) {
    Vec3<T> gradient;
    gradient[plane.axis] = T(plane.orientation);
    gradient[(plane.axis + 1) % 3] = T(plane.orientation) * T(plane.slope_i);
    gradient[(plane.axis + 2) % 3] = T(plane.orientation) * T(plane.slope_j);
    return gradient;
}

// How a line passes a polygon, seen from either side: through it (a line through an edge or a vertex does: a side of
// zero counts for both), and between which t its vertices are.
template <class T>
struct Passing {
    Mask<T> pierces;
    T nearest, farthest;
};

// The lanes of a pack may have different largest components of their directions.
template <class T>
using LineShear = Shear<T, std::conditional_t<std::is_same_v<T, Scalar<T>>, AxisOrder<T>, LaneOrder<T>>>;

template <class T>
inline Passing<T> line_passing(std::span<const Vec3d> vertices, const Vec3<T>& origin, const Vec3<T>& direction) {
    const LineShear<T> shear(direction);
    const auto seen = [&](const Vec3d& vertex) { return shear.permuted(Vec3<T>(vertex) - origin); };
    const Vec3<T> last = seen(vertices.back());
    T ax = shear.x(last), ay = shear.y(last), low = infinity<T>, high = -infinity<T>;
    Mask<T> left(true), right(true);
    for (const Vec3d& vertex : vertices) {
        const Vec3<T> b = seen(vertex);
        const T bx = shear.x(b), by = shear.y(b);
        const T side = edge_side(ax, ay, bx, by);
        left = left & (side >= T(0));
        right = right & (side <= T(0));
        if (none(left | right)) return {Mask<T>(false), low, high};
        low = minimum(low, b.z);
        high = maximum(high, b.z);
        ax = bx;
        ay = by;
    }
    const T one_end = low / shear.dz, other_end = high / shear.dz;  // rounding is monotone: those of all vertices' t
    return {Mask<T>(left | right), minimum(one_end, other_end), maximum(one_end, other_end)};
}

// Where a line is all but parallel to the plane, t is between those of the vertices still: what filters rely on that
// look at the vertices alone (derivation D8).
template <class T>
inline Span<T> polygon_span(const PolygonPlane& plane, std::span<const Vec3d> vertices, const Ray<T>& ray) {
    const Banded<T> height = plane_form(plane, Vec3<T>(vertices[0]), ray.origin);
    const Vec3<T> gradient = plane_gradient<T>(plane);
    const T steepness = dot(absolute(gradient), absolute(ray.direction));
    const Banded<T> climb{dot(gradient, ray.direction), gamma<T>(4) * steepness};
    Span<T> span = sheet_span(height, climb, Mask<T>(true));
    const Mask<T> needed = span.hit & span.in_ahead;
    if (none(needed)) return span;
    const Passing<T> passing = line_passing(vertices, ray.origin, ray.direction);
    span.t_in = span.t_out = minimum(maximum(span.t_in, passing.nearest), passing.farthest);
    span.hit = needed & passing.pierces & (span.t_in > T(0));
    return span;
}

template <class T>
inline Surface<T> polygon_surface(const PolygonPlane& plane, const Vec3<T>& first, const Vec3<T>& p) {
    return {plane_form(plane, first, p), plane_gradient<T>(plane), T(0)};
}

// u along the first edge, v across it in the plane, both from 0 to 1 over the polygon's extent.
template <class T>
inline UV<T> polygon_uv(const PolygonPlane& plane, const Vec3<T>& first, const Vec3<T>& p) {
    const Vec3<T> r = p - first;
    return {unit_clamp(dot(Vec3<T>(plane.u_axis), r) + T(plane.u_offset)),
            unit_clamp(dot(Vec3<T>(plane.v_axis), r) + T(plane.v_offset))};
}

}  // namespace raybound
