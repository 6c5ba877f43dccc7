#include "raybound/shapes/shape.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "raybound/geometry/sole_owner.h"
#include "raybound/shapes/mesh.h"
#include "raybound/shapes/polygon.h"
#include "raybound/shapes/unit_quadric.h"

namespace raybound {

namespace {

[[noreturn]] void refuse(const std::string& message) { throw std::invalid_argument(message); }

void require_size(const char* object, const char* argument, float value) {
    require_finite(object, argument, value);
    const std::string head = std::string(object) + ": " + argument + " must be ";
    if (!(value > 0)) refuse(head + "> 0, got " + format(value));
    if (value < least_size) refuse(head + ">= 2**-60, got " + format(value));
}

void require_apart(const char* object, const char* what, const Vec3f& a, const Vec3f& b) {
    if (length(Vec3d(b) - Vec3d(a)) < double(least_size))
        refuse(std::string(object) + ": " + what + " must differ, got " + format(a) + " twice");
}

double extent_of(const std::vector<Vec3f>& vertices) {
    Boxd box;
    for (const Vec3f& v : vertices) box.extend(Vec3d(v));
    return max_component(box.extent());
}

// Planar up to the rounding of the vertices: each is within 4 ulp of the largest coordinate of the common plane.
void require_planar(const std::vector<Vec3f>& vertices, const Vec3d& unit) {
    double largest = 0;
    for (const Vec3f& v : vertices) largest = maximum(largest, double(max_component(absolute(v))));
    const double tolerance = 8 * 0x1p-24 * largest;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const double off = dot(unit, Vec3d(vertices[i]) - Vec3d(vertices[0]));
        if (!(std::abs(off) <= tolerance))
            refuse("Polygon: vertices must be planar, vertex " + std::to_string(i) + " is " + format(std::abs(off)) +
                   " off the plane");
    }
}

// Every corner turns left, or goes straight on, and the turns add up to one full turn.
void require_convex(const std::vector<Vec3f>& vertices, const Vec3d& unit, double extent) {
    const std::size_t n = vertices.size();
    double turns = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3d a(vertices[i]), b(vertices[(i + 1) % n]), c(vertices[(i + 2) % n]);
        const Vec3d ab = b - a, bc = c - b;
        if (length(ab) == 0)
            refuse("Polygon: vertices " + std::to_string(i) + " and " + std::to_string((i + 1) % n) + " coincide");
        const double left = dot(unit, cross(ab, bc));
        if (left < -1e-6 * extent * maximum(length(ab), length(bc)))
            refuse("Polygon: vertices must be convex, vertex " + std::to_string((i + 1) % n) + " turns inward at " +
                   format(vertices[(i + 1) % n]));
        turns += std::atan2(left, dot(ab, bc));
    }
    if (std::abs(turns - 6.283185307179586) > 0.1)
        refuse("Polygon: vertices must go around once, they cross themselves");
}

std::string format_all(const std::vector<float>& values) {
    std::string text;
    for (const float value : values) text += (text.empty() ? "(" : ", ") + format(double(value));
    return text + ")";
}

// The solid q <= 0 of ten coefficients, as a message says it.
void require_quadric(const std::vector<float>& c) {
    const std::string head = "Quadric: coefficients must ";
    if (c.size() != 10) refuse(head + "be ten numbers (A .. J), got " + std::to_string(c.size()));
    for (const float value : c)
        if (!std::isfinite(value)) refuse(head + "be finite, got " + format_all(c));
    if (std::all_of(c.begin(), c.end() - 1, [](float x) { return x == 0; }))
        refuse(head + "have a part of first or second order, got " + format_all(c));
}

int face_count_of(ShapeKind kind) {
    switch (kind) {
        case ShapeKind::box:
            return 6;
        case ShapeKind::quadric:
            return 7;
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            return 3;
        default:
            return 1;
    }
}

}  // namespace

