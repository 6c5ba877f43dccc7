#include "raybound/certify/chart.h"

namespace raybound {

namespace {

// How far float origins are from their surface: a few ulp of their coordinates, in the world.
constexpr double origin_slack = 0x1p-20;

// Patches are this much larger than cells: more than the roundings of coordinates, as sizes are at least 2^-20 of them.
constexpr double patch_growth = 1 + 0x1p-20;

int axis_of_face(const Leaf& leaf, int face) {
    if (leaf.kind == LeafKind::quadric) return (face - 1) / 2;
    return leaf.kind == LeafKind::box ? face / 2 : 2;
}

// A normal of the world in a frame's coordinates y = A (x - c): gradients travel by the transpose of the inverse.
Vec3d inverse_transpose_times(const Mat3<double>& linear, const Vec3d& normal) {
    return transpose_times(inverse(linear), normal);
}

}  // namespace

int Chart::piece_for(const Geometry& geometry, std::uint32_t index, int face, const Vec3d& normal) {
    const Leaf& leaf = geometry.leaves[index];
    const bool side = (leaf.kind == LeafKind::cylinder || leaf.kind == LeafKind::cone) && face == 0;
    if (leaf.kind == LeafKind::polygon) return 2 * geometry.polygons[leaf.polygon].axis;
    const bool round = leaf.kind == LeafKind::sphere || (leaf.kind == LeafKind::quadric && face == 0);
    if (!round && !side) return 2 * axis_of_face(leaf, face);
    Vec3d n = normal;
    if (leaf.frame >= 0) n = inverse_transpose_times(geometry.frames[std::size_t(leaf.frame)].linear_wide, normal);
    const Vec3d a = absolute(n);
    int axis = a.x >= a.y ? 0 : 1;
    if (!side && a.z > a[axis]) axis = 2;
    return 2 * axis + (n[axis] < 0 ? 0 : 1);
}

std::optional<Chart> Chart::make(const Geometry& geometry, std::uint32_t index, int face, int piece) {
    const Leaf& leaf = geometry.leaves[index];
    if (!is_known(geometry, leaf)) return std::nullopt;
    Chart chart(geometry, leaf, face, piece);
    const ChartRectangle& whole = chart.whole_;
    const double sum = whole.half_u + whole.half_v + chart.scale_u_ + chart.scale_v_ + norm1(chart.slack_);
    if (!(sum < infinity<double>) || !(whole.half_u > 0 && whole.half_v > 0)) return std::nullopt;
    return chart;
}

Chart::Chart(const Geometry& geometry, const Leaf& leaf, int face, int piece)
    : axis_(piece / 2), sign_(piece % 2 == 1 ? 1 : -1) {
    place(geometry, leaf);
    describe(geometry, leaf, face);
    finish();
}

void Chart::place(const Geometry& geometry, const Leaf& leaf) {
    if (leaf.frame >= 0) {
        const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
        linear_ = frame.linear_wide;
        center_ = frame.center_wide;
        to_world_ = inverse(linear_);
        radius_ = frame.radius;
        slope_ = frame.slope;
    } else if (leaf.kind == LeafKind::polygon) {
        center_ = geometry.vertices[geometry.polygons[leaf.polygon].first_vertex];
        radius_ = 0;
    } else {
        center_ = leaf.kind == LeafKind::sphere ? leaf.first : (leaf.first + leaf.second) * 0.5;
        radius_ = leaf.kind == LeafKind::sphere ? leaf.radius() : 0;
    }
}

void Chart::describe(const Geometry& geometry, const Leaf& leaf, int face) {
    const int i = (axis_ + 1) % 3, j = (axis_ + 2) % 3;
    Vec3d lower{-radius_, -radius_, -radius_}, upper{radius_, radius_, radius_};
    form_ = Form::plane;
    switch (leaf.kind) {
        case LeafKind::sphere:
            form_ = Form::sphere;
            break;
        case LeafKind::cylinder:
        case LeafKind::cone:
            lower.z = 0;
            if (face == 0) form_ = leaf.kind == LeafKind::cylinder ? Form::cylinder : Form::cone;
            if (face == 2) plane_level_ = radius_;
            break;
        case LeafKind::box:
            if (leaf.frame < 0) lower = leaf.first - center_, upper = leaf.second - center_;
            plane_level_ = face % 2 == 1 ? upper[axis_] : lower[axis_];
            break;
        case LeafKind::quadric:
            if (face == 0) form_ = Form::quadric;
            if (face != 0) plane_level_ = face % 2 == 0 ? radius_ : -radius_;
            quadric_ = &geometry.quadrics[leaf.polygon];
            break;
        case LeafKind::polygon: {
            const PolygonPlane& plane = geometry.polygons[leaf.polygon];
            lower = upper = {};
            for (const Vec3d& v : geometry.polygon_vertices(plane)) {
                lower = minimum(lower, v - center_);
                upper = maximum(upper, v - center_);
            }
            plane_u_ = -plane.slope_i;
            plane_v_ = -plane.slope_j;
            break;
        }
        default:
            break;
    }
    whole_ = {(lower[i] + upper[i]) * 0.5, (lower[j] + upper[j]) * 0.5, (upper[i] - lower[i]) * 0.5,
              (upper[j] - lower[j]) * 0.5};
}

void Chart::finish() {
    const int i = (axis_ + 1) % 3, j = (axis_ + 2) % 3;
    rows_ = {linear_.row[i], linear_.row[j], linear_.row[axis_]};
    const double stretch = form_ == Form::plane ? std::sqrt(1 + square(plane_u_) + square(plane_v_)) : 1.5;
    scale_u_ = length(to_world_.column(i)) * stretch;
    scale_v_ = length(to_world_.column(j)) * stretch;
    const double heights = length(to_world_.column(axis_)) * (radius_ + abs(plane_level_));
    const double reach = origin_slack * (norm1(center_) + heights + length(to_world_.column(i)) * whole_.half_u +
                                         length(to_world_.column(j)) * whole_.half_v);
    slack_ = {reach * norm1(rows_[0]), reach * norm1(rows_[1]), reach * norm1(rows_[2])};
}

// The height over the middle, its slopes, and how far it bends away from the plane they make: half the second
// derivatives times the squares of the sides. All of it within the part of the chart that is used, where the height is
// no less than about half of the size.
void Chart::bend(ChartCell& cell) const {
    const ChartRectangle& r = cell.rectangle;
    const bool u_is_axis = (axis_ + 1) % 3 == 2;  // of the cylinder, the cone: z is u or v
    const auto at = [&](double u, double v) {
        if (form_ == Form::sphere) return square(radius_) - square(u) - square(v);
        const double along = u_is_axis ? u : v, across = u_is_axis ? v : u;
        const double w = form_ == Form::cone ? radius_ - slope_ * along : radius_;
        return square(w) - square(across);
    };
    const double outer = form_ == Form::cone ? maximum(abs(radius_), abs(radius_ * (1 - slope_))) : radius_;
    const double least = square(0x1p-6 * outer);
    const double middle = std::sqrt(maximum(at(r.center_u, r.center_v), least));
    cell.level = sign_ * middle;
    const double on_axis = u_is_axis ? r.center_u : r.center_v;
    const double along_axis = form_ == Form::cone ? -slope_ * (radius_ - slope_ * on_axis) / middle : 0;
    const bool round_u = form_ == Form::sphere || !u_is_axis, round_v = form_ == Form::sphere || u_is_axis;
    cell.slope_u = sign_ * (round_u ? -r.center_u / middle : along_axis);
    cell.slope_v = sign_ * (round_v ? -r.center_v / middle : along_axis);
    // What it bends is seen at the corners and the sides' middles, twice as much taken: curvature changes within.
    double most = 0;
    for (int a = -1; a <= 1; ++a)
        for (int b = -1; b <= 1; ++b) {
            const double du = a * r.half_u, dv = b * r.half_v;
            const double height = sign_ * std::sqrt(maximum(at(r.center_u + du, r.center_v + dv), least));
            most = maximum(most, abs(height - cell.level - cell.slope_u * du - cell.slope_v * dv));
        }
    cell.thickness += minimum(2 * most, 2 * outer);
}

// Where the line over (u, v) leaves the quadric on the side of the chart: F is a h^2 + 2 b h + c along it.
double Chart::quadric_height(double u, double v) const {
    Vec3d y;
    y[(axis_ + 1) % 3] = u;
    y[(axis_ + 2) % 3] = v;
    const Vec3d half = quadric_half_gradient(*quadric_, y);
    const double a = quadric_->form.row[axis_][axis_], b = half[axis_], c = quadric_value(*quadric_, y, half);
    const double root = sign_ * std::sqrt(maximum(b * b - a * c, 0.0));
    const double height = abs(a) > 0x1p-30 * quadric_->norm ? (root - b) / a : -c / (2 * b);
    return abs(height) <= 2 * radius_ ? height : 0;
}

void Chart::bend_quadric(ChartCell& cell) const {
    const ChartRectangle& r = cell.rectangle;
    const auto at = [&](int a, int b) { return quadric_height(r.center_u + a * r.half_u, r.center_v + b * r.half_v); };
    cell.level = at(0, 0);
    cell.slope_u = (at(1, 0) - at(-1, 0)) / (2 * r.half_u);
    cell.slope_v = (at(0, 1) - at(0, -1)) / (2 * r.half_v);
    double most = 0;
    for (int a = -1; a <= 1; ++a)
        for (int b = -1; b <= 1; ++b)
            most =
                maximum(most, abs(at(a, b) - cell.level - cell.slope_u * a * r.half_u - cell.slope_v * b * r.half_v));
    cell.thickness += minimum(2 * most, 2 * radius_);
}

ChartCell Chart::cell(const ChartRectangle& rectangle) const {
    ChartCell cell{rectangle, 0, 0, 0, slack_.z};
    cell.rectangle.half_u += slack_.x;
    cell.rectangle.half_v += slack_.y;
    if (form_ == Form::plane) {
        cell.level = plane_level_ + plane_u_ * rectangle.center_u + plane_v_ * rectangle.center_v;
        cell.slope_u = plane_u_;
        cell.slope_v = plane_v_;
    } else if (form_ == Form::quadric) {
        bend_quadric(cell);
    } else {
        bend(cell);
    }
    return cell;
}

Patch Chart::patch(const ChartCell& cell) const {
    const int i = (axis_ + 1) % 3, j = (axis_ + 2) % 3;
    const Vec3d u = to_world_.column(i), v = to_world_.column(j), up = to_world_.column(axis_);
    const ChartRectangle& r = cell.rectangle;
    constexpr double more = patch_growth;
    return {center_ + u * r.center_u + v * r.center_v + up * cell.level,
            {(u + up * cell.slope_u) * (r.half_u * more), (v + up * cell.slope_v) * (r.half_v * more),
             up * (cell.thickness * more)}};
}

// A sixteenth of what patches are larger than cells, so that cells within cells within cells stay in all patches; more
// than roundings.
bool is_within(const ChartCell& inner, const ChartCell& outer) {
    constexpr double larger = 1 + (patch_growth - 1) / 16;
    const ChartRectangle &a = inner.rectangle, &b = outer.rectangle;
    const double du = a.center_u - b.center_u, dv = a.center_v - b.center_v;
    if (!(abs(du) + a.half_u <= b.half_u * larger && abs(dv) + a.half_v <= b.half_v * larger)) return false;
    const double middle = inner.level - outer.level - (outer.slope_u * du + outer.slope_v * dv);
    const double bend = abs(inner.slope_u - outer.slope_u) * a.half_u + abs(inner.slope_v - outer.slope_v) * a.half_v;
    return abs(middle) + bend + inner.thickness <= outer.thickness * larger;
}

}  // namespace raybound
