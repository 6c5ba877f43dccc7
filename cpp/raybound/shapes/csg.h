// CSG by intervals along the ray (Roth 1982; thesis 4.2.3): each leaf gives the part of the line inside it, unions
// merge and intersections cut these parts, and the first boundary ahead is the hit. A union so has no inner walls.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory_resource>
#include <vector>

#include "raybound/shapes/boundary.h"

namespace raybound {

template <class T>
struct Boundary {
    T t, error;  // error: bounds |t - exact|, for telling coincident faces
    std::uint32_t node;
    std::int32_t face;
    Mask<T> ahead;
};

template <class T>
struct Interval {
    Boundary<T> in, out;
};

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
template <class T, class Spans = LeafSpans<T>>
class CsgEvaluation {
  public:
    CsgEvaluation(const Geometry& geometry, const Spans& spans) : geometry_(geometry), spans_(spans) {
        stack_.reserve(32);
    }
    CsgEvaluation(const CsgEvaluation&) = delete;
    CsgEvaluation& operator=(const CsgEvaluation&) = delete;

    std::span<const Interval<T>> intervals() const { return stack_; }

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

    void evaluate(std::uint32_t index) {
        const CsgNode& node = geometry_.csg_nodes[index];
        switch (node.kind) {
            case CsgKind::leaf:
                return push_leaf(index, node);
            case CsgKind::csg_union:
                return unite(node);
            case CsgKind::csg_intersection:
                return intersect(node);
        }
    }

  private:
    void push_leaf(std::uint32_t index, const CsgNode& node) {
        spans_.visit(node, [&](const Span<T>& span, const T& in_error, const T& out_error) {
            stack_.push_back({{span.t_in, in_error, index, span.face_in, span.in_ahead},
                              {span.t_out, out_error, index, span.face_out, span.out_ahead}});
        });
    }

    std::uint32_t child(const CsgNode& node, std::uint32_t i) const { return geometry_.csg_children[node.first + i]; }

    // Sorted by entry, intervals that touch within their errors become one: no seam where faces coincide.
    void unite(const CsgNode& node) {
        const std::size_t begin = stack_.size();
        for (std::uint32_t i = 0; i < node.count; ++i) evaluate(child(node, i));
        const auto first = stack_.begin() + std::ptrdiff_t(begin);
        std::sort(first, stack_.end(), [](const auto& a, const auto& b) {
            return std::pair(a.in.t, a.in.node) < std::pair(b.in.t, b.in.node);  // equal entries: the earlier part
        });
        std::size_t last = begin;
        for (std::size_t i = begin + 1; i < stack_.size(); ++i) {
            if (stack_[i].in.t - stack_[i].in.error <= stack_[last].out.t + stack_[last].out.error) {
                if (stack_[i].out.t > stack_[last].out.t) stack_[last].out = stack_[i].out;
            } else {
                stack_[++last] = stack_[i];
            }
        }
        if (stack_.size() > begin) stack_.resize(last + 1);
    }

    // Pairwise overlaps of two sorted lists; one thinner than its errors is nothing.
    void intersect(const CsgNode& node) {
        const std::size_t begin = stack_.size();
        evaluate(child(node, 0));
        for (std::uint32_t i = 1; i < node.count && stack_.size() > begin; ++i) {
            const std::size_t middle = stack_.size();
            evaluate(child(node, i));
            const std::size_t end = stack_.size();
            std::size_t a = begin, b = middle;
            while (a < middle && b < end) {
                const Interval<T> x = stack_[a], y = stack_[b];
                const Interval<T> both{y.in.t > x.in.t ? y.in : x.in, y.out.t < x.out.t ? y.out : x.out};
                if (both.out.t - both.in.t > both.in.error + both.out.error) stack_.push_back(both);
                ++(x.out.t < y.out.t ? a : b);
            }
            stack_.erase(stack_.begin() + std::ptrdiff_t(begin), stack_.begin() + std::ptrdiff_t(end));
        }
    }

    const Geometry& geometry_;
    const Spans& spans_;
    // Most expressions fit in the buffer: no allocation on the way of a ray.
    alignas(Interval<T>) std::array<std::byte, 64 * sizeof(Interval<T>)> buffer_;
    std::pmr::monotonic_buffer_resource memory_{buffer_.data(), buffer_.size()};
    std::pmr::vector<Interval<T>> stack_{&memory_};
};

}  // namespace raybound
