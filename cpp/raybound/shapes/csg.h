// CSG by intervals along the ray (Roth 1982; thesis 4.2.3): each leaf gives the part of the line inside it, unions
// merge and intersections cut these parts, and the first boundary ahead is the hit. A union so has no inner walls.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

#include "raybound/shapes/boundary.h"

namespace raybound {

template <class T>
struct Boundary {
    T t, error;  // error: bounds |t - exact|, for telling coincident faces
    Index<T> node, face;
    Mask<T> ahead;
};

template <class T>
inline Boundary<T> select(Mask<T> mask, const Boundary<T>& yes, const Boundary<T>& no) {
    if constexpr (std::is_same_v<Mask<T>, bool>)
        return mask ? yes : no;
    else
        return {select(mask, yes.t, no.t), select(mask, yes.error, no.error), select(mask, yes.node, no.node),
                select(mask, yes.face, no.face), select(mask, yes.ahead, no.ahead)};
}

template <class T>
struct Interval {
    Boundary<T> in, out;
};

template <class T>
inline Interval<T> select(Mask<T> mask, const Interval<T>& yes, const Interval<T>& no) {
    return {select(mask, yes.in, no.in), select(mask, yes.out, no.out)};
}

template <class T>
inline Interval<T> interval_of(const Span<T>& span, std::uint32_t node, const T& in_error, const T& out_error) {
    return {{span.t_in, in_error, int(node), span.face_in, span.in_ahead},
            {span.t_out, out_error, int(node), span.face_out, span.out_ahead}};
}

// The order of intervals; of those that begin at the same t the earlier part is first.
template <class T>
inline Mask<T> begins_before(const Interval<T>& a, const Interval<T>& b) {
    return (a.in.t < b.in.t) | ((a.in.t == b.in.t) & (a.in.node < b.in.node));
}

// Intervals in order that touch within their errors become one: no seam where faces coincide.
template <class T>
inline Mask<T> touches(const Interval<T>& a, const Interval<T>& b) {
    return b.in.t - b.in.error <= a.out.t + a.out.error;
}
template <class T>
inline Boundary<T> united_out(const Interval<T>& a, const Interval<T>& b) {
    return select(Mask<T>(b.out.t > a.out.t), b.out, a.out);
}

// What two intervals have in common: nothing if it is thinner than its errors.
template <class T>
inline Interval<T> overlap(const Interval<T>& a, const Interval<T>& b) {
    return {select(Mask<T>(b.in.t > a.in.t), b.in, a.in), select(Mask<T>(b.out.t < a.out.t), b.out, a.out)};
}
template <class T>
inline Mask<T> is_thick(const Interval<T>& a) {
    return a.out.t - a.in.t > a.in.error + a.out.error;
}

// What a line has inside of each leaf of an expression, with the errors of its ends: found when it is asked for.
template <class T>
class LeafSpans {
  public:
    LeafSpans(const Geometry& geometry, const Ray<T>& ray) : geometry_(geometry), ray_(ray) {}

    // Calls visit(span, error of t_in, error of t_out) for each part.
    template <class Visit>
    void visit(const CsgNode& node, const Visit& visit) const {
        const Leaf& leaf = geometry_.leaves[node.first];
        if (leaf.kind == LeafKind::quadric) {
            const Spans<T> spans = quadric_leaf_spans(geometry_, leaf, ray_);
            for (int i = 0; i < spans.count; ++i) visit_one(leaf, spans.part[i], visit);
        } else if (const Span<T> span = leaf_span(geometry_, leaf, ray_); span.hit) {
            visit_one(leaf, span, visit);
        }
    }

  private:
    template <class Visit>
    void visit_one(const Leaf& leaf, const Span<T>& span, const Visit& visit) const {
        visit(span, boundary_error(geometry_, leaf, span.face_in, span.t_in, ray_),
              boundary_error(geometry_, leaf, span.face_out, span.t_out, ray_));
    }

    const Geometry& geometry_;
    const Ray<T>& ray_;
};

// The intervals of an expression along a ray, in order of t.
template <class T>
class CsgEvaluation {
  public:
    CsgEvaluation(const Geometry& geometry, const Ray<T>& ray) : geometry_(geometry), spans_(geometry, ray) {
        stack_.reserve(32);
    }
    CsgEvaluation(const CsgEvaluation&) = delete;
    CsgEvaluation& operator=(const CsgEvaluation&) = delete;

    // The first boundary ahead, if there is one, and whether it is an entry.
    const Boundary<T>* first_ahead(bool& entering) const {
        for (const Interval<T>& interval : stack_)
            for (const Boundary<T>* boundary : {&interval.in, &interval.out})
                if (boundary->ahead) {
                    entering = boundary == &interval.in;
                    return boundary;
                }
        return nullptr;
    }

    // All of them, on the whole line, once evaluated.
    std::span<const Interval<T>> intervals() const { return stack_; }

    void evaluate(std::uint32_t root) {
        if (geometry_.is_high(root))
            walk(root);
        else
            recurse(root);
    }

  private:
    struct Open {
        std::uint32_t node, next;  // child
        std::size_t begin, middle;
    };

