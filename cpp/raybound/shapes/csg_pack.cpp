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
    : geometry_(geometry), rays_(rays), parts_(arrays_of_this_thread().parts), stack_(arrays_of_this_thread().stack) {
    parts_.clear();
    stack_.clear();
}

// Every boundary of an expression is one of a leaf: where none of these is ahead, none is.
CsgPack::FirstBoundary CsgPack::first_boundary(std::uint32_t root, std::uint32_t lanes) {
    FirstBoundary first;
    lanes = meet(root, lanes) & ahead_;
    if (lanes == 0) return first;
    const Part part = evaluate(root, lanes, true);
    const Interval<W>& interval = part.interval;
    first.boundary = select(interval.in.ahead, interval.in, interval.out);
    first.hit = part.hit & any_ahead(interval);
    first.entering = first.hit & bits(interval.in.ahead);
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
    parts_.emplace_back().node = index;
    return 0;
}

// Some child of a union, all of an intersection.
std::uint32_t CsgPack::meet_children(const CsgNode& node, std::uint32_t lanes) {
    const bool is_union = node.kind == CsgKind::csg_union;
    std::uint32_t met = is_union ? 0 : lanes;
    for (std::uint32_t i = 0; i < node.count && (is_union || met != 0); ++i) {
        const std::uint32_t child = geometry_.csg_children[node.first + i];
        met = is_union ? met | meet(child, lanes) : meet(child, met);
    }
    return met;
}

// Quadrics may have two intervals.
std::uint32_t CsgPack::meet_leaf(std::uint32_t index, std::uint32_t lanes) {
    const Leaf& leaf = geometry_.leaves[geometry_.csg_nodes[index].first];
    Part& part = parts_.emplace_back();
    part.node = index;
    if (leaf.kind == LeafKind::quadric) {
        ahead_ |= lanes;
        return part.several = lanes;
    }
    const Span<W> span = leaf_span(geometry_, leaf, rays_);
    part.hit = lanes & bits(span.hit);
    if (part.hit == 0) return 0;
    part.interval = interval_of(span, index, W(0), W(0));
    ahead_ |= part.hit & any_ahead(part.interval);
    return part.hit;
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
    Part last = take_next(begin, lanes);
    Interval<W>& all = last.interval;
    std::uint32_t open = is_root ? last.hit & ~bits(all.in.ahead) : last.hit;
    while (open != 0) {
        Part next = take_next(begin, open);
        if (next.hit == 0) break;
        std::uint32_t unsure = next.hit & bits(next.interval.in.t > all.out.t);
        if (is_root) unsure &= bits(next.interval.in.ahead | all.out.ahead);
        next.interval.in.error = all.out.error = W(0);
        if (unsure != 0) {
            next.interval.in.error = errors(next.interval.in, unsure);
            all.out.error = errors(all.out, unsure);
        }
        const std::uint32_t touching = next.hit & bits(touches(all, next.interval)), apart = next.hit & ~touching;
        all.out = select(lanes_of<double>(touching), united_out(all, next.interval), all.out);
        open &= next.hit;
        if (!is_root) last.several |= apart;
        if (!is_root || apart == 0) {
            open &= ~apart;
            continue;
        }
        open &= ~(apart & bits(all.out.ahead));
        const PackMask<double> on = lanes_of<double>(apart & open);
        all = {select(on, next.interval.in, all.in), select(on, next.interval.out, all.out)};
        open &= ~bits(all.in.ahead);
    }
    return last;
}

// Takes the first interval of each lane out of the stack's.
CsgPack::Part CsgPack::take_next(std::size_t begin, std::uint32_t lanes) {
    Part first;
    for (std::size_t i = begin; i < stack_.size(); ++i) {
        const Part& part = stack_[i];
        const std::uint32_t present = part.hit & lanes;
        if (present == 0) continue;
        const PackMask<double> before =
            lanes_of<double>(present) & (lanes_of<double>(~first.hit) | begins_before(part.interval, first.interval));
        first.interval = {select(before, part.interval.in, first.interval.in),
                          select(before, part.interval.out, first.interval.out)};
        first.hit |= present;
    }
    for (std::size_t i = begin; i < stack_.size(); ++i)
        stack_[i].hit &= ~(first.hit & bits(stack_[i].interval.in.node == first.interval.in.node));
    return first;
}

// First without errors, which can only make it less: most lanes end there.
CsgPack::Part CsgPack::intersect(const CsgNode& node, std::uint32_t lanes, bool is_root) {
    const std::size_t begin = stack_.size();
    Part all = evaluate(geometry_.csg_children[node.first], lanes, false);
    stack_.push_back(all);
    for (std::uint32_t i = 1; i < node.count; ++i) {
        stack_.push_back(evaluate(geometry_.csg_children[node.first + i], lanes, false));
        const Part& child = stack_.back();
        all.several |= child.several;
        all.hit &= child.hit;
        all.interval = overlap(all.interval, child.interval);
    }
    all.hit &= bits(all.interval.in.t < all.interval.out.t) & ~all.several;
    if (is_root) all.hit &= any_ahead(all.interval);
    if (all.hit != 0) {
        all.interval = stack_[begin].interval;
        for (std::uint32_t i = 1; i < node.count && all.hit != 0; ++i) {
            all.interval = overlap(all.interval, stack_[begin + i].interval);
            all.interval.in.error = errors(all.interval.in, all.hit);
            all.interval.out.error = errors(all.interval.out, all.hit);
            all.hit &= bits(is_thick(all.interval));
        }
    }
    stack_.resize(begin);
    return all;
}

}  // namespace raybound
