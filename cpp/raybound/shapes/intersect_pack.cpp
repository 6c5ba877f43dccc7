#include "raybound/shapes/intersect_pack.h"

#include "raybound/shapes/csg_pack.h"
#include "raybound/shapes/hit_point.h"
#include "raybound/shapes/lanes.h"

namespace raybound {

namespace {

// The first crossings of a primitive, as Crossing: of one leaf, or where `leaf_of_lane` says which.
struct Crossings {
    DoublePack t;
    PackVector<std::int32_t> face{}, face_offset{}, leaf{};
    std::uint32_t hit = 0, entering = 0;
};

Crossings cross_convex(const Geometry& geometry, std::uint32_t index, const Ray<DoublePack>& rays) {
    const FirstAhead<DoublePack> first = first_ahead(leaf_span_ahead(geometry, geometry.leaves[index], rays));
    Crossings found;
    found.t = first.t;
    found.face = __builtin_convertvector(first.face.v, PackVector<std::int32_t>);
    found.leaf = in_every_lane(std::int32_t(index));
    found.hit = bits(first.hit);
    found.entering = bits(first.entering);
    return found;
}

Crossings cross_csg(const Geometry& geometry, std::uint32_t root, const Ray<DoublePack>& rays, std::uint32_t lanes) {
    CsgPack pack(geometry, rays);
    const CsgPack::FirstBoundary first = pack.first_boundary(root, lanes);
    Crossings found;
    found.t = first.boundary.t;
    found.face = __builtin_convertvector(first.boundary.face.v, PackVector<std::int32_t>);
    found.hit = first.hit;
    found.entering = first.entering;
    for_each_lane(found.hit, [&](int lane) {
        const CsgNode& node = geometry.csg_nodes[std::size_t(first.boundary.node[lane])];
        found.face_offset[lane] = node.face_offset;
        found.leaf[lane] = std::int32_t(node.first);
    });
    return found;
}

BlockedLanes blocked_by_csg(const Geometry& geometry, std::uint32_t root, const RayPack& rays, std::uint32_t lanes) {
    CsgPack pack(geometry, rays.wide);
    const CsgPack::FirstBoundary first = pack.first_boundary(root, lanes);
    if (!rays.wide.has_target || first.hit == 0) return {first.hit, first.hit & ~first.entering};
    const DoublePack &t = first.boundary.t, end = rays.wide.t_max * DoublePack(1 - gamma<double>(8));
    const std::uint32_t before = first.hit & bits(t < end);
    const std::uint32_t blocked = before & bits(t + pack.errors(first.boundary, before) < end);
    return {blocked, blocked & ~first.entering};
}

BlockedLanes blocked_one_by_one(const Geometry& geometry, const Primitive& primitive, const RayPack& rays,
                                std::uint32_t lanes) {
    BlockedLanes found;
    for_each_lane(lanes, [&](int lane) {
        const WideRay<float> ray(lane_of(rays.narrow, lane));
        Blocking how;
        if (!blocks(geometry, primitive, ray, {}, &how)) return;
        found.blocked |= 1u << lane;
        found.exits |= std::uint32_t(!how.entering) << lane;
    });
    return found;
}

// What is not convex: ray by ray. (The filter in float is worth its time for quadrics.)
Crossings cross_one_by_one(const Geometry& geometry, const Primitive& primitive, const RayPack& rays,
                           std::uint32_t lanes, const FloatPack& t_max) {
    Crossings found;
    for_each_lane(lanes, [&](int lane) {
        const WideRay<float> ray(lane_of(rays.narrow, lane));
        const Crossing<double> crossing = first_crossing(geometry, primitive, ray, Asking<float>{.t_max = t_max[lane]});
        if (!crossing.hit) return;
        set_lane(found.t, lane, crossing.t);
        found.face[lane] = crossing.face;
        found.face_offset[lane] = crossing.face_offset;
        found.leaf[lane] = std::int32_t(crossing.leaf);
        found.hit |= 1u << lane;
        found.entering |= std::uint32_t(crossing.entering) << lane;
    });
    return found;
}

bool is_convex(const Geometry& geometry, const Primitive& primitive) {
    if (primitive.is_csg) return false;
    const LeafKind kind = geometry.leaves[primitive.root].kind;
    return kind != LeafKind::quadric && kind != LeafKind::mesh;
}

template <class S>
void take(PackVector<std::int32_t> chosen, PackVector<std::int32_t> value, S (&into)[pack_width]) {
    static_assert(sizeof into == sizeof value);
    PackVector<std::int32_t> before;
    std::memcpy(&before, into, sizeof before);
    before = chosen ? value : before;
    std::memcpy(into, &before, sizeof before);
}

// The lanes of `ties` where the primitive's face comes before the one found so far.
std::uint32_t first_in_rank(const Geometry& geometry, std::uint32_t primitive, const Crossings& found,
                            std::uint32_t ties, const NearestPack& best) {
    std::uint32_t before = 0;
    for_each_lane(ties, [&](int lane) {
        const Rank mine = rank(geometry, primitive, found.face_offset[lane] + found.face[lane]);
        const Rank other = rank(geometry, best.primitive[lane], best.face_offset[lane] + best.face[lane]);
        before |= std::uint32_t(mine < other) << lane;
    });
    return before;
}

// Certainly before the segments' ends, though the crossings of one face be as far off as they may.
std::uint32_t certainly_before(const Geometry& geometry, const Leaf& leaf, const Crossings& found,
                               const Ray<DoublePack>& rays, const DoublePack& end, std::uint32_t lanes) {
    std::uint32_t before = 0;
    while (lanes != 0) {
        const std::int32_t face = found.face[std::countr_zero(lanes)];
        const std::uint32_t same = lanes & bits(PackMask<float>(found.face == face));
        before |= same & bits(found.t + boundary_error(geometry, leaf, face, found.t, rays) < end);
        lanes &= ~same;
    }
    return before;
}

}  // namespace

std::uint32_t consider(const Geometry& geometry, std::uint32_t index, const RayPack& rays, std::uint32_t lanes,
                       const FloatPack& doubtful_from, NearestPack& best) {
    const Primitive& primitive = geometry.primitives[index];
    const BoxInterval<FloatPack> inside = slab_interval(primitive.bounds, rays.narrow, best.t);
    lanes &= bits(inside.near <= inside.far);
    if (lanes == 0) return 0;
    const Crossings found = is_convex(geometry, primitive) ? cross_convex(geometry, primitive.root, rays.wide)
                            : primitive.is_csg             ? cross_csg(geometry, primitive.root, rays.wide, lanes)
                                                           : cross_one_by_one(geometry, primitive, rays, lanes, best.t);
    const FloatPack t = maximum(FloatPack(found.t), inside.near);
    lanes &= found.hit & bits((t < infinity<FloatPack>)&(t <= best.t));
    const std::uint32_t doubtful = lanes & bits(t >= doubtful_from);
    lanes &= ~doubtful;
    if (const std::uint32_t ties = lanes & best.hit & bits(t == best.t); ties != 0)
        lanes &= ~ties | first_in_rank(geometry, index, found, ties, best);
    if (lanes == 0) return doubtful;
    const PackMask<float> chosen = lanes_of<float>(lanes);
    best.t = select(chosen, t, best.t);
    best.crossing_t = select(lanes_of<double>(lanes), found.t, best.crossing_t);
    take(chosen.lanes, in_every_lane(std::int32_t(index)), best.primitive);
    take(chosen.lanes, found.leaf, best.leaf);
    take(chosen.lanes, found.face, best.face);
    take(chosen.lanes, found.face_offset, best.face_offset);
    best.hit |= lanes;
    best.entering = (best.entering & ~lanes) | (found.entering & lanes);
    return doubtful;
}

bool consider_one(const Geometry& geometry, std::uint32_t primitive, int lane, const Crossing<double>& crossing,
                  float entry, float doubtful_from, NearestPack& best) {
    const float t = maximum(float(crossing.t), entry);
    if (!crossing.hit || !(t < infinity<float>) || t > best.t[lane]) return false;
    if (t >= doubtful_from) return true;
    const Rank mine = rank(geometry, primitive, crossing.face_offset + crossing.face);
    if ((best.hit >> lane & 1) != 0 && t == best.t[lane] &&
        !(mine < rank(geometry, best.primitive[lane], best.face_offset[lane] + best.face[lane])))
        return false;
    best.set(lane, primitive, crossing, t);
    return false;
}

BlockedLanes blocked_lanes(const Geometry& geometry, std::uint32_t index, const RayPack& rays, std::uint32_t lanes) {
    const Primitive& primitive = geometry.primitives[index];
    const FloatPack reach = rays.narrow.has_target ? rays.narrow.t_max * FloatPack(1 + 0x1p-10f) : infinity<FloatPack>;
    const BoxInterval<FloatPack> inside = slab_interval(primitive.bounds, rays.narrow, reach);
    lanes &= bits(inside.near <= inside.far);
    if (lanes == 0) return {};
    if (primitive.is_csg) return blocked_by_csg(geometry, primitive.root, rays, lanes);
    if (!is_convex(geometry, primitive)) return blocked_one_by_one(geometry, primitive, rays, lanes);
    const Crossings found = cross_convex(geometry, primitive.root, rays.wide);
    lanes &= found.hit;
    if (rays.narrow.has_target && lanes != 0) {
        const DoublePack end = rays.wide.t_max * DoublePack(1 - gamma<double>(8));
        lanes &= bits(found.t < end);
        lanes = certainly_before(geometry, geometry.leaves[primitive.root], found, rays.wide, end, lanes);
    }
    return {lanes, lanes & ~found.entering};
}

LeavingPack leave_convex(const Geometry& geometry, std::uint32_t leaf, const RayPack& rays) {
    const Exit<DoublePack> exit = leaf_exit(geometry, geometry.leaves[leaf], rays.wide);
    const DoublePack zero(0.0);
    return {select((exit.t > zero) & (exit.t < infinity<DoublePack>), exit.t, zero), exit.face};
}

std::uint32_t lanes_blocked_from_inside(const Geometry& geometry, std::uint32_t leaf, const RayPack& rays,
                                        std::uint32_t lanes) {
    const LeavingPack leaving = leave_convex(geometry, leaf, rays);
    if (!rays.narrow.has_target) return lanes;
    Crossings found;
    found.t = leaving.t;
    found.face = __builtin_convertvector(leaving.face.v, PackVector<std::int32_t>);
    const DoublePack end = rays.wide.t_max * DoublePack(1 - gamma<double>(8));
    return certainly_before(geometry, geometry.leaves[leaf], found, rays.wide, end, lanes & bits(leaving.t < end));
}

SurfacePoint<FloatPack> surface_points(const Geometry& geometry, const FaceCrossings& crossings,
                                       const Ray<DoublePack>& rays, Wanted wanted) {
    using W = DoublePack;
    const Leaf& leaf = geometry.leaves[crossings.leaf];
    SurfacePoint<FloatPack> hits;
    std::uint32_t rest = (1u << pack_width) - 1;
    if (leaf.kind != LeafKind::quadric && leaf.kind != LeafKind::mesh) {
        const Vec3<W> p = rays.origin + rays.direction * crossings.t;
        const Polished<W> found = polish(geometry, leaf, crossings.face, p, rays.direction);
        const Surface<W>& surface = found.surface;
        const W squared = dot(surface.gradient, surface.gradient);
        const W residual = largest_residual(surface.form, W(1)), part = max_component(absolute(surface.gradient));
        const bool is_axis = leaf.kind == LeafKind::box && leaf.frame < 0;
        const Vec3<W> normal = is_axis ? surface.gradient : unit_gradient(surface.gradient, part);
        const W curvature = largest_curvature<W>(geometry, leaf, crossings.face);
        rest = bits(!(is_flat(residual, curvature, squared) & (part > W(0))));
        const FaceHit<FloatPack> hit{leaf, crossings.face, crossings.t, lanes_of<double>(crossings.entering)};
        hits = rounded_point(geometry, hit, rays, found, normal, linear_distance(residual, squared), wanted);
    }
    for_each_lane(rest, [&](int lane) {  // those near a cone's apex and the like, too
        const Crossing<double> crossing{
            crossings.t[lane], crossings.leaf, crossings.face, 0, true, (crossings.entering >> lane & 1) != 0};
        set_lane(hits, lane, surface_point<float>(geometry, crossing, lane_of(rays, lane), wanted));
    });
    return hits;
}

}  // namespace raybound
