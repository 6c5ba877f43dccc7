#include "raybound/shapes/intersect.h"

#include <algorithm>

#include "raybound/shapes/csg.h"

namespace raybound {

namespace {

template <class T>
Crossing<T> nothing() {
    return {infinity<T>, 0, 0, 0, Mask<T>(false)};
}

template <class T>
struct Answer {
    Crossing<T> crossing;
    Mask<T> unsure;
};

template <class T>
Answer<T> ask_leaf(const Geometry& geometry, std::uint32_t index, const Ray<T>& ray) {
    const Span<T> span = leaf_span(geometry, geometry.leaves[index], ray);
    const T t = select(span.in_ahead, span.t_in, span.t_out);
    const int face = select(span.in_ahead, span.face_in, span.face_out);
    return {{t, index, face, 0, Mask<T>(span.hit & (span.in_ahead | span.out_ahead))}, span.unsure};
}

template <class T>
Answer<T> ask_csg(const Geometry& geometry, std::uint32_t root, const Ray<T>& ray) {
    CsgEvaluation<T> evaluation(geometry, ray);
    evaluation.evaluate(root);
    for (const Interval<T>& interval : evaluation.intervals())
        for (const Boundary<T>* boundary : {&interval.in, &interval.out})
            if (boundary->ahead) {
                const CsgNode& node = geometry.csg_nodes[boundary->node];
                return {{boundary->t, node.first, boundary->face, node.face_offset, true}, evaluation.unsure()};
            }
    return {nothing<T>(), evaluation.unsure()};
}

template <class T>
Answer<T> ask(const Geometry& geometry, const Primitive& primitive, const Ray<T>& ray) {
    return primitive.is_csg ? ask_csg(geometry, primitive.root, ray) : ask_leaf(geometry, primitive.root, ray);
}

// The crossing of a face nearest to t, in the wide type: Newton steps along the ray, halting where the slope dies. A
// float root is good to 2^-20 or so, so that two steps reach the wide type's own accuracy; a plane needs one.
template <class W>
W refine_along(const Geometry& geometry, const Leaf& leaf, int face, W t, const Ray<W>& ray) {
    for (int step = 0; step < 2; ++step) {
        const Surface<W> surface = leaf_surface(geometry, leaf, face, ray.origin + ray.direction * t, ray.direction);
        const W move = -(surface.form.value / dot(surface.gradient, ray.direction));
        const Mask<W> flat = surface.curvature == W(0);
        const W nearest = sqrt(abs(surface.form.value) / abs(surface.curvature));  // a root is at most this far away
        t = select(abs(move) <= select(flat, infinity<W>, W(2) * nearest), t + move, t);
        if (!any(!flat)) break;
    }
    return t;
}

// One Newton step along the gradient: what puts a point near a curved surface on it. Its error is of second order,
// far below the rounding to T that follows.
template <class W>
Vec3<W> polish(const Geometry& geometry, const Leaf& leaf, int face, const Vec3<W>& p, const Vec3<W>& direction) {
    const Surface<W> surface = leaf_surface(geometry, leaf, face, p, direction);
    const W squared = dot(surface.gradient, surface.gradient);
    const W step = surface.form.value / squared;
    const Vec3<W> moved = p - surface.gradient * step;
    return select(Mask<W>(is_finite(moved)), moved, p);
}

// A cone's apex is a point of its side: near it, where the gradient vanishes, the distance to it bounds the error.
template <class W>
W distance_to_apex(const Frame& frame, const Vec3<W>& p) {
    const LocalPoint<W> local = to_local(frame, p);
    const Vec3<W> apex{W(0), W(0), W(frame.radius) / W(frame.slope)};
    return W(frame.inverse_norm) * (length(local.y - apex) + W(3) * local.error) * (W(1) + gamma<W>(8));
}

// How far a polished point can be from the surface along its gradient (derivation D3). Four bands: the error of F
// there, that of F at the origin spawned from it, and as much again, so that the kernel is sure of its side.
template <class W>
W surface_distance(const Geometry& geometry, const Leaf& leaf, int face, const Surface<W>& surface, const Vec3<W>& p) {
    const W residual = abs(surface.form.value) + W(4) * surface.form.band;
    W distance = residual / length(surface.gradient) * (W(1) + W(0x1p-10));
    if (leaf.kind == LeafKind::cone && face == 0) {
        const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
        if (frame.slope != 0) distance = minimum(distance_to_apex(frame, p), distance);
    }
    return distance + W(leaf.surface_error);
}

// Only a cone's apex has no gradient: there the normal is its axis.
template <class W>
Vec3<W> unit_normal(const Leaf& leaf, const Geometry& geometry, const Surface<W>& surface) {
    if (dot(surface.gradient, surface.gradient) > W(0) || leaf.frame < 0) return normalize(surface.gradient);
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    return normalize(frame_linear<W>(frame).row[2] * W(frame.slope < 0 ? -1 : 1));
}

template <std::floating_point T>
T round_up(Wide<T> x) {
    return next_float_up(T(x));
}

}  // namespace

template <class T>
Crossing<T> first_crossing(const Geometry& geometry, const Primitive& primitive, const Ray<T>& ray) {
    const Answer<T> answer = ask(geometry, primitive, ray);
    if (none(answer.unsure)) return answer.crossing;
    const Crossing<Wide<T>> wide = ask(geometry, primitive, widen(ray)).crossing;
    return {T(wide.t), wide.leaf, wide.face, wide.face_offset, wide.hit};
}

template <class T>
Mask<T> blocks(const Geometry& geometry, const Primitive& primitive, const Ray<T>& ray) {
    using W = Wide<T>;
    const Answer<T> answer = ask(geometry, primitive, ray);
    // Rays that end at infinity need no second look: whether the crossing is ahead is certain.
    if (none(answer.unsure) && !ray.has_target) return answer.crossing.hit;
    const T beyond = ray.t_max * T(1 + 0x1p-10);  // candidates: the wide type decides
    if (none(answer.unsure) && none(answer.crossing.hit & (answer.crossing.t <= beyond))) return Mask<T>(false);
    const Ray<W> exact = widen(ray);
    const Crossing<W> wide = ask(geometry, primitive, exact).crossing;
    if (none(wide.hit)) return Mask<T>(false);
    if (!ray.has_target) return Mask<T>(true);
    const W error = boundary_error(geometry, geometry.leaves[wide.leaf], wide.face, wide.t, exact);
    return wide.t + error < exact.t_max * (W(1) - gamma<W>(8));
}

template <class T>
SurfacePoint<T> surface_point(const Geometry& geometry, const Crossing<T>& crossing, const Ray<T>& ray) {
    using W = Wide<T>;
    const Leaf& leaf = geometry.leaves[crossing.leaf];
    const Ray<W> wide = widen(ray);
    const W t = refine_along(geometry, leaf, crossing.face, W(crossing.t), wide);
    const Vec3<W> exact = polish(geometry, leaf, crossing.face, wide.origin + wide.direction * t, wide.direction);

    SurfacePoint<T> hit;
    hit.t = T(t);
    hit.t_error = round_up<T>(abs(W(hit.t) - t) + boundary_error(geometry, leaf, crossing.face, t, wide));
    hit.point = Vec3<T>(exact);
    const Surface<W> surface = leaf_surface(geometry, leaf, crossing.face, exact, wide.direction);
    const Vec3<W> normal = unit_normal(leaf, geometry, surface);
    const W distance = surface_distance(geometry, leaf, crossing.face, surface, exact);
    const Vec3<W> rounding = absolute(Vec3<W>(hit.point) - exact);
    for (int i = 0; i < 3; ++i) hit.point_error[i] = round_up<T>(distance * abs(normal[i]) + rounding[i]);
    hit.normal = Vec3<T>(normal);
    hit.uv = leaf_uv(geometry, leaf, crossing.face, hit.point);
    return hit;
}

// The number types that the geometry of rays is certified for today.
template Crossing<float> first_crossing(const Geometry&, const Primitive&, const Ray<float>&);
template Crossing<double> first_crossing(const Geometry&, const Primitive&, const Ray<double>&);
template bool blocks(const Geometry&, const Primitive&, const Ray<float>&);
template bool blocks(const Geometry&, const Primitive&, const Ray<double>&);
template SurfacePoint<float> surface_point(const Geometry&, const Crossing<float>&, const Ray<float>&);
template SurfacePoint<double> surface_point(const Geometry&, const Crossing<double>&, const Ray<double>&);

}  // namespace raybound