    // (Recursion is faster; high expressions would fill the stack.)
    void recurse(std::uint32_t index) {
        const CsgNode& node = geometry_.csg_nodes[index];
        if (node.kind == CsgKind::leaf) return push_leaf(index, node);
        const std::size_t begin = stack_.size();
        const bool cuts = node.kind != CsgKind::csg_union;
        for (std::uint32_t i = 0; i < node.count && !(cuts && i > 0 && stack_.size() == begin); ++i) {
            const std::size_t middle = stack_.size();
            recurse(geometry_.csg_children[node.first + i]);
            if (cuts && i > 0) cut(node.kind, begin, middle);
        }
        if (!cuts) unite(begin);
    }

    // Each operation once for each child that has been evaluated: on the stack then is what the child has, from
    // `middle` on, after what those before it have left. What cuts is done when nothing is left.
    void walk(std::uint32_t root) {
        enter(root);
        while (!open_.empty()) {
            Open& at = open_.back();
            const CsgNode& node = geometry_.csg_nodes[at.node];
            const bool cuts = node.kind != CsgKind::csg_union;
            if (cuts && at.next > 1) cut(node.kind, at.begin, at.middle);
            const bool is_done = cuts && at.next > 0 && stack_.size() == at.begin;
            if (at.next < node.count && !is_done) {
                at.middle = stack_.size();
                enter(geometry_.csg_children[node.first + at.next++]);
                continue;
            }
            if (!cuts) unite(at.begin);
            open_.pop_back();
        }
    }

    void enter(std::uint32_t index) {
        const CsgNode& node = geometry_.csg_nodes[index];
        if (node.kind == CsgKind::leaf)
            push_leaf(index, node);
        else
            open_.push_back({index, 0, stack_.size(), stack_.size()});
    }

    void push_leaf(std::uint32_t index, const CsgNode& node) {
        spans_.visit(node, [&](const Span<T>& span, const T& in_error, const T& out_error) {
            stack_.push_back(interval_of(span, index, in_error, out_error));
        });
    }

    // What begins at `begin`, merged.
    [[gnu::noinline]] void unite(std::size_t begin) {
        const auto first = stack_.begin() + std::ptrdiff_t(begin);
        std::sort(first, stack_.end(), [](const auto& a, const auto& b) { return begins_before(a, b); });
        std::size_t last = begin;
        for (std::size_t i = begin + 1; i < stack_.size(); ++i) {
            if (touches(stack_[last], stack_[i])) {
                stack_[last].out = united_out(stack_[last], stack_[i]);
            } else {
                stack_[++last] = stack_[i];
            }
        }
        if (stack_.size() > begin) stack_.resize(last + 1);
    }

    // Pairwise overlaps of two sorted lists, one from `begin`, one from `middle`. (Not inlined, as the others, so that
    // the recursion stays small.)
    [[gnu::noinline]] void intersect(std::size_t begin, std::size_t middle) {
        const std::size_t end = stack_.size();
        std::size_t a = begin, b = middle;
        while (a < middle && b < end) {
            const Interval<T> x = stack_[a], y = stack_[b];
            const Interval<T> both = overlap(x, y);
            if (is_thick(both)) stack_.push_back(both);
            ++(x.out.t < y.out.t ? a : b);
        }
        stack_.erase(stack_.begin() + std::ptrdiff_t(begin), stack_.begin() + std::ptrdiff_t(end));
    }

    // What is there from `begin` without what is there from `middle`. What is left of an interval, thinner than its
    // errors, is nothing: no skin stays where faces coincide.
    [[gnu::noinline]] void subtract(std::size_t begin, std::size_t middle) {
        const std::size_t end = stack_.size();
        for (std::size_t a = begin; a < middle; ++a) {
            Interval<T> rest = stack_[a];
            for (std::size_t b = middle; b < end; ++b) {
                const Interval<T> away = stack_[b];
                const Interval<T> before{rest.in, away.in}, after{away.out, rest.out};
                if (!(away.in.t < rest.out.t) || !(away.out.t > rest.in.t)) continue;
                if (is_thick(before)) stack_.push_back(before);
                rest = after;
            }
            if (is_thick(rest)) stack_.push_back(rest);
        }
        stack_.erase(stack_.begin() + std::ptrdiff_t(begin), stack_.begin() + std::ptrdiff_t(end));
    }

    void cut(CsgKind operation, std::size_t begin, std::size_t middle) {
        if (operation == CsgKind::csg_intersection)
            intersect(begin, middle);
        else
            subtract(begin, middle);
    }

    const Geometry& geometry_;
    const LeafSpans<T> spans_;
    // Most expressions fit in the buffer: no allocation on the way of a ray.
    alignas(Interval<T>) std::array<std::byte, 64 * sizeof(Interval<T>)> buffer_;
    std::pmr::monotonic_buffer_resource memory_{buffer_.data(), buffer_.size()};
    std::pmr::vector<Interval<T>> stack_{&memory_};
    std::pmr::vector<Open> open_{&memory_};
};

}  // namespace raybound
