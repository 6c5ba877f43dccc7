// Bounds and frames of the primitives.
#include <span>

#include "raybound/shapes/mesh.h"
#include "raybound/shapes/unit_quadric.h"

namespace raybound {

namespace {

// The half extents of the disk spanned by the columns a and b.
Vec3d disk_extent(const Vec3d& a, const Vec3d& b) {
    return {std::hypot(a.x, b.x), std::hypot(a.y, b.y), std::hypot(a.z, b.z)};
}

void extend_around(Boxd& box, const Vec3d& center, const Vec3d& half) {
    box.extend(center - half);
    box.extend(center + half);
}

// The farthest points of a quadric's solid in the six directions of the world.
void extend_around_quadric(Boxd& box, const UnitQuadric& q, const Affine& frame) {
    for (int i = 0; i < 3; ++i) {
        box.upper[i] = frame.offset[i] + enclose_reach(q, frame.linear.row[i]);
        box.lower[i] = frame.offset[i] - enclose_reach(q, -frame.linear.row[i]);
    }
}

Boxd frame_bounds(const Shape& shape, const Affine& frame) {
    const Vec3d x = frame.linear.column(0), y = frame.linear.column(1), z = frame.linear.column(2);
    const Vec3d round = disk_extent(x, y);
    Boxd box;
    switch (shape.kind()) {
        case ShapeKind::sphere:
            extend_around(box, frame.offset,
                          {length(frame.linear.row[0]), length(frame.linear.row[1]), length(frame.linear.row[2])});
            break;
        case ShapeKind::box:
            extend_around(box, frame.offset, absolute(x) + absolute(y) + absolute(z));
            break;
        case ShapeKind::quadric:
            extend_around_quadric(box, unit_quadric(shape), frame);
            break;
        case ShapeKind::cylinder:
        case ShapeKind::cone: {
            const double top =
                shape.kind() == ShapeKind::cone ? double(shape.top_radius()) / double(shape.radius()) : 1.0;
            extend_around(box, frame.offset, round);
            extend_around(box, frame.offset + z, round * top);
            break;
        }
        default:
            extend_around(box, frame.offset, round);
            break;
    }
    return box;
}

Boxd primitive_bounds(const Shape& shape, const Affine& placement) {
    Boxd box;
    switch (shape.kind()) {
        case ShapeKind::polygon:
            for (const Vec3f& v : shape.vertices()) box.extend(placement.point(Vec3d(v)));
            return box;
        case ShapeKind::mesh:
            for (const Vec3f& v : shape.mesh()->vertices()) box.extend(placement.point(Vec3d(v)));
            return box;
        default:
            return frame_bounds(shape, placement * unit_frame(shape));
    }
}

// The bounds of a CSG operation from those of its parts, of which there is one at least.
Boxd combined_bounds(ShapeKind operation, std::span<const Boxd> parts) {
    Boxd box = parts[0];
    if (operation == ShapeKind::csg_difference) return box;
    for (const Boxd& part : parts.subspan(1)) {
        if (operation == ShapeKind::csg_union)
            box.extend(part);
        else
            box = intersection(box, part);
    }
    return operation == ShapeKind::csg_union ? box : collapsed(box);
}

// A CSG operation whose parts are being bounded: their boxes follow those of the operations it is part of.
struct Open {
    const Shape* shape;
    Affine placement;
    std::size_t next = 0, first_box = 0;
};

}  // namespace

Boxd collapsed(const Boxd& box) {
    const Vec3d middle = box.center();
    return {minimum(box.lower, middle), maximum(box.upper, middle)};
}

Box conservative_box(const Boxd& box) {
    const double reach = maximum(max_component(absolute(box.lower)), max_component(absolute(box.upper)));
    const double margin = 0x1p-40 * max_component(box.extent()) + 0x1p-50 * reach;
    const Vec3d m{margin, margin, margin};
    return round_outward({box.lower - m, box.upper + m});
}

Affine unit_frame(const Shape& shape) {
    const Vec3d first(shape.first()), second(shape.second());
    const double r = shape.radius();
    switch (shape.kind()) {
        case ShapeKind::sphere:
            return {{{r, 0, 0}, {0, r, 0}, {0, 0, r}}, first};
        case ShapeKind::box:
        case ShapeKind::quadric: {
            const Vec3d half = (second - first) * 0.5;
            return {{{half.x, 0, 0}, {0, half.y, 0}, {0, 0, half.z}}, (first + second) * 0.5};
        }
        case ShapeKind::disk: {
            const Vec3d axis = normalize(second);
            const auto [u, v] = orthonormal_basis(axis);
            return {from_columns(u * r, v * r, axis * r), first};
        }
        default: {
            const Vec3d axis = second - first;
            const auto [u, v] = orthonormal_basis(normalize(axis));
            return {from_columns(u * r, v * r, axis), first};
        }
    }
}

Boxd shape_bounds(const Shape& shape, const Affine& placement) {
    std::vector<Open> open;
    std::vector<Boxd> boxes;
    const auto enter = [&](const Shape& part, Affine map) {
        const Shape& inner = strip_transforms(part, map);
        if (inner.parts().empty())
            boxes.push_back(primitive_bounds(inner, map));
        else if (map.is_identity() && inner.own_bounds())
            boxes.push_back(*inner.own_bounds());
        else
            open.push_back({&inner, map, 0, boxes.size()});
    };
    enter(shape, placement);
    while (!open.empty()) {
        Open& at = open.back();
        if (at.next < at.shape->parts().size()) {
            enter(*at.shape->parts()[at.next++], at.placement);
            continue;
        }
        const Boxd box = combined_bounds(at.shape->kind(), std::span(boxes).subspan(at.first_box));
        boxes.resize(at.first_box);
        boxes.push_back(box);
        open.pop_back();
    }
    return boxes[0];
}

}  // namespace raybound
