// CSG for eight rays: leaves and intervals side by side, by the rules of csg.h. A lane for which a part of the
// expression has several intervals, where only one is kept, is asked as a ray of its own; so are all
// lanes for an expression that is too high to recurse into.
#pragma once

#include "raybound/shapes/csg.h"
#include "raybound/shapes/lanes.h"

namespace raybound {

class CsgPack {
  public:
    using W = Pack<double>;

    // The rays must stay where they are.
    CsgPack(const Geometry& geometry, const Ray<W>& rays);
    CsgPack(const CsgPack&) = delete;
    CsgPack& operator=(const CsgPack&) = delete;

    // The first boundary ahead of each lane of `hit`; its error is not filled in.
    struct FirstBoundary {
        Boundary<W> boundary;
        std::uint32_t hit = 0, entering = 0;
    };
    FirstBoundary first_boundary(std::uint32_t root, std::uint32_t lanes);

    // The errors of boundaries, for a set of lanes; zero elsewhere.
    W errors(const Boundary<W>& boundary, std::uint32_t lanes) const;

  private:
    // What the lines have inside a node: one interval in each lane of `hit`; those of `several` may have more.
    // Errors are filled in where something depends on them.
    struct Part {
        std::uint32_t node = 0, hit = 0, several = 0;
        std::uint32_t interval = 0;  // of intervals_
    };

    // Kept for the next rays: no allocation on their way.
    struct Arrays {
        std::vector<Part> parts, stack;
        std::vector<Interval<W>> intervals;
    };
    static Arrays& arrays_of_this_thread();

    std::uint32_t meet(std::uint32_t index, std::uint32_t lanes);
    std::uint32_t meet_leaf(std::uint32_t index, std::uint32_t lanes);
    std::uint32_t meet_first(const CsgNode& node, std::uint32_t lanes);
    std::uint32_t meet_children(const CsgNode& node, std::uint32_t lanes);

    Part evaluate(std::uint32_t index, std::uint32_t lanes, bool is_root);
    Part unite(const CsgNode& node, std::uint32_t lanes, bool is_root);
    std::uint32_t add_interval(const Interval<W>& interval);
    Part merge(std::size_t begin, std::uint32_t lanes, bool is_root);
    std::uint32_t take_next(std::size_t begin, std::uint32_t lanes, Interval<W>& first);
    Part intersect(const CsgNode& node, std::uint32_t lanes, bool is_root);
    Interval<W> thick_overlap(std::span<const Part> children, std::uint32_t& lanes) const;
    void ask_one_by_one(std::uint32_t root, std::uint32_t lanes, FirstBoundary& first) const;

    const Geometry& geometry_;
    const Ray<W>& rays_;
    std::vector<Part>& parts_;  // met, in the order of the expression; a node that no lane meets is one part
    std::vector<Part>& stack_;  // of children
    std::vector<Interval<W>>& intervals_;
    std::size_t next_ = 0;     // of parts_
    std::uint32_t ahead_ = 0;  // lanes with some leaf's boundary ahead
};

}  // namespace raybound
