#include "raybound/shapes/forced_exit.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "raybound/shapes/closest.h"
#include "raybound/shapes/depth.h"
#include "raybound/shapes/mesh_hit.h"

namespace raybound {

namespace {

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
            exits_.push_back(node.kind != CsgKind::leaf    ? leave_node(node, complement_[index - begin_])
                             : complement_[index - begin_] ? leave_complement(node)
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

}  // namespace

Crossing<double> exit_crossing(const Geometry& geometry, std::uint32_t leaf, std::int32_t face_offset,
                               const Ray<double>& ray) {
    const Exit<double> exit = leaf_exit(geometry, geometry.leaves[leaf], ray);
    return ahead({exit.t, leaf, exit.face, face_offset, true, false});
}

Crossing<double> forced_exit(const Geometry& geometry, const Primitive& primitive, const Ray<double>& ray,
                             double margin) {
    if (primitive.is_csg) return leave_csg(geometry, primitive, ray, margin);
    if (is_mesh(geometry, primitive)) return leave_mesh(geometry, primitive.root, ray);
    return exit_crossing(geometry, primitive.root, 0, ray);
}

}  // namespace raybound
