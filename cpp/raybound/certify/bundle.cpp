#include "raybound/certify/bundle.h"

#include <algorithm>

#include "raybound/shapes/intersect.h"

namespace raybound {

namespace {

constexpr double box_margin = 0x1p-18;      // of the way: more than a float ray is off the exact one (D40)
constexpr double separation = 0x1p-20;      // of sizes: more than a kernel of double is off (D41)
constexpr double depth = 0x1p-17;           // of sizes: how deep inside a hit is certain (D42)
constexpr double least_share = 0x1p-8;      // of the way from the light, before which no blocker may begin (D42)
constexpr double worst_condition = 0x1p10;  // of frames, for a no
constexpr double yes_condition = 8;         // and for a yes

double largest_coordinate_of(const Boxd& box) {
    return maximum(max_component(absolute(box.lower)), max_component(absolute(box.upper)));
}

Boxd widened(const Boxd& box, double margin) {
    const Vec3d m{margin, margin, margin};
    return {box.lower - m, box.upper + m};
}

Boxd to_double(const Box& box) { return {Vec3d(box.lower), Vec3d(box.upper)}; }

bool disjoint(const Boxd& a, const Boxd& b) {
    const Boxd common = intersection(a, b);
    return common.is_empty();
}

double box_distance(const Boxd& box, const Vec3d& p) {
    return length(maximum(maximum(box.lower - p, p - box.upper), Vec3d{}));
}

SweptBox swept_box(const Patch& origins, const Vec3d& target, bool directional) {
    const Boxd box = origins.bounds();
    const double coordinates = maximum(largest_coordinate_of(box), max_component(absolute(target)));
    if (directional) return {widened(box, 0x1p-26 * coordinates), target, target, infinity<double>};
    const Boxd way{box.lower - target, box.upper - target};
    const double margin = box_margin * largest_coordinate_of(way) + 0x1p-26 * coordinates;
    return {widened({target, target}, margin), way.lower, way.upper, 1 + 0x1p-20};
}

// A patch that holds all points within `margin` of it: each pair of faces moved apart.
Patch grown(const Patch& patch, double margin) {
    Patch result = patch;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d across = cross(patch.axis[(k + 1) % 3], patch.axis[(k + 2) % 3]);
        const double half = abs(dot(patch.axis[k], across)) / length(across);
        if (!(half > 0)) return {patch.center, {Vec3d{infinity<double>, 0, 0}, {}, {}}};
        result.axis[k] = patch.axis[k] * ((1 + margin / half) * (1 + 0x1p-40));
    }
    return result;
}

// The convex hull of two patches: of origins and what their rays end in.
struct Shaft {
    Patch near, far;

    Vec3d support(const Vec3d& n) const {
        const Vec3d a = near.support(n), b = far.support(n);
        return dot(n, a) > dot(n, b) ? a : b;
    }

