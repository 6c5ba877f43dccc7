// What whole lines have inside of closed primitives.
#include <algorithm>

#include "raybound/shapes/csg.h"
#include "raybound/shapes/inside.h"
#include "raybound/shapes/mesh_hit.h"

namespace raybound {

namespace {

Crossing<double> at_boundary(const Geometry& geometry, const Boundary<double>& boundary, bool entering) {
    const CsgNode& node = geometry.csg_nodes[std::size_t(boundary.node)];
    return {boundary.t, node.first, boundary.face, node.face_offset, true, entering};
}

std::vector<Stretch> csg_stretches(const Geometry& geometry, std::uint32_t root, const Ray<double>& ray) {
    CsgEvaluation<double> evaluation(geometry, ray);
    evaluation.evaluate(root);
    std::vector<Stretch> result;
    for (const Interval<double>& interval : evaluation.intervals())
        result.push_back({at_boundary(geometry, interval.in, true), at_boundary(geometry, interval.out, false)});
    return result;
}

Stretch stretch_of(std::uint32_t leaf, const Span<double>& span) {
    return {{span.t_in, leaf, span.face_in, 0, true, true}, {span.t_out, leaf, span.face_out, 0, true, false}};
}

std::vector<Stretch> leaf_stretches(const Geometry& geometry, std::uint32_t index, const Ray<double>& ray) {
    const Leaf& leaf = geometry.leaves[index];
    std::vector<Stretch> result;
    if (leaf.kind == LeafKind::quadric) {
        const Spans<double> spans = quadric_leaf_spans(geometry, leaf, ray);
        for (int i = 0; i < spans.count; ++i) result.push_back(stretch_of(index, spans.part[i]));
    } else if (const Span<double> span = leaf_span(geometry, leaf, ray); span.hit) {
        result.push_back(stretch_of(index, span));
    }
    return result;
}

// All faces that a line meets, ahead of its origin and behind, each once.
struct LineCrossings {
    std::vector<Crossing<double>> entries, exits;
};

void add_crossings(const Geometry& geometry, std::uint32_t index, const Ray<double>& ray, bool backward,
                   bool only_ahead, std::vector<Crossing<double>>& found) {
    const Leaf& leaf = geometry.leaves[index];
    const MeshData& mesh = *geometry.meshes[leaf.polygon].data;
    const MeshRay<float> line(geometry, leaf, backward ? Ray<double>{ray.origin, -ray.direction} : ray);
    float everywhere = infinity<float>;
    visit_packs(mesh, line, everywhere, false, [&](const TrianglePack& pack) {
        for (std::uint32_t lanes = may_cross(pack, line.packs, everywhere); lanes != 0;) {
            const auto face = std::int32_t(pack.id[std::size_t(bvh::take_lowest(lanes))]);
            const Piercing p = pierce_face(mesh.corners<double>(face), line.line);
            if (p.met && (!only_ahead || p.hit))
                found.push_back({backward ? -p.t : p.t, index, face, 0, true, p.entering != backward});
        }
    });
}

LineCrossings line_crossings(const Geometry& geometry, std::uint32_t index, const Ray<double>& ray) {
    std::vector<Crossing<double>> found;
    for (const bool backward : {false, true}) add_crossings(geometry, index, ray, backward, false, found);
    std::ranges::stable_sort(found, {}, &Crossing<double>::face);
    const auto same = std::ranges::unique(found, {}, &Crossing<double>::face);
    found.erase(same.begin(), same.end());
    std::ranges::stable_sort(found, {}, &Crossing<double>::t);
    LineCrossings line;
    for (const Crossing<double>& crossing : found) (crossing.entering ? line.entries : line.exits).push_back(crossing);
    return line;
}

// Entries and exits of a closed mesh alternate; rounding may swap those at an edge, so each kind is put in order by
// itself. Where a mesh passes through itself it is a union, without inner walls.
std::vector<Stretch> mesh_stretches(const Geometry& geometry, std::uint32_t index, const Ray<double>& ray) {
    const LineCrossings line = line_crossings(geometry, index, ray);
    const Leaf& leaf = geometry.leaves[index];
    const double reach =
        double(geometry.meshes[leaf.polygon].data->reach()) / length(mesh_line(geometry, leaf, ray).direction);
    std::vector<Stretch> result;
    for (std::size_t k = 0; k < std::min(line.entries.size(), line.exits.size()); ++k) {
        Stretch next{line.entries[k], line.exits[k]};
        next.out.t = std::max(next.in.t, next.out.t);
        const double rounding = 0x1p-20 * (std::abs(next.in.t) + reach);
        if (!result.empty() && next.in.t < result.back().out.t - rounding)
            result.back().out = next.out;
        else
            result.push_back(next);
    }
    return result;
}

}  // namespace

std::vector<Crossing<double>> mesh_crossings_ahead(const Geometry& geometry, std::uint32_t leaf,
                                                   const Ray<double>& ray) {
    std::vector<Crossing<double>> found;
    add_crossings(geometry, leaf, ray, false, true, found);
    std::ranges::stable_sort(found, {}, &Crossing<double>::t);
    return found;
}

std::vector<Stretch> stretches_of(const Geometry& geometry, const Primitive& primitive, const Ray<double>& ray) {
    if (primitive.is_csg) return csg_stretches(geometry, primitive.root, ray);
    if (geometry.leaves[primitive.root].kind == LeafKind::mesh) return mesh_stretches(geometry, primitive.root, ray);
    return leaf_stretches(geometry, primitive.root, ray);
}

}  // namespace raybound
