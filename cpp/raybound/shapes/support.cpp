#include "raybound/shapes/support.h"

namespace raybound {

namespace {

Vec3d mean(std::span<const Vec3d> points) {
    Vec3d sum;
    for (const Vec3d& p : points) sum = sum + p;
    return sum * (1 / double(points.size()));
}

Vec3d farthest(std::span<const Vec3d> points, const Vec3d& n) {
    const Vec3d* best = &points[0];
    double most = dot(n, *best);
    for (const Vec3d& p : points)
        if (const double along = dot(n, p); along > most) most = along, best = &p;
    return *best;
}

Vec3d box_corner(const Vec3d& lower, const Vec3d& upper, const Vec3d& n) {
    return {n.x > 0 ? upper.x : lower.x, n.y > 0 ? upper.y : lower.y, n.z > 0 ? upper.z : lower.z};
}

// On the circle of radius r in the plane z.
Vec3d circle_point(double r, double z, const Vec3d& n) {
    const double across = std::sqrt(n.x * n.x + n.y * n.y);
    return across > 0 ? Vec3d{r * (n.x / across), r * (n.y / across), z} : Vec3d{0, 0, z};
}

}  // namespace

ConvexHull::ConvexHull(const Geometry& geometry, const Leaf& leaf) : geometry_(geometry), leaf_(leaf) {
    known_ = leaf.kind != LeafKind::mesh;
    exact_ = known_ && leaf.kind != LeafKind::quadric;
    if (!known_) return;
    if (leaf.kind == LeafKind::polygon) {
        center_ = mean(geometry.polygon_vertices(geometry.polygons[leaf.polygon]));
    } else if (leaf.frame < 0) {
        center_ = leaf.kind == LeafKind::sphere ? leaf.first : (leaf.first + leaf.second) * 0.5;
    } else {
        frame_ = &geometry.frames[std::size_t(leaf.frame)];
        to_world_ = inverse(frame_->linear_wide);
        condition_ =
            maximum(maximum(double(frame_->row_norm.x), double(frame_->row_norm.y)), double(frame_->row_norm.z)) *
            maximum(norm_infinity(to_world_), frame_->inverse_norm);
        if (leaf.kind == LeafKind::cone) condition_ *= maximum(1.0, std::abs(frame_->slope));  // of its form's terms
        const bool centered = leaf.kind == LeafKind::cylinder || leaf.kind == LeafKind::cone;
        center_ = frame_->center_wide;
        if (centered) center_ = center_ + to_world_.column(2) * (0.5 * double(frame_->radius));
    }
}

Vec3d ConvexHull::local_support(const Vec3d& n) const {
    const double r = frame_->radius;
    switch (leaf_.kind) {
        case LeafKind::sphere: {
            const double size = length(n);
            return size > 0 ? n * (r / size) : Vec3d{};
        }
        case LeafKind::cylinder:
            return circle_point(r, n.z > 0 ? r : 0, n);
        case LeafKind::cone: {
            const Vec3d base = circle_point(r, 0, n), top = circle_point(frame_->top_radius, r, n);
            return dot(n, top) > dot(n, base) ? top : base;
        }
        case LeafKind::disk:
            return circle_point(r, 0, n);
        default:
            return box_corner({-r, -r, -r}, {r, r, r}, n);
    }
}

Vec3d ConvexHull::support(const Vec3d& n) const {
    if (leaf_.kind == LeafKind::polygon)
        return farthest(geometry_.polygon_vertices(geometry_.polygons[leaf_.polygon]), n);
    if (frame_) return frame_->center_wide + to_world_ * local_support(transpose_times(to_world_, n));
    if (leaf_.kind == LeafKind::box) return box_corner(leaf_.first, leaf_.second, n);
    const double size = length(n);
    return leaf_.first + (size > 0 ? n * (leaf_.radius() / size) : Vec3d{});
}

}  // namespace raybound
