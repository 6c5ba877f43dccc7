#include "raybound/shapes/inside.h"

#include <algorithm>
#include <optional>

#include "raybound/shapes/closest.h"
#include "raybound/shapes/hit_point.h"
#include "raybound/shapes/mesh_hit.h"

namespace raybound {

namespace {

// How deep a point lies below a face, by F over the size of its gradient.
double depth_below(const Geometry& geometry, const Leaf& leaf, int face, const Vec3d& p) {
    const Surface<double> surface = leaf_surface(geometry, leaf, face, p, Vec3d{0, 0, 1});
    if (surface.form.value == 0) return 0;
    return -surface.form.value / length(surface.gradient);
}

int face_count(const Leaf& leaf) {
    if (leaf.kind == LeafKind::sphere) return 1;
    if (leaf.kind == LeafKind::quadric) return 7;
    return leaf.kind == LeafKind::box ? 6 : 3;
}

double leaf_depth(const Geometry& geometry, const Leaf& leaf, const Vec3d& p) {
    double least = infinity<double>;
    for (int face = 0; face < face_count(leaf); ++face)
        least = std::min(least, depth_below(geometry, leaf, face, p));
    return least;
}

// The nodes of an expression, each after its children; the root is the last one.
std::uint32_t first_node(const Geometry& geometry, std::uint32_t root) {
    while (geometry.csg_nodes[root].kind != CsgKind::leaf) root = geometry.csg_children[geometry.csg_nodes[root].first];
    return root;
}

double csg_depth(const Geometry& geometry, std::uint32_t root, const Vec3d& p) {
    const std::uint32_t begin = first_node(geometry, root);
    std::vector<double> depth;
    for (std::uint32_t index = begin; index <= root; ++index) {
        const CsgNode& node = geometry.csg_nodes[index];
        if (node.kind == CsgKind::leaf) {
            depth.push_back(leaf_depth(geometry, geometry.leaves[node.first], p));
            continue;
        }
        const auto of_child = [&](std::uint32_t i) { return depth[geometry.csg_children[node.first + i] - begin]; };
        double all = of_child(0);
        for (std::uint32_t i = 1; i < node.count; ++i) {
            if (node.kind == CsgKind::csg_union) all = std::max(all, of_child(i));
            if (node.kind == CsgKind::csg_intersection) all = std::min(all, of_child(i));
            if (node.kind == CsgKind::csg_difference) all = std::min(all, -of_child(i));
        }
        depth.push_back(all);
    }
    return depth.back();
}

// By the distance to the nearest face, and the parity of crossings along some line.
double mesh_distance(const Geometry& geometry, const Leaf& leaf, const Vec3d& p) {
    const MeshData& mesh = *geometry.meshes[leaf.polygon].data;
    const auto& [linear, offset] = geometry.meshes[leaf.polygon].placement;
    double least = infinity<double>;
    for (std::size_t i = 0; i < mesh.faces().size(); ++i) {
        Corners<double> c = mesh.corners<double>(std::int32_t(i));
        c = {linear * c.a + offset, linear * c.b + offset, linear * c.c + offset};
        const CornerWeights w = closest_weights(c, p);
        least = std::min(least, length(c.a * w.a + c.b * w.b + c.c * w.c - p));
    }
    return least;
}

bool mesh_contains(const Geometry& geometry, const Primitive& primitive, const Vec3d& p) {
    const Ray<double> up{p, {0, 0, 1}};
    for (const Stretch& stretch : stretches_of(geometry, primitive, up))
        if (stretch.in.t <= 0 && stretch.out.t > 0) return true;
    return false;
}

bool is_mesh(const Geometry& geometry, const Primitive& primitive) {
    return !primitive.is_csg && geometry.leaves[primitive.root].kind == LeafKind::mesh;
}

bool is_convex(const Geometry& geometry, const Primitive& primitive) {
    return is_left_for_good(geometry, primitive, true);
}

// How far an origin may have been rounded: the box around a hit point and the step out of it, with room to spare.
double rounding_of(const Primitive& primitive, const Ray<double>& ray) {
    const Vec3d extent(primitive.bounds.upper - primitive.bounds.lower);
    return 0x1p-20 * max_component(absolute(ray.origin)) + 0x1p-40 * max_component(extent);
}

// A crossing that has to be ahead of the origin.
Crossing<double> ahead(Crossing<double> crossing) {
    if (!(crossing.t > 0 && crossing.t < infinity<double>)) crossing.t = 0;
    return crossing;
}

Crossing<double> exit_crossing(const Geometry& geometry, std::uint32_t leaf, std::int32_t face_offset,
                               const Ray<double>& ray) {
    const Exit<double> exit = leaf_exit(geometry, geometry.leaves[leaf], ray);
    return ahead({exit.t, leaf, exit.face, face_offset, true, false});
}

// Where a ray leaves an expression whose boundary it is within `margin` of, though its line may miss it. Nothing if it
// is farther outside.
class CsgExit {
  public:
    CsgExit(const Geometry& geometry, const Ray<double>& ray, double margin)
        : geometry_(geometry), ray_(ray), margin_(margin) {}