std::string format(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

std::string format(const Vec3f& v) { return "(" + format(v.x) + ", " + format(v.y) + ", " + format(v.z) + ")"; }

void require_finite(const char* object, const char* argument, double value) {
    if (!(std::abs(value) <= double(largest_coordinate)))
        refuse(std::string(object) + ": " + argument + " must be finite and at most 2**60, got " + format(value));
}

void require_finite(const char* object, const char* argument, const Vec3f& value) {
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(value[i]) <= largest_coordinate))
            refuse(std::string(object) + ": " + argument + " must be finite and at most 2**60, got " + format(value));
}

Shape::Shape(ShapeKind kind)
    : kind_(kind),
      is_solid_(kind != ShapeKind::disk && kind != ShapeKind::polygon && kind != ShapeKind::mesh),
      face_count_(face_count_of(kind)) {}

// Parts that nobody else holds are taken apart here, one after the other: their own destructors would nest.
Shape::~Shape() {
    std::vector<ShapePointer> rest = std::move(parts_);
    while (!rest.empty()) {
        const ShapePointer part = std::move(rest.back());
        rest.pop_back();
        if (part->parts_.empty() || !is_sole_owner(part)) continue;
        auto& inner = const_cast<Shape&>(*part).parts_;
        std::ranges::move(inner, std::back_inserter(rest));
        inner.clear();
    }
}

void Shape::adopt(const std::string& owner, std::vector<ShapePointer> parts) {
    std::int64_t faces = 0, primitives = 0;
    for (const auto& part : parts) {
        faces += part->face_count();
        primitives += part->primitive_count();
    }
    if (std::max(faces, primitives) > std::numeric_limits<std::int32_t>::max())
        refuse(owner + ": parts must have fewer than 2**31 faces together, got " + std::to_string(faces));
    parts_ = std::move(parts);
    face_count_ = int(faces);
    primitive_count_ = int(primitives);
}

ShapePointer Shape::sphere(const Vec3f& center, float radius) {
    require_finite("Sphere", "center", center);
    require_size("Sphere", "radius", radius);
    auto* shape = new Shape(ShapeKind::sphere);
    shape->first_ = center;
    shape->radius_ = radius;
    return ShapePointer(shape);
}

ShapePointer Shape::box(const Vec3f& lower, const Vec3f& upper) {
    require_finite("Box", "min", lower);
    require_finite("Box", "max", upper);
    for (int i = 0; i < 3; ++i)
        if (!(double(upper[i]) - double(lower[i]) >= double(least_size)))
            refuse("Box: max must be greater than min in every coordinate, got min " + format(lower) + ", max " +
                   format(upper));
    auto* shape = new Shape(ShapeKind::box);
    shape->first_ = lower;
    shape->second_ = upper;
    return ShapePointer(shape);
}

ShapePointer Shape::cylinder(const Vec3f& base, const Vec3f& top, float radius) {
    require_finite("Cylinder", "base", base);
    require_finite("Cylinder", "top", top);
    require_size("Cylinder", "radius", radius);
    require_apart("Cylinder", "base and top", base, top);
    auto* shape = new Shape(ShapeKind::cylinder);
    shape->first_ = base;
    shape->second_ = top;
    shape->radius_ = radius;
    return ShapePointer(shape);
}

ShapePointer Shape::cone(const Vec3f& base, const Vec3f& apex, float radius, float top_radius) {
    require_finite("Cone", "base", base);
    require_finite("Cone", "apex", apex);
    require_size("Cone", "radius", radius);
    if (!(top_radius >= 0 && top_radius <= largest_coordinate))
        refuse("Cone: top_radius must be >= 0, got " + format(top_radius));
    require_apart("Cone", "base and apex", base, apex);
    auto* shape = new Shape(ShapeKind::cone);
    shape->first_ = base;
    shape->second_ = apex;
    shape->radius_ = radius;
    shape->top_radius_ = top_radius;
    return ShapePointer(shape);
}

