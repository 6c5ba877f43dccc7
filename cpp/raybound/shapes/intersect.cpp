#include "raybound/shapes/intersect.h"

#include "raybound/shapes/csg.h"
#include "raybound/shapes/mesh_hit.h"

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
    const W t = select(span.in_ahead, span.t_in, span.t_out);
    const int face = select(span.in_ahead, span.face_in, span.face_out);
    return {t, index, face, 0, Mask<W>(span.hit & (span.in_ahead | span.out_ahead)), span.in_ahead};
}

template <class W>
Crossing<W> cross_csg(const Geometry& geometry, std::uint32_t root, const Ray<W>& ray) {
    CsgEvaluation<W> evaluation(geometry, ray);
    evaluation.evaluate(root);
    for (const Interval<W>& interval : evaluation.intervals())
        for (const Boundary<W>* boundary : {&interval.in, &interval.out})
            if (boundary->ahead) {
                const CsgNode& node = geometry.csg_nodes[boundary->node];
                return {boundary->t, node.first, boundary->face, node.face_offset, true, boundary == &interval.in};
            }
    return {infinity<W>, 0, 0, 0, Mask<W>(false), Mask<W>(false)};
}

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
    if (face != 0 || leaf.kind == LeafKind::box || is_sheet(leaf)) return W(0);
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    const Vec3<W> rows(frame.row_norm);
    const W stretch = dot(rows, rows) * (W(1) + W(0x1p-20));
    if (leaf.kind == LeafKind::quadric) return stretch * W(geometry.quadrics[leaf.polygon].norm);
    return leaf.kind == LeafKind::cone ? stretch * maximum(W(1), square(W(frame.slope))) : stretch;
}

// How far a polished point can be from the surface (derivation D3). Four bands: the error of F there, that of F at the
// origin spawned from it, and as much again, so that the kernel is sure of its side. |F| / |grad F| is a bound where F
// along the normal is as good as linear from here to the surface.
template <class W>
W surface_distance(const Geometry& geometry, const Leaf& leaf, int face, const Vec3<W>& p, const Surface<W>& surface,
                   const Vec3<W>& normal) {
    const W squared = dot(surface.gradient, surface.gradient);
    const bool quadric = leaf.kind == LeafKind::quadric && face == 0;
    const W residual = abs(surface.form.value) + W(4) * surface.form.band * (quadric ? quadric_margin<W> : W(1));
    const W flat = W(0x1p-11) * squared;
    const bool linear = residual * largest_curvature<W>(geometry, leaf, face) <= flat ||
                        residual * abs(leaf_curvature(geometry, leaf, face, p, normal)) <= flat;
    const W distance =
        linear ? residual / sqrt(squared) * (W(1) + W(0x1p-10)) : distance_anywhere(geometry, leaf, face, p);
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
Polished<W> polish(const Geometry& geometry, const Leaf& leaf, int face, Vec3<W> p, const Vec3<W>& direction) {
    Surface<W> surface = leaf_surface(geometry, leaf, face, p, direction);
    for (int step = 0; step < 8 && abs(surface.form.value) > W(2) * surface.form.band; ++step) {
        const Vec3<W> moved = p - surface.gradient * (surface.form.value / dot(surface.gradient, surface.gradient));
        if (!is_finite(moved)) break;
        p = moved;
        surface = leaf_surface(geometry, leaf, face, p, direction);
    }
    return {p, surface};
}

// Where the gradient vanishes, the axis at the apex of a cone; elsewhere (a point that fell on the centre of a sphere
// far below its own rounding) toward the viewer.
template <class W>
Vec3<W> unit_normal(const Geometry& geometry, const Leaf& leaf, const Surface<W>& surface, const Vec3<W>& direction) {
    if (leaf.kind == LeafKind::box && leaf.frame < 0) return surface.gradient;  // an axis
    const W largest_part = max_component(absolute(surface.gradient));
    if (largest_part > W(0)) return normalize(surface.gradient * (W(1) / largest_part));
    if (leaf.kind != LeafKind::cone) return normalize(-direction);
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    return normalize(frame_linear<W>(frame).row[2] * W(frame.slope < 0 ? -1 : 1));
}

template <std::floating_point T>
T round_up(Wide<T> x) {
    return minimum(next_float_up(T(x)), std::numeric_limits<T>::max());
}

}  // namespace

template <class T>
Crossing<Wide<T>> first_crossing(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray,
                                 const Asking<T>& asking) {
    if (primitive.is_csg) return cross_csg(geometry, primitive.root, ray.wide);
    if (geometry.leaves[primitive.root].kind == LeafKind::mesh)
        return cross_mesh<T>(geometry, primitive.root, ray.wide, asking.t_max, asking.brute_force);
    if constexpr (!std::is_same_v<T, Wide<T>>)
        if (!asking.filtered && none(may_cross(geometry, geometry.leaves[primitive.root], ray.narrow)))
            return {infinity<Wide<T>>, 0, 0, 0, false, false};
    return cross_leaf(geometry, primitive.root, ray.wide);
}