    std::optional<Crossing<double>> leave(std::uint32_t root) {
        begin_ = first_node(geometry_, root);
        complement_.assign(root - begin_ + 1, 0);
        for (std::uint32_t index = root; index > begin_; --index) mark_children(index);
        exits_.clear();
        for (std::uint32_t index = begin_; index <= root; ++index) {
            const CsgNode& node = geometry_.csg_nodes[index];
            exits_.push_back(node.kind != CsgKind::leaf      ? leave_node(node, complement_[index - begin_])
                             : complement_[index - begin_]   ? leave_complement(node)
                                                             : leave_leaf(node));
        }
        return exits_.back();
    }

  private:
    using Found = std::optional<Crossing<double>>;

    // Parts are taken away an even or an odd number of times.
    void mark_children(std::uint32_t index) {
        const CsgNode& node = geometry_.csg_nodes[index];
        if (node.kind == CsgKind::leaf) return;
        for (std::uint32_t i = 0; i < node.count; ++i) {
            const bool taken_away = node.kind == CsgKind::csg_difference && i > 0;
            complement_[geometry_.csg_children[node.first + i] - begin_] =
                (complement_[index - begin_] != 0) != taken_away;
        }
    }

    // A union is left with the last part that holds the ray, an intersection with the first. (The complement of a union
    // is an intersection of complements; a difference is an intersection with complements.)
    Found leave_node(const CsgNode& node, bool complement) const {
        const bool any = (node.kind == CsgKind::csg_union) != complement;
        Found best;
        for (std::uint32_t i = 0; i < node.count; ++i) {
            const Found& exit = exits_[geometry_.csg_children[node.first + i] - begin_];
            if (!exit && !any) return {};
            if (exit && (!best || (any ? exit->t > best->t : exit->t < best->t))) best = exit;
        }
        return best;
    }

    Found leave_leaf(const CsgNode& node) const {
        if (leaf_depth(geometry_, geometry_.leaves[node.first], ray_.origin) < -margin_) return {};
        return exit_crossing(geometry_, node.first, node.face_offset, ray_);
    }

    // Out of what is outside of a leaf: into the leaf, if the ray comes to it.
    Found leave_complement(const CsgNode& node) const {
        const Leaf& leaf = geometry_.leaves[node.first];
        if (leaf_depth(geometry_, leaf, ray_.origin) > margin_) return {};
        Crossing<double> exit{infinity<double>, node.first, 0, node.face_offset, true, false};
        const auto enter = [&](const Span<double>& span) {
            const bool still_ahead = span.t_in > 0 || -span.t_in < span.t_out;
            if (span.hit && span.t_out > 0 && still_ahead && !(exit.t < infinity<double>))
                exit.t = std::max(0.0, span.t_in), exit.face = span.face_in;
        };
        if (leaf.kind == LeafKind::quadric) {
            const Spans<double> spans = quadric_leaf_spans(geometry_, leaf, ray_);
            for (int i = 0; i < spans.count; ++i) enter(spans.part[i]);
        } else {
            enter(leaf_span(geometry_, leaf, ray_));
        }
        return exit;
    }

