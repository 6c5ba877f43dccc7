#include "raybound/shapes/intersect.h"

#include "raybound/shapes/csg.h"
#include "raybound/shapes/hit_point.h"
#include "raybound/shapes/mesh_hit.h"

#ifdef RAYBOUND_COUNTED  // by intersect_counted.cpp
#define RAYBOUND_OBSERVER Counted
#else
#define RAYBOUND_OBSERVER Unseen
#endif

namespace raybound {

namespace {

// The first boundary ahead of a quadric's one or two parts.
template <class W>
Crossing<W> cross_quadric(const Geometry& geometry, std::uint32_t index, const Ray<W>& ray) {
    const Spans<W> spans = quadric_leaf_spans(geometry, geometry.leaves[index], ray);
    for (int i = 0; i < spans.count; ++i) {
        const Span<W>& span = spans.part[i];
        if (span.in_ahead) return {span.t_in, index, span.face_in, 0, true, true};
        if (span.out_ahead) return {span.t_out, index, span.face_out, 0, true, false};
    }
    return {infinity<W>, 0, 0, 0, Mask<W>(false), Mask<W>(false)};
}

template <class W>
Crossing<W> cross_leaf(const Geometry& geometry, std::uint32_t index, const Ray<W>& ray) {
    if (geometry.leaves[index].kind == LeafKind::quadric) return cross_quadric(geometry, index, ray);
    const Span<W> span = leaf_span_ahead(geometry, geometry.leaves[index], ray);
    const FirstAhead<W> first = first_ahead(span);
    return {first.t, index, first.face, 0, first.hit, first.entering};
}

template <class W>
Crossing<W> cross_csg(const Geometry& geometry, std::uint32_t root, const Ray<W>& ray) {
    CsgEvaluation<W> evaluation(geometry, ray);
    evaluation.evaluate(root);
    bool entering = false;
    if (const Boundary<W>* first = evaluation.first_ahead(entering)) {
        const CsgNode& node = geometry.csg_nodes[std::size_t(first->node)];
        return {first->t, node.first, first->face, node.face_offset, true, entering};
    }
    return {infinity<W>, 0, 0, 0, Mask<W>(false), Mask<W>(false)};
}

}  // namespace

template <class T, class Observer>
Crossing<Wide<T>> first_crossing(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray,
                                 const Asking<T>& asking, Observer observer) {
    if (primitive.is_csg) return cross_csg(geometry, primitive.root, ray.wide);
    if (geometry.leaves[primitive.root].kind == LeafKind::mesh)
        return cross_mesh<T>(geometry, primitive.root, ray.wide, asking.t_max, asking.brute_force, observer);
    if constexpr (!std::is_same_v<T, Wide<T>>)
        if (!asking.filtered && none(may_cross(geometry, geometry.leaves[primitive.root], ray.narrow)))
            return {infinity<Wide<T>>, 0, 0, 0, false, false};
    return cross_leaf(geometry, primitive.root, ray.wide);
}

template <class T>
Wide<T> certain_end(const WideRay<T>& ray) {
    return ray.wide.t_max * (Wide<T>(1) - gamma<Wide<T>>(8));
}

template <class T>
Mask<T> is_before_end(const Geometry& geometry, const Crossing<Wide<T>>& crossing, const WideRay<T>& ray) {
    if (none(crossing.hit) || !ray.wide.has_target) return crossing.hit;
    const Wide<T> end = certain_end(ray);
    if (!(crossing.t < end)) return Mask<T>(false);
    return crossing.t + boundary_error(geometry, geometry.leaves[crossing.leaf], crossing.face, crossing.t, ray.wide) <
           end;
}

template <class T, class Observer>
Mask<T> blocks(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray, const Asking<T>& asking,
               Blocking* how, Observer observer) {
    if (!primitive.is_csg && geometry.leaves[primitive.root].kind == LeafKind::mesh)
        return mesh_blocks<T>(geometry, primitive.root, ray.wide, certain_end(ray), asking.brute_force, how, observer);
    const Crossing<Wide<T>> crossing = first_crossing(geometry, primitive, ray, asking, observer);
    if (how) how->entering = crossing.entering;
    return is_before_end(geometry, crossing, ray);
}

// Eight bounds instead of one, so that a ray sent back through the surface certainly has it ahead (D3, D8); and 2^-20
// of everything, so that the float normal may stand for the true one.
template <class T>
SurfacePoint<T> mesh_surface_point(const Geometry& geometry, const Crossing<Wide<T>>& crossing, const Ray<Wide<T>>& ray,
                                   Wanted wanted) {
    using W = Wide<T>;
    const Leaf& leaf = geometry.leaves[crossing.leaf];
    const BarycentricHit at = barycentric_hit(geometry, leaf, crossing.face, ray, crossing.t);
    SurfacePoint<T> hit;
    hit.t = T(crossing.t);
    hit.point = Vec3<T>(at.point);
    for (int i = 0; i < 3; ++i) {
        const W rounding = abs(W(hit.point[i]) - at.point[i]);
        hit.point_error[i] = round_up<T>((W(8) * at.error[i] + rounding) * (W(1) + W(0x1p-20)));
    }
    hit.normal = Vec3<T>(at.normal);
    hit.shading = Vec3<T>(at.shading);
    if (wanted.uv) hit.uv = {T(at.uv.u), T(at.uv.v)};
    hit.entering = crossing.entering;
    if (!wanted.t_error) return hit;
    const Surface<W> surface = leaf_surface(geometry, leaf, crossing.face, at.point, ray.direction);
    hit.t_error =
        crossing_error<T>(geometry, {leaf, crossing.face, crossing.t, crossing.entering}, ray, surface, at.normal);
    return hit;
}

template <class T>
SurfacePoint<T> surface_point(const Geometry& geometry, const Crossing<Wide<T>>& crossing, const Ray<Wide<T>>& ray,
                              Wanted wanted) {
    using W = Wide<T>;
    const Leaf& leaf = geometry.leaves[crossing.leaf];
    if (leaf.kind == LeafKind::mesh) return mesh_surface_point<T>(geometry, crossing, ray, wanted);
    const Polished<W> polished =
        polish(geometry, leaf, crossing.face, ray.origin + ray.direction * crossing.t, ray.direction);
    const Vec3<W> normal = unit_normal(geometry, leaf, polished.surface, ray.direction);
    const W distance = surface_distance(geometry, leaf, crossing.face, polished.point, polished.surface, normal);
    const FaceHit<T> hit{leaf, crossing.face, crossing.t, crossing.entering};
    return rounded_point(geometry, hit, ray, polished, normal, distance, wanted);
}

template <class T>
PlainPoint<T> estimate_point(const Geometry& geometry, const Crossing<Wide<T>>& crossing, const Ray<T>& ray) {
    const Leaf& leaf = geometry.leaves[crossing.leaf];
    const Vec3<T> p = ray.origin + ray.direction * T(crossing.t);
    const Surface<T> surface = leaf_surface(geometry, leaf, crossing.face, p, ray.direction);
    const Vec3<T> normal = unit_normal(geometry, leaf, surface, ray.direction);
    return {p, leaf.is_complement ? -normal : normal};
}

// The number types that rays are traced with today. (float filters and shades, double decides.)
template Crossing<double> first_crossing(const Geometry&, const Primitive&, const WideRay<float>&, const Asking<float>&,
                                         RAYBOUND_OBSERVER);
template Crossing<double> first_crossing(const Geometry&, const Primitive&, const WideRay<double>&,
                                         const Asking<double>&, RAYBOUND_OBSERVER);
template bool blocks(const Geometry&, const Primitive&, const WideRay<float>&, const Asking<float>&, Blocking*,
                     RAYBOUND_OBSERVER);
template bool blocks(const Geometry&, const Primitive&, const WideRay<double>&, const Asking<double>&, Blocking*,
                     RAYBOUND_OBSERVER);
#ifndef RAYBOUND_COUNTED
template bool is_before_end(const Geometry&, const Crossing<double>&, const WideRay<float>&);
template bool is_before_end(const Geometry&, const Crossing<double>&, const WideRay<double>&);
template SurfacePoint<float> surface_point(const Geometry&, const Crossing<double>&, const Ray<double>&, Wanted);
template SurfacePoint<double> surface_point(const Geometry&, const Crossing<double>&, const Ray<double>&, Wanted);
template PlainPoint<float> estimate_point(const Geometry&, const Crossing<double>&, const Ray<float>&);
template PlainPoint<double> estimate_point(const Geometry&, const Crossing<double>&, const Ray<double>&);

bool coincide(const Geometry& geometry, const Crossing<double>& a, const Crossing<double>& b, const Ray<double>& ray) {
    const auto error = [&](const Crossing<double>& c) {
        const Leaf& leaf = geometry.leaves[c.leaf];
        const Surface<double> surface =
            leaf_surface(geometry, leaf, c.face, ray.origin + ray.direction * c.t, ray.direction);
        const Vec3d normal = unit_normal(geometry, leaf, surface, ray.direction);
        return crossing_error<double>(geometry, {leaf, c.face, c.t, c.entering}, ray, surface, normal);
    };
    return abs(a.t - b.t) <= error(a) + error(b);
}

bool is_left_for_good(const Geometry& geometry, const Primitive& primitive, bool outward) {
    if (primitive.is_csg) return false;
    const Leaf& leaf = geometry.leaves[primitive.root];
    return leaf.kind != LeafKind::mesh && leaf.kind != LeafKind::quadric && (outward || is_sheet(leaf));
}
#endif

}  // namespace raybound
