// CSG operations: what can be combined, and whether anything is enclosed.
#include <span>
#include <stdexcept>

#include "raybound/shapes/inside.h"

namespace raybound {

namespace {

Boxd overlap(const std::vector<ShapePointer>& parts) {
    Boxd box = shape_bounds(*parts[0], {});
    for (const auto& part : std::span(parts).subspan(1)) box = intersection(box, shape_bounds(*part, {}));
    return box;
}

const char* name_of(ShapeKind operation) {
    if (operation == ShapeKind::csg_union) return "Union";
    return operation == ShapeKind::csg_intersection ? "Intersection" : "Difference";
}

// Does the shape surely hold all of another one? A convex primitive does if it holds the corners of the other's bounds.
bool surely_holds(const Shape& shape, const Shape& other) {
    Geometry geometry;
    add_primitive(geometry, 0, shape, {});
    const Primitive& primitive = geometry.primitives.front();
    if (!is_convex_solid(geometry, primitive)) return false;
    const Boxd box = shape_bounds(other, {});
    for (int corner = 0; corner < 8; ++corner) {
        Vec3d p;
        for (int i = 0; i < 3; ++i) p[i] = corner >> i & 1 ? box.upper[i] : box.lower[i];
        if (!contains(geometry, primitive, p)) return false;
    }
    return true;
}

void require_remainder(const std::vector<ShapePointer>& parts) {
    for (std::size_t i = 1; i < parts.size(); ++i)
        if (parts[i] == parts[0] || surely_holds(*parts[i], *parts[0]))
            throw std::invalid_argument("Difference: argument " + std::to_string(i) +
                                        " must leave some of argument 0, it holds all of it: the difference encloses "
                                        "nothing");
}

}  // namespace

ShapePointer Shape::combine(ShapeKind operation, std::vector<ShapePointer> parts) {
    const std::string name = name_of(operation);
    if (parts.empty()) throw std::invalid_argument(name + ": needs at least one solid");
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (!parts[i]->is_solid())
            throw std::invalid_argument(name + ": argument " + std::to_string(i) +
                                        " must be a solid, a disk, polygon or mesh is none");
    const std::shared_ptr<Shape> shape(new Shape(operation));
    if (operation == ShapeKind::csg_intersection) {
        const Boxd box = overlap(parts);
        if (box.is_empty())
            throw std::invalid_argument(name + ": the parts do not overlap, their intersection encloses nothing");
        shape->own_bounds_ = collapsed(box);
    }
    if (operation == ShapeKind::csg_difference) {
        require_remainder(parts);
        shape->own_bounds_ = shape_bounds(*parts[0], {});
    }
    shape->adopt(name, std::move(parts));
    return shape;
}

}  // namespace raybound