    const Geometry& geometry_;
    const Ray<double>& ray_;
    double margin_;
    std::uint32_t begin_ = 0;
    std::vector<char> complement_;
    std::vector<Found> exits_;
};

Crossing<double> leave_csg(const Geometry& geometry, const Primitive& primitive, const Ray<double>& ray,
                           double margin) {
    for (;; margin *= 16)
        if (const auto exit = CsgExit(geometry, ray, margin).leave(primitive.root)) return ahead(*exit);
}

// The face nearest to the origin, of those that the ray may leave by.
Crossing<double> leave_mesh(const Geometry& geometry, std::uint32_t index, const Ray<double>& ray) {
    const Leaf& leaf = geometry.leaves[index];
    const MeshData& mesh = *geometry.meshes[leaf.polygon].data;
    const PermutedLine line = mesh_line(geometry, leaf, ray);
    double least = infinity<double>;
    Crossing<double> best{0, index, 0, 0, true, false};
    for (std::size_t i = 0; i < mesh.faces().size(); ++i) {
        const Corners<double> c = mesh.corners<double>(std::int32_t(i));
        if (!(dot(cross(c.b - c.a, c.c - c.a), line.direction) > 0)) continue;
        const CornerWeights w = closest_weights(c, line.origin);
        const double distance = length(c.a * w.a + c.b * w.b + c.c * w.c - line.origin);
        if (distance < least) least = distance, best.face = std::int32_t(i);
    }
    return best;
}

// A way out that no crossing of the line shows.
Crossing<double> forced_exit(const Geometry& geometry, const Primitive& primitive, const Ray<double>& ray,
                             double margin) {
    if (primitive.is_csg) return leave_csg(geometry, primitive, ray, margin);
    if (is_mesh(geometry, primitive)) return leave_mesh(geometry, primitive.root, ray);
    return exit_crossing(geometry, primitive.root, 0, ray);
}

// Chooses among what the line has inside of a solid, where the origin is known up to `near` along the ray.
class NextCrossing {
  public:
    NextCrossing(std::span<const Stretch> stretches, const Departure& from, double near)
        : stretches_(stretches), from_(from), near_(near) {}

    // Out of the stretch that the ray has come in by, or else the nearest one.
    const Stretch* exit() const {
        const Stretch* best = nullptr;
        double least = 64 * near_;
        for (const Stretch& s : stretches_) {
            if (begins_on(s.in) && std::abs(s.in.t) <= 2 * near_) return &s;
            const double gap = std::max({s.in.t, -s.out.t, 0.0});
            if (gap <= least && !(s.out.t <= 0 && begins_on(s.out))) best = &s, least = gap;
        }
        return best;
    }

    // The next stretch that the ray comes to, its first one if it begins within rounding of it. One that it may just have
    // left, as it is over within rounding, is passed by. `outside`: it cannot be inside of the solid; if it may, that
    // stretch counts, too, and its way in lies behind.
    const Stretch* entry(bool outside, bool left) const {
        std::size_t first = 0;
        for (std::size_t k = 0; k < stretches_.size(); ++k)
            if (begins_on(stretches_[k].out) && std::abs(stretches_[k].out.t) <= 2 * near_) first = k + 1;
        for (const Stretch& s : stretches_.subspan(first)) {
            if (s.out.t <= (left ? 2 * near_ : 0)) continue;
            if (s.in.t > 0) return &s;
            const bool near_in = -s.in.t <= near_ && !begins_on(s.in), near_out = s.out.t <= near_;
            if (near_in && (!near_out || -s.in.t <= s.out.t)) return &s;
            if (!near_out && !outside) return &s;
        }
        return nullptr;
    }

