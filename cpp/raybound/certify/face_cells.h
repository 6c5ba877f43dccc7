// The cells of one side of one piece of a face: the quadtree's way down, and how verdicts are found.
#pragma once

#include "raybound/certify/cells.h"

namespace raybound {

// How far cells are divided, and when they are not worth it.
// (TUNED on the museum and the SPD scenes: a list's test costs a ray about 10 ns, a shorter list for one more cell 1
// us.)
struct CellPolicy {
    std::uint32_t short_list = 12;    // lists up to this length are not divided
    std::uint32_t longest_list = 32;  // longer ones are not tested, but searched for
    double smallest_cell = 16;        // pixels: no smaller cells are made
    double least_rays = 24;           // that a first cell must serve
    double first_cells = 32;          // pixels: larger parts of faces have no lists
};

// How a rectangle is divided: its longer side first.
struct Division {
    bool along_u, along_v;
    int ways() const { return (along_u ? 2 : 1) * (along_v ? 2 : 1); }
};
Division division(const Chart& chart, const ChartRectangle& rectangle);
ChartRectangle part(const ChartRectangle& whole, const Division& division, int index);

class FaceCells {
  public:
    FaceCells(Cells& cells, const Snapshot& scene, const FaceKey& key, const CellPolicy& policy, CellCounts& counts);

    bool is_supported() const { return chart_.has_value(); }
    const Chart& chart() const { return *chart_; }

    const FaceKey& key() const { return key_; }

    // What may block the light for rays that begin at a point of these coordinates, where pixels are `footprint` wide.
    // The answer holds for all points in its cell.
    CellAnswer ask(std::size_t light, const Vec3d& point, double footprint);

    // The verdict of one cell, made now if it is not known yet: from the parent's list, or by a walk of the BVH.
    static std::uint32_t verdict(Cells& cells, const Snapshot& scene, const Bundle& bundle, std::uint32_t departed,
                                 std::uint32_t word, std::uint32_t parent, CellCounts& counts);

  private:
    std::uint32_t entry_of(std::size_t light, std::uint32_t cell, const ChartRectangle& here, std::uint32_t parent,
                           const ChartRectangle& above);

    Cells& cells_;
    const Snapshot& scene_;
    FaceKey key_;
    CellPolicy policy_;
    CellCounts& counts_;
    std::optional<Chart> chart_;
    std::uint32_t root_ = Arena::none;
};

}  // namespace raybound
