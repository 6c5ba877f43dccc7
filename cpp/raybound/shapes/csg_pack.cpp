#include "raybound/shapes/csg_pack.h"

namespace raybound {

CsgPack::CsgPack(const Geometry& geometry, std::uint32_t root, const Ray<W>& rays, std::uint32_t lanes)
    : geometry_(geometry), rays_(rays), root_(root), lanes_(0) {
    parts_.reserve(16);
    lanes_ = meet(root, lanes);
}

std::uint32_t CsgPack::meet(std::uint32_t index, std::uint32_t lanes) {
    const CsgNode& node = geometry_.csg_nodes[index];
    if (node.kind == CsgKind::leaf) return meet_leaf(node.first, lanes);
    const bool is_union = node.kind == CsgKind::csg_union;
    std::uint32_t met = is_union ? 0 : lanes;
    for (std::uint32_t i = 0; i < node.count && (is_union || met != 0); ++i) {
        const std::uint32_t child = geometry_.csg_children[node.first + i];
        met = is_union ? met | meet(child, lanes) : meet(child, met);
    }
    return met;
}

std::uint32_t CsgPack::meet_leaf(std::uint32_t index, std::uint32_t lanes) {
    const Leaf& leaf = geometry_.leaves[index];
    if (leaf.kind == LeafKind::quadric) return lanes;
    Part& part = parts_.emplace_back();
    part.leaf = index;
    part.span = leaf_span(geometry_, leaf, rays_);
    part.hit = bits(part.span.hit);
    if ((part.hit & lanes) == 0) return 0;
    part.in_ahead = bits(part.span.in_ahead);
    part.out_ahead = bits(part.span.out_ahead);
    part.in_error = errors(leaf, part.span.face_in, part.span.t_in, part.hit);
    part.out_error = errors(leaf, part.span.face_out, part.span.t_out, part.hit);
    return part.hit & lanes;
}

// Lanes may cross different faces: those of one face at a time.
Pack<double> CsgPack::errors(const Leaf& leaf, const Index<W>& face, const W& t, std::uint32_t lanes) const {
    W result;
    while (lanes != 0) {
        const auto number = face.v[std::countr_zero(lanes)];
        const auto same = PackMask<double>{face.v == number};
        result = select(same, boundary_error(geometry_, leaf, int(number), t, rays_), result);
        lanes &= ~bits(same);
    }
    return result;
}

std::optional<CsgCrossing> CsgPack::first_crossing(int lane) const {
    const Lane spans{*this, lane};
    CsgEvaluation<double, Lane> evaluation(geometry_, spans);
    evaluation.evaluate(root_);
    bool entering = false;
    if (const Boundary<double>* first = evaluation.first_ahead(entering)) return CsgCrossing{*first, entering};
    return std::nullopt;
}

}  // namespace raybound