    // The point of the line in the middle that is closest to p.
    Vec3d closest(const Vec3d& p) const {
        const Vec3d way = far.center - near.center;
        const double size = dot(way, way);
        const double s = size > 0 ? minimum(maximum(dot(p - near.center, way) / size, 0.0), 1.0) : 0;
        return near.center + way * s;
    }
};

// A directional shaft ends behind the primitive: what lies beyond is of no interest.
Shaft shaft_of(const Bundle& bundle, const Boxd& bounds, double scale) {
    const Patch& near = bundle.origins();
    if (!bundle.is_directional()) return {near, {bundle.target(), {}}};
    const Vec3d d = bundle.target() * (1 / length(bundle.target()));
    const Boxd origins = near.bounds();
    double from = 0, until = 0;
    for (int i = 0; i < 3; ++i) {
        from += d[i] * (d[i] > 0 ? origins.lower[i] : origins.upper[i]);
        until += d[i] * (d[i] > 0 ? bounds.upper[i] : bounds.lower[i]);
    }
    Patch far = near;
    far.center = far.center + d * maximum(0.0, until - from + 0x1p-10 * scale);
    return {near, far};
}

// A polygon's hits lie on the plane of its first vertex, its hull is that of all vertices: a ray meets them as far
// apart as they are off each other, over the sine of its angle with the plane. Infinite for rays all but in the plane,
// which may be told a t that is anywhere on it (D41). 0 for other leaves.
double plane_slack(const Bundle& bundle, const Geometry& geometry, const Leaf& leaf, double scale) {
    if (leaf.kind != LeafKind::polygon) return 0;
    const PolygonPlane& plane = geometry.polygons[leaf.polygon];
    double sine = 0;  // at least, of the rays that cross the plane before the light
    if (bundle.is_directional())
        sine = abs(dot(plane_gradient<double>(plane), bundle.target())) * 0.25;
    else
        sine = abs(plane_form(plane, geometry.vertices[plane.first_vertex], bundle.target()).value) / (4 * scale);
    return sine > 0x1p-20 ? double(leaf.surface_error) / sine : infinity<double>;
}

// What is known of one leaf and one shaft.
struct Asked {
    const Shaft& shaft;
    const Geometry& geometry;
    const Leaf& leaf;
    Boxd bounds;       // of the primitive
    double scale;      // of all distances involved
    double slack = 0;  // of a polygon's plane
};

// Is there a plane between them, with the margin on both sides? (Gilbert's iteration toward the point of the difference
// of both sets that is closest to the origin; whatever direction it tries, the answer is certain.)
bool separated(const ConvexHull& hull, const Shaft& shaft, double margin) {
    Vec3d v = hull.center() - shaft.closest(hull.center());
    for (int step = 0; step < 5; ++step) {
        const double size = length(v);
        if (!(size > margin)) return false;
        const Vec3d n = v * (1 / size);
        const Vec3d w = hull.support(-n) - shaft.support(n);
        if (dot(n, w) > margin) return true;
        const Vec3d d = w - v;
        const double along = -dot(v, d), squared = dot(d, d);
        if (!(along > 0)) return false;
        v = v + d * minimum(along / squared, 1.0);
    }
    return false;
}

bool misses_leaf(const Asked& asked) {
    if (!(asked.slack < infinity<double>)) return false;
    const ConvexHull hull(asked.geometry, asked.leaf);
    if (!hull.is_known() || !(hull.condition() <= worst_condition)) return false;
#ifdef RAYBOUND_SABOTAGE_CERTIFICATE
    const double margin = -0x1p-9 * asked.scale;  // the sabotage build: what may meet a little is said to miss
#else
    const double margin =
        separation * hull.condition() * asked.scale + 0x1p-26 * largest_coordinate_of(asked.bounds) + asked.slack;
#endif
    return separated(hull, asked.shaft, margin);
}

// An expression is missed if all parts of a union are, or one of an intersection, or the first of a difference. Nothing
// is known of high ones.
bool misses(const Asked& asked, std::uint32_t index) {
    if (asked.geometry.is_high(index)) return false;
    const CsgNode& node = asked.geometry.csg_nodes[index];
    if (node.kind == CsgKind::leaf) {
        const Asked part{asked.shaft, asked.geometry, asked.geometry.leaves[node.first], asked.bounds, asked.scale};
        return misses_leaf(part);
    }
    const auto child = [&](std::uint32_t i) { return asked.geometry.csg_children[node.first + i]; };
    if (node.kind == CsgKind::csg_difference) return misses(asked, child(0));
    const bool all = node.kind == CsgKind::csg_union;
    for (std::uint32_t i = 0; i < node.count; ++i)
        if (misses(asked, child(i)) != all) return !all;
    return all;
}

// The shortest edge of a polygon bounds how well double tells the sides of its edges.
bool has_short_edges(const Geometry& geometry, const Leaf& leaf, double depth_inside, double scale) {
    if (leaf.kind != LeafKind::polygon) return false;
    const auto vertices = geometry.polygon_vertices(geometry.polygons[leaf.polygon]);
    double shortest = infinity<double>;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        shortest = minimum(shortest, length(vertices[i] - vertices[(i + 1) % vertices.size()]));
    return !(shortest * depth_inside > 0x1p-40 * scale * scale);
}

bool is_blocked_from(const Bundle& bundle, const Geometry& geometry, const Primitive& primitive, const Vec3d& origin) {
    const WideRay<double> ray = bundle.is_directional() ? WideRay<double>(origin, bundle.target())
                                                        : WideRay<double>::segment(origin, bundle.target());
    return blocks<double>(geometry, primitive, ray);
}

// From where a convex solid hides a point is a convex set: the corners of a patch tell for all of it (D42).
bool blocks_all(const Bundle& bundle, const Asked& asked, const Primitive& primitive) {
    if (!is_blocked_from(bundle, asked.geometry, primitive, bundle.origins().center)) return false;
    const ConvexHull hull(asked.geometry, asked.leaf);
    if (!hull.is_exact() || !(hull.condition() <= yes_condition)) return false;
    if (!(asked.slack <= 0x1p-3 * depth * asked.scale)) return false;
    double share = 1;
    if (!bundle.is_directional())
        share = box_distance(asked.bounds, bundle.target()) / (bundle.largest_distance() * (1 + 0x1p-10));
    if (!(share >= least_share)) return false;
    const double margin = depth * asked.scale / minimum(share, 1.0);
    if (!disjoint(widened(bundle.origins().bounds(), 2 * margin), asked.bounds)) return false;
    if (has_short_edges(asked.geometry, asked.leaf, 0.5 * depth * asked.scale, asked.scale)) return false;
    const Patch around = grown(bundle.origins(), margin);
    if (!is_finite(around.axis[0])) return false;
    for (int i = 0; i < 8; ++i)
        if (!is_blocked_from(bundle, asked.geometry, primitive, around.corner(i))) return false;
    return true;
}

// The farthest and nearest that a crossing of a box around the primitive can be.
BundleHits certain(const Boxd& origins, const Boxd& bounds) {
    const Vec3d apart = maximum(maximum(bounds.lower - origins.upper, origins.lower - bounds.upper), Vec3d{});
    const Vec3d most = maximum(bounds.upper - origins.lower, origins.upper - bounds.lower);
    return {Verdict::yes, length(apart) * (1 - 0x1p-40), length(most) * (1 + 0x1p-40)};
}

bool misses(const Asked& asked, const Primitive& primitive) {
    return primitive.is_csg ? misses(asked, primitive.root) : misses_leaf(asked);
}

const Leaf& leaf_of(const Geometry& geometry, const Primitive& primitive) {
    static const Leaf none;
    return primitive.is_csg ? none : geometry.leaves[primitive.root];
}

double scale_of(Boxd all, const Boxd& bounds) {
    all.extend(bounds);
    return norm1(all.extent());
}

}  // namespace