ShapePointer Shape::disk(const Vec3f& center, const Vec3f& normal, float radius) {
    require_finite("Disk", "center", center);
    require_finite("Disk", "normal", normal);
    require_size("Disk", "radius", radius);
    if (!(length(Vec3d(normal)) >= double(least_size))) refuse("Disk: normal must not be zero, got " + format(normal));
    auto* shape = new Shape(ShapeKind::disk);
    shape->first_ = center;
    shape->second_ = normal;
    shape->radius_ = radius;
    return ShapePointer(shape);
}

ShapePointer Shape::polygon(std::vector<Vec3f> vertices) {
    if (vertices.size() < 3) refuse("Polygon: vertices must be at least 3, got " + std::to_string(vertices.size()));
    for (const Vec3f& v : vertices) require_finite("Polygon", "vertices", v);
    const double extent = extent_of(vertices);
    const Vec3d normal = newell_normal(vertices);
    const double area = length(normal);
    if (!(area > 1e-7 * extent * extent) || extent < double(least_size))
        refuse("Polygon: vertices must not be collinear, got an area of " + format(area / 2) + " over an extent of " +
               format(extent));
    const Vec3d unit = normal * (1 / area);
    require_planar(vertices, unit);
    require_convex(vertices, unit, extent);
    auto* shape = new Shape(ShapeKind::polygon);
    shape->vertices_ = std::move(vertices);
    return ShapePointer(shape);
}

ShapePointer Shape::triangle_mesh(MeshPointer mesh) {
    auto* shape = new Shape(ShapeKind::mesh);
    shape->mesh_ = std::move(mesh);
    shape->face_count_ = int(shape->mesh_->faces().size());
    return ShapePointer(shape);
}

ShapePointer Shape::quadric(std::vector<float> coefficients, const Vec3f& lower, const Vec3f& upper) {
    require_quadric(coefficients);
    const ShapePointer clip = box(lower, upper);
    auto* shape = new Shape(ShapeKind::quadric);
    shape->first_ = clip->first();
    shape->second_ = clip->second();
    shape->coefficients_ = std::move(coefficients);
    ShapePointer pointer(shape);
    if (!find_inside(unit_quadric(*shape)).possible)
        refuse("Quadric: coefficients must leave a solid within clip, got " + format_all(shape->coefficients()) +
               ", > 0 throughout the box from " + format(lower) + " to " + format(upper));
    return pointer;
}

ShapePointer Shape::transformed(ShapePointer inner, const Affine& transform) {
    const std::shared_ptr<Shape> shape(new Shape(ShapeKind::transformed));
    shape->transform_ = transform;
    shape->is_solid_ = inner->is_solid();
    shape->adopt("Shape.transformed", {std::move(inner)});
    return shape;
}

const Shape& strip_transforms(const Shape& shape, Affine& placement) {
    const Shape* inner = &shape;
    while (inner->kind() == ShapeKind::transformed) {
        placement = placement * inner->transform();
        inner = inner->parts()[0].get();
    }
    return *inner;
}

Affine checked_transform(const std::string& owner, const Affine& transform) {
    Affine rounded;
    for (int i = 0; i < 3; ++i) {
        rounded.linear.row[i] = Vec3d(Vec3f(transform.linear.row[i]));
        if (!is_finite(rounded.linear.row[i])) refuse(owner + ": matrix must be finite");
    }
    rounded.offset = Vec3d(Vec3f(transform.offset));
    if (!(max_component(absolute(rounded.offset)) <= double(largest_coordinate)))
        refuse(owner + ": matrix must be finite and its translation at most 2**60");
    const Vec3d c0 = rounded.linear.column(0), c1 = rounded.linear.column(1), c2 = rounded.linear.column(2);
    const double volume = std::abs(determinant(rounded.linear)), lengths = length(c0) * length(c1) * length(c2);
    const double size = maximum(maximum(length(c0), length(c1)), length(c2));
    if (!(size <= double(largest_coordinate)))
        refuse(owner + ": matrix must scale by at most 2**60, got " + format(size));
    if (!(volume > 0x1p-40 * lengths) || !(lengths > 0))
        refuse(owner + ": matrix must not be singular, got determinant " + format(determinant(rounded.linear)));
    return rounded;
}

}  // namespace raybound
