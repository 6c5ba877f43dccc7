// CSG for eight rays: the leaves side by side, what the expression makes of their parts ray by ray.
#pragma once

#include <optional>
#include <vector>

#include "raybound/shapes/csg.h"
#include "raybound/shapes/lanes.h"

namespace raybound {

// The first crossing of an expression by one ray, and the bound of its t's error.
struct CsgCrossing {
    Boundary<double> boundary;
    bool entering;
};

class CsgPack {
  public:
    // For a set of lanes of the rays, which must stay where they are.
    CsgPack(const Geometry& geometry, std::uint32_t root, const Ray<Pack<double>>& rays, std::uint32_t lanes);

    // Those that may meet the expression: some leaf of a union, all of an intersection.
    std::uint32_t lanes() const { return lanes_; }

    std::optional<CsgCrossing> first_crossing(int lane) const;

    // What CsgEvaluation asks, for one lane.
    struct Lane {
        const CsgPack& pack;
        int lane;

        template <class Visit>
        void visit(const CsgNode& node, const Visit& visit) const {
            pack.visit_leaf(node, lane, visit);
        }
    };

  private:
    using W = Pack<double>;

    // A leaf's part of each line; quadrics, which may have two, are asked ray by ray.
    struct Part {
        std::uint32_t leaf;
        std::uint32_t hit = 0, in_ahead = 0, out_ahead = 0;
        Span<W> span;
        W in_error, out_error;
    };

    std::uint32_t meet(std::uint32_t node, std::uint32_t lanes);
    std::uint32_t meet_leaf(std::uint32_t leaf, std::uint32_t lanes);
    W errors(const Leaf& leaf, const Index<W>& face, const W& t, std::uint32_t lanes) const;

    template <class Visit>
    void visit_leaf(const CsgNode& node, int lane, const Visit& visit) const;

    const Geometry& geometry_;
    const Ray<W>& rays_;
    std::uint32_t root_, lanes_;
    std::vector<Part> parts_;
};

template <class Visit>
void CsgPack::visit_leaf(const CsgNode& node, int lane, const Visit& visit) const {
    const Part* part = nullptr;
    for (const Part& candidate : parts_)
        if (candidate.leaf == node.first) part = &candidate;
    if (!part) {
        const Ray<double> ray = lane_of(rays_, lane);
        return LeafSpans<double>(geometry_, ray).visit(node, visit);
    }
    if (!(part->hit >> lane & 1)) return;
    const Span<W>& s = part->span;
    visit(Span<double>{s.t_in[lane], s.t_out[lane], int(s.face_in.v[lane]), int(s.face_out.v[lane]), true,
                       bool(part->in_ahead >> lane & 1), bool(part->out_ahead >> lane & 1)},
          part->in_error[lane], part->out_error[lane]);
}

}  // namespace raybound