Bundle::Bundle(const Patch& origins, const Vec3d& target, bool directional)
    : origins_(origins), target_(target), directional_(directional), swept_(swept_box(origins, target, directional)) {
    if (directional) return;
    const Boxd box = origins.bounds();
    most_ = length(maximum(absolute(box.lower - target), absolute(box.upper - target))) * (1 + 0x1p-40);
    beside_light_ = round_outward(widened({target, target}, 0x1p-9 * most_));
}

Boxd Bundle::bounds() const {
    Boxd box = origins_.bounds();
    if (!directional_) box.extend(target_);
    return box;
}

bool Bundle::overlaps(const Box& box) const {
    if (directional_) return false;
    const Vec3f low = maximum(box.lower, beside_light_.lower), high = minimum(box.upper, beside_light_.upper);
    return low.x <= high.x && low.y <= high.y && low.z <= high.z;
}

Bundle light_bundle(const Patch& origins, const Light& light) {
    if (light.kind == LightKind::directional) return Bundle::along(origins, -Vec3f(light.direction));
    return Bundle::toward_point(origins, light.position);
}

BundleHits hits(const Bundle& bundle, const Geometry& geometry, const Primitive& primitive) {
    if (!bundle.may_meet(primitive.bounds)) return {Verdict::no};
    const Boxd bounds = to_double(primitive.bounds);
    const double scale = scale_of(bundle.bounds(), bounds);
    if (!(scale < infinity<double>)) return {};
    const Shaft shaft = shaft_of(bundle, bounds, scale);
    const Leaf& leaf = leaf_of(geometry, primitive);
    const double slack = primitive.is_csg ? 0 : plane_slack(bundle, geometry, leaf, scale);
    const Asked asked{shaft, geometry, leaf, bounds, scale, slack};
    if (misses(asked, primitive)) return {Verdict::no};
    if (primitive.is_csg) return {};
    if (blocks_all(bundle, asked, primitive)) return certain(bundle.origins().bounds(), bounds);
    return {};
}

Verdict hits(const RayBundle& bundle, const Geometry& geometry, const Primitive& primitive) {
    const Leaf& leaf = leaf_of(geometry, primitive);
    if (leaf.kind == LeafKind::polygon && !primitive.is_csg) return Verdict::unknown;
    const Boxd bounds = to_double(primitive.bounds);
    // A ray has passed the primitive after this time: directions are unit vectors, up to what many reflections lose.
    const Vec3d most = maximum(bounds.upper - bundle.origins().lower, bundle.origins().upper - bounds.lower);
    const double reach = length(most) * 2;
    const Boxd far{bundle.origins().lower + bundle.directions().lower * reach,
                   bundle.origins().upper + bundle.directions().upper * reach};
    Boxd all = bundle.origins();
    all.extend(far);
    const double scale = scale_of(all, bounds);
    if (!(scale < infinity<double>)) return Verdict::unknown;
    const Shaft shaft{Patch::around(bundle.origins()), Patch::around(far)};
    return misses({shaft, geometry, leaf, bounds, scale}, primitive) ? Verdict::no : Verdict::unknown;
}

}  // namespace raybound
