// Charts of faces: coordinates (u, v) in which a face is a square that quadtrees divide, and the patch of space around
// each part of it.
//
// A face of a leaf is seen along the axis k of the leaf's own coordinates that its normal is closest to: one piece for
// a flat face, four for a side, six for a sphere. So patches stay compact everywhere. Nothing has to be proved about a
// chart: that a point lies in a patch is asked of the point itself.
#pragma once

#include <optional>

#include "raybound/geometry/shaft.h"
#include "raybound/shapes/geometry.h"

namespace raybound {

// A part of a chart: |u - center_u| <= half_u, and so for v.
struct ChartRectangle {
    double center_u, center_v, half_u, half_v;
};

// The points with |u - center_u| <= half_u, so for v, and |height - level - slope_u (u - center_u) - slope_v
// (v - center_v)| <= thickness: a parallelepiped of the leaf's coordinates.
struct ChartCell {
    ChartRectangle rectangle;
    double level, slope_u, slope_v, thickness;
};

class Chart {
  public:
    static constexpr int pieces = 6;

    // Convex leaves have charts.
    static bool is_known(const Geometry& geometry, const Leaf& leaf) {
        if (leaf.kind == LeafKind::quadric) return geometry.quadrics[leaf.polygon].fall == 0;
        return leaf.kind != LeafKind::mesh;
    }

    // The piece of a face that is seen best along a normal (of the world, any length).
    static int piece_for(const Geometry& geometry, std::uint32_t leaf, int face, const Vec3d& normal);

    // Empty for leaves without a chart.
    static std::optional<Chart> make(const Geometry& geometry, std::uint32_t leaf, int face, int piece);

    bool is_flat() const { return form_ == Form::plane; }

    // A point in the chart's coordinates: u, v, height.
    template <class T>
    Vec3<T> coordinates(const Vec3<T>& p) const {
        const Vec3<T> r = p - Vec3<T>(center_);
        return {dot(Vec3<T>(rows_[0]), r), dot(Vec3<T>(rows_[1]), r), dot(Vec3<T>(rows_[2]), r)};
    }

    const ChartRectangle& whole() const { return whole_; }

    // How long a rectangle's sides are in the world, at most.
    double length_u(const ChartRectangle& r) const { return 2 * r.half_u * scale_u_; }
    double length_v(const ChartRectangle& r) const { return 2 * r.half_v * scale_v_; }

    // Around the face's part over a rectangle, and wider by what float origins may be off.
    ChartCell cell(const ChartRectangle& rectangle) const;

    // A patch of the world that holds every point whose coordinates, as computed, lie in the cell.
    Patch patch(const ChartCell& cell) const;

  private:
    enum class Form : std::uint8_t { plane, sphere, cylinder, cone, quadric };

    Chart(const Geometry& geometry, const Leaf& leaf, int face, int piece);
    void place(const Geometry& geometry, const Leaf& leaf);
    void describe(const Geometry& geometry, const Leaf& leaf, int face);
    void finish();
    void bend(ChartCell& cell) const;
    void bend_quadric(ChartCell& cell) const;
    double quadric_height(double u, double v) const;

    Mat3<double> linear_, to_world_;  // of directions
    Vec3d center_;                    // of the coordinates
    std::array<Vec3d, 3> rows_;       // the rows of linear_ for u, v and height
    int axis_ = 2;
    double sign_ = 1;
    Form form_ = Form::plane;
    double radius_ = 1, slope_ = 0;
    const Quadric* quadric_ = nullptr;
    double plane_level_ = 0, plane_u_ = 0, plane_v_ = 0;  // height = level + u_slope u + v_slope v
    ChartRectangle whole_{};
    double scale_u_ = 1, scale_v_ = 1;
    Vec3d slack_;  // in u, v and height
};

// Is a point in the cell? For one point or several.
template <class T>
inline Mask<T> contains(const ChartCell& cell, const Vec3<T>& point) {
    const ChartRectangle& r = cell.rectangle;
    const T u = point.x - T(r.center_u), v = point.y - T(r.center_v);
    const T height = point.z - T(cell.level) - (u * T(cell.slope_u) + v * T(cell.slope_v));
    return (abs(u) <= T(r.half_u)) & (abs(v) <= T(r.half_v)) & (abs(height) <= T(cell.thickness));
}

// Is all of a cell within another's patch? (Its parent's, mostly; where a face bends it may reach out.)
bool is_within(const ChartCell& inner, const ChartCell& outer);

}  // namespace raybound