template <class T>
Mask<T> blocks(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray, const Asking<T>& asking) {
    using W = Wide<T>;
    const W end = ray.wide.t_max * (W(1) - gamma<W>(8));
    if (!primitive.is_csg && geometry.leaves[primitive.root].kind == LeafKind::mesh)
        return mesh_blocks<T>(geometry, primitive.root, ray.wide, end, asking.brute_force);
    const Crossing<W> crossing = first_crossing(geometry, primitive, ray, asking);
    if (none(crossing.hit) || !ray.wide.has_target) return crossing.hit;
    if (!(crossing.t < end)) return Mask<T>(false);
    return crossing.t + boundary_error(geometry, geometry.leaves[crossing.leaf], crossing.face, crossing.t, ray.wide) <
           end;
}

template <class T>
T crossing_error(const Geometry& geometry, const Crossing<Wide<T>>& crossing, const Ray<Wide<T>>& ray, T t,
                 const Polished<Wide<T>>& polished, const Vec3<Wide<T>>& normal) {
    using W = Wide<T>;
    const Leaf& leaf = geometry.leaves[crossing.leaf];
    const Surface<W>& surface = polished.surface;
    const W off_surface =
        root_error(W(leaf.surface_error), dot(normal, ray.direction), surface.curvature / length(surface.gradient));
    return round_up<T>(abs(W(t) - crossing.t) + off_surface +
                       boundary_error(geometry, leaf, crossing.face, crossing.t, ray));
}

// Eight bounds instead of one, so that a ray sent back through the surface certainly has it ahead (D3, D8); and 2^-20
// of everything, so that the float normal may stand for the true one.
template <class T>
SurfacePoint<T> mesh_surface_point(const Geometry& geometry, const Crossing<Wide<T>>& crossing, const Ray<Wide<T>>& ray,
                                   Wanted wanted) {
    using W = Wide<T>;
    const Leaf& leaf = geometry.leaves[crossing.leaf];
    const BarycentricHit at = barycentric_hit(geometry, leaf, crossing.face, ray);
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
    hit.entering = at.entering;
    if (!wanted.t_error) return hit;
    const Surface<W> surface = leaf_surface(geometry, leaf, crossing.face, at.point, ray.direction);
    hit.t_error = crossing_error(geometry, crossing, ray, hit.t, {at.point, surface}, at.normal);
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
    const Vec3<W>& exact = polished.point;
    const Vec3<W> normal = unit_normal(geometry, leaf, polished.surface, ray.direction);
    const W distance =
        surface_distance(geometry, leaf, crossing.face, exact, polished.surface, normal) + W(leaf.surface_error);

    SurfacePoint<T> hit;
    hit.t = T(crossing.t);
    hit.t_error = wanted.t_error ? crossing_error(geometry, crossing, ray, hit.t, polished, normal) : T(0);
    hit.point = Vec3<T>(exact);
    const Vec3<W> rounding = absolute(Vec3<W>(hit.point) - exact);
    for (int i = 0; i < 3; ++i) hit.point_error[i] = round_up<T>(distance * abs(normal[i]) + rounding[i]);
    hit.normal = hit.shading = Vec3<T>(normal);
    hit.entering = is_sheet(leaf) ? !(dot(ray.direction, normal) > W(0)) : crossing.entering;
    if (wanted.uv) hit.uv = leaf_uv(geometry, leaf, crossing.face, hit.point);
    return hit;
}

template <class T>
PlainPoint<T> estimate_point(const Geometry& geometry, const Crossing<Wide<T>>& crossing, const Ray<T>& ray) {
    const Leaf& leaf = geometry.leaves[crossing.leaf];
    const Vec3<T> p = ray.origin + ray.direction * T(crossing.t);
    const Surface<T> surface = leaf_surface(geometry, leaf, crossing.face, p, ray.direction);
    return {p, unit_normal(geometry, leaf, surface, ray.direction)};
}

bool is_left_for_good(const Geometry& geometry, const Primitive& primitive, bool outward) {
    if (primitive.is_csg) return false;
    const Leaf& leaf = geometry.leaves[primitive.root];
    return leaf.kind != LeafKind::mesh && leaf.kind != LeafKind::quadric && (outward || is_sheet(leaf));
}

// The number types that rays are traced with today. (float filters and shades, double decides.)
template Crossing<double> first_crossing(const Geometry&, const Primitive&, const WideRay<float>&,
                                         const Asking<float>&);
template Crossing<double> first_crossing(const Geometry&, const Primitive&, const WideRay<double>&,
                                         const Asking<double>&);
template bool blocks(const Geometry&, const Primitive&, const WideRay<float>&, const Asking<float>&);
template bool blocks(const Geometry&, const Primitive&, const WideRay<double>&, const Asking<double>&);
template SurfacePoint<float> surface_point(const Geometry&, const Crossing<double>&, const Ray<double>&, Wanted);
template SurfacePoint<double> surface_point(const Geometry&, const Crossing<double>&, const Ray<double>&, Wanted);
template PlainPoint<float> estimate_point(const Geometry&, const Crossing<double>&, const Ray<float>&);
template PlainPoint<double> estimate_point(const Geometry&, const Crossing<double>&, const Ray<double>&);

}  // namespace raybound