    bool is_inside(const Stretch& s) const { return s.in.t < -near_; }

  private:
    bool begins_on(const Crossing<double>& crossing) const {
        return crossing.leaf == from_.leaf && crossing.face == from_.face;
    }

    std::span<const Stretch> stretches_;
    const Departure& from_;
    double near_;
};

Crossing<double> no_crossing() { return {infinity<double>, 0, 0, 0, false, false}; }

}  // namespace

template <class T, class Observer>
Crossing<Wide<T>> crossing_from_inside(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray,
                                       const Departure& from, const Asking<T>& asking, Observer observer) {
    if (is_convex(geometry, primitive)) return exit_crossing(geometry, primitive.root, 0, ray.wide);
    const double rounding = rounding_of(primitive, ray.wide), near = 4 * rounding / length(ray.wide.direction);
    const Crossing<double> natural = first_crossing(geometry, primitive, ray, asking, observer);
    if (natural.hit && !natural.entering && natural.t > 2 * near) return natural;
    const std::vector<Stretch> stretches = stretches_of(geometry, primitive, ray.wide);
    if (const Stretch* found = NextCrossing(stretches, from, near).exit()) return ahead(found->out);
    return forced_exit(geometry, primitive, ray.wide, rounding);
}

template <class T, class Observer>
Crossing<Wide<T>> crossing_from_outside(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray,
                                        const Departure& from, bool left, const Asking<T>& asking, Observer observer) {
    const double rounding = rounding_of(primitive, ray.wide), near = 4 * rounding / length(ray.wide.direction);
    const Crossing<double> natural = first_crossing(geometry, primitive, ray, asking, observer);
    if (!natural.hit || (natural.entering && !(left && natural.t <= 2 * near))) return natural;
    const std::vector<Stretch> stretches = stretches_of(geometry, primitive, ray.wide);
    const bool outside = left || std::abs(depth_of(geometry, primitive, ray.wide.origin)) <= rounding;
    const NextCrossing next(stretches, from, near);
    const Stretch* found = next.entry(outside, left);
    if (!found) return no_crossing();
    return !outside && next.is_inside(*found) ? found->out : ahead(found->in);
}

double depth_of(const Geometry& geometry, const Primitive& primitive, const Vec3d& p) {
    if (primitive.is_csg) return csg_depth(geometry, primitive.root, p);
    const Leaf& leaf = geometry.leaves[primitive.root];
    if (leaf.kind != LeafKind::mesh) return leaf_depth(geometry, leaf, p);
    return mesh_distance(geometry, leaf, p) * (mesh_contains(geometry, primitive, p) ? 1 : -1);
}

bool contains(const Geometry& geometry, const Primitive& primitive, const Vec3d& p) {
    if (is_mesh(geometry, primitive)) return mesh_contains(geometry, primitive, p);
    return depth_of(geometry, primitive, p) >= 0;
}

#define RAYBOUND_INSTANTIATE(T, Observer)                                                                             \
    template Crossing<double> crossing_from_inside(const Geometry&, const Primitive&, const WideRay<T>&,              \
                                                   const Departure&, const Asking<T>&, Observer);                     \
    template Crossing<double> crossing_from_outside(const Geometry&, const Primitive&, const WideRay<T>&,             \
                                                    const Departure&, bool, const Asking<T>&, Observer);
RAYBOUND_INSTANTIATE(float, Unseen)
RAYBOUND_INSTANTIATE(double, Unseen)
RAYBOUND_INSTANTIATE(float, Counted)
RAYBOUND_INSTANTIATE(double, Counted)
#undef RAYBOUND_INSTANTIATE

}  // namespace raybound
