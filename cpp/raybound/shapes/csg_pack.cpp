#include "raybound/shapes/csg_pack.h"

namespace raybound {

namespace {

using W = CsgPack::W;

std::uint32_t any_ahead(const Interval<W>& interval) { return bits(interval.in.ahead | interval.out.ahead); }

}  // namespace

CsgPack::Arrays& CsgPack::arrays_of_this_thread() {
    thread_local Arrays arrays;
    return arrays;
}

CsgPack::CsgPack(const Geometry& geometry, const Ray<W>& rays)
    : geometry_(geometry),
      rays_(rays),
      parts_(arrays_of_this_thread().parts),
      stack_(arrays_of_this_thread().stack),
      intervals_(arrays_of_this_thread().intervals) {
    parts_.clear();
    stack_.clear();
    intervals_.clear();
}

// Every boundary of an expression is one of a leaf: where none of these is ahead, none is.
CsgPack::FirstBoundary CsgPack::first_boundary(std::uint32_t root, std::uint32_t lanes) {
    FirstBoundary first;
    if (geometry_.is_high(root)) {
        ask_one_by_one(root, lanes, first);
        return first;
    }
    lanes = meet(root, lanes) & ahead_;
    if (lanes == 0) return first;
    const Part part = evaluate(root, lanes, true);
    if (part.hit != 0) {
        const Interval<W>& interval = intervals_[part.interval];
        first.boundary = select(interval.in.ahead, interval.in, interval.out);
        first.hit = part.hit & any_ahead(interval);
        first.entering = first.hit & bits(interval.in.ahead);
    }
    ask_one_by_one(root, part.several & lanes, first);
    return first;
}

void CsgPack::ask_one_by_one(std::uint32_t root, std::uint32_t lanes, FirstBoundary& first) const {
    first.hit &= ~lanes;
    first.entering &= ~lanes;
    for_each_lane(lanes, [&](int lane) {
        const Ray<double> ray = lane_of(rays_, lane);
        CsgEvaluation<double> evaluation(geometry_, ray);
        evaluation.evaluate(root);
        bool entering = false;
        const Boundary<double>* boundary = evaluation.first_ahead(entering);
        if (!boundary) return;
        set_lane(first.boundary.t, lane, boundary->t);
        first.boundary.node.v[lane] = boundary->node;
        first.boundary.face.v[lane] = boundary->face;
        first.hit |= 1u << lane;
        first.entering |= std::uint32_t(entering) << lane;
    });
}

// The lanes that may meet a node, and the parts of its leaves.
std::uint32_t CsgPack::meet(std::uint32_t index, std::uint32_t lanes) {
    const CsgNode& node = geometry_.csg_nodes[index];
    const std::size_t begin = parts_.size();
    const std::uint32_t met = node.kind == CsgKind::leaf ? meet_leaf(index, lanes) : meet_children(node, lanes);
    if (met != 0) return met;
    parts_.resize(begin);
    parts_.push_back({.node = index});
    return 0;
}

// Some child of a union, all of an intersection, the first of a difference. (Lanes that meet a difference have several
// intervals, mostly: they are asked one by one.)
std::uint32_t CsgPack::meet_children(const CsgNode& node, std::uint32_t lanes) {
    if (node.kind == CsgKind::csg_difference) return meet_first(node, lanes);
    const bool is_union = node.kind == CsgKind::csg_union;
    std::uint32_t met = is_union ? 0 : lanes;
    for (std::uint32_t i = 0; i < node.count && (is_union || met != 0); ++i) {
        const std::uint32_t child = geometry_.csg_children[node.first + i];
        met = is_union ? met | meet(child, lanes) : meet(child, met);
    }
    return met;
}

std::uint32_t CsgPack::meet_first(const CsgNode& node, std::uint32_t lanes) {
    const std::size_t begin = parts_.size();
    const std::uint32_t met = meet(geometry_.csg_children[node.first], lanes),
                        index = std::uint32_t(&node - geometry_.csg_nodes.data());
    parts_.resize(begin);
    if (met == 0) return 0;
    parts_.push_back({.node = index, .several = met});
    ahead_ |= met;
    return met;
}

// Quadrics may have two intervals.
std::uint32_t CsgPack::meet_leaf(std::uint32_t index, std::uint32_t lanes) {
    const Leaf& leaf = geometry_.leaves[geometry_.csg_nodes[index].first];
    if (leaf.kind == LeafKind::quadric) {
        parts_.push_back({.node = index, .several = lanes});
        ahead_ |= lanes;
        return lanes;
    }
    const Span<W> span = leaf_span(geometry_, leaf, rays_);
    const std::uint32_t hit = lanes & bits(span.hit);
    if (hit == 0) return 0;
    parts_.push_back({.node = index, .hit = hit, .interval = add_interval(interval_of(span, index, W(0), W(0)))});
    ahead_ |= hit & bits(span.in_ahead | span.out_ahead);
    return hit;
}

std::uint32_t CsgPack::add_interval(const Interval<W>& interval) {
    intervals_.push_back(interval);
    return std::uint32_t(intervals_.size() - 1);
}

// Lanes may have boundaries of different faces: those of one face at a time.
W CsgPack::errors(const Boundary<W>& boundary, std::uint32_t lanes) const {
    W result;
    while (lanes != 0) {
        const int lane = std::countr_zero(lanes), index = boundary.node[lane], face = boundary.face[lane];
        const PackMask<double> same = (boundary.node == Index<W>(index)) & (boundary.face == Index<W>(face));
        const std::uint32_t found = lanes & bits(same);
        const Leaf& leaf = geometry_.leaves[geometry_.csg_nodes[std::size_t(index)].first];
        result = select(lanes_of<double>(found), boundary_error(geometry_, leaf, face, boundary.t, rays_), result);
        lanes &= ~found;
    }
    return result;
}

// At the root one interval is enough that has a boundary ahead, and those before it are not needed.
CsgPack::Part CsgPack::evaluate(std::uint32_t index, std::uint32_t lanes, bool is_root) {
    const CsgNode& node = geometry_.csg_nodes[index];
    if (parts_[next_].node == index) {
        Part part = parts_[next_++];
        part.hit &= lanes;
        return part;
    }
    return node.kind == CsgKind::csg_union ? unite(node, lanes, is_root) : intersect(node, lanes, is_root);
}

CsgPack::Part CsgPack::unite(const CsgNode& node, std::uint32_t lanes, bool is_root) {
    const std::size_t begin = stack_.size();
    std::uint32_t several = 0;
    for (std::uint32_t i = 0; i < node.count; ++i) {
        const Part part = evaluate(geometry_.csg_children[node.first + i], lanes, false);
        several |= part.several;
        if (part.hit != 0) stack_.push_back(part);
    }
    Part all = merge(begin, lanes & ~several, is_root);
    all.several |= several;
    stack_.resize(begin);
    return all;
}

// The children's intervals in order, lane by lane the one that is next. Errors can only tell where there is a gap, and
// at the root only if something there is ahead.
CsgPack::Part CsgPack::merge(std::size_t begin, std::uint32_t lanes, bool is_root) {
    Interval<W> all, next;
    Part merged;
    merged.hit = take_next(begin, lanes, all);
    std::uint32_t open = is_root ? merged.hit & ~bits(all.in.ahead) : merged.hit;
    while (open != 0) {
        const std::uint32_t more = take_next(begin, open, next);
        if (more == 0) break;
        std::uint32_t unsure = more & bits(next.in.t > all.out.t);
        if (is_root) unsure &= bits(next.in.ahead | all.out.ahead);
        next.in.error = errors(next.in, unsure);
        all.out.error = errors(all.out, unsure);
        const std::uint32_t touching = more & bits(touches(all, next)), apart = more & ~touching;
        all.out = select(lanes_of<double>(touching), united_out(all, next), all.out);
        open = touching;
        if (!is_root) {
            merged.several |= apart;
        } else if (apart != 0) {
            const std::uint32_t passed = apart & ~bits(all.out.ahead);
            all = select(lanes_of<double>(passed), next, all);
            open |= passed;
            open &= ~bits(all.in.ahead);
        }
    }
    merged.interval = add_interval(all);
    return merged;
}

// Takes the first interval of each lane out of the stack's.
std::uint32_t CsgPack::take_next(std::size_t begin, std::uint32_t lanes, Interval<W>& first) {
    std::uint32_t found = 0;
    for (std::size_t i = begin; i < stack_.size(); ++i) {
        const Interval<W>& interval = intervals_[stack_[i].interval];
        const std::uint32_t present = stack_[i].hit & lanes;
        if (present == 0) continue;
        const PackMask<double> before =
            lanes_of<double>(present) & (lanes_of<double>(~found) | begins_before(interval, first));
        first = found == 0 ? interval : select(before, interval, first);
        found |= present;
    }
    for (std::size_t i = begin; i < stack_.size(); ++i)
        stack_[i].hit &= ~(found & bits(intervals_[stack_[i].interval].in.node == first.in.node));
    return found;
}

// First without errors, which can only make it less: most lanes end there.
CsgPack::Part CsgPack::intersect(const CsgNode& node, std::uint32_t lanes, bool is_root) {
    const std::size_t begin = stack_.size();
    Part all = evaluate(geometry_.csg_children[node.first], lanes, false);
    stack_.push_back(all);
    for (std::uint32_t i = 1; i < node.count; ++i) {
        const Part child = evaluate(geometry_.csg_children[node.first + i], lanes, false);
        stack_.push_back(child);
        all.several |= child.several;
        all.hit &= child.hit;
    }
    all.hit &= ~all.several;
    if (all.hit != 0) {
        const std::span<const Part> children(stack_.begin() + std::ptrdiff_t(begin), stack_.end());
        Interval<W> common = intervals_[children[0].interval];
        for (const Part& child : children.subspan(1)) common = overlap(common, intervals_[child.interval]);
        all.hit &= bits(common.in.t < common.out.t);
        if (is_root) all.hit &= any_ahead(common);
        if (all.hit != 0) all.interval = add_interval(thick_overlap(children, all.hit));
    }
    stack_.resize(begin);
    return all;
}

Interval<W> CsgPack::thick_overlap(std::span<const Part> children, std::uint32_t& lanes) const {
    Interval<W> common = intervals_[children[0].interval];
    for (const Part& child : children.subspan(1)) {
        common = overlap(common, intervals_[child.interval]);
        common.in.error = errors(common.in, lanes);
        common.out.error = errors(common.out, lanes);
        lanes &= bits(is_thick(common));
    }
    return common;
}

}  // namespace raybound
