// Shapes as users describe them: immutable values, checked when they are made.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "raybound/geometry/box.h"
#include "raybound/geometry/matrix.h"

namespace raybound {

enum class ShapeKind : std::uint8_t {
    sphere,
    box,
    cylinder,
    cone,
    disk,
    polygon,
    quadric,
    mesh,
    csg_union,
    csg_intersection,
    csg_difference,
    transformed
};

class Shape;
class MeshData;
using MeshPointer = std::shared_ptr<const MeshData>;
using ShapePointer = std::shared_ptr<const Shape>;

// One node of a description: a primitive, a CSG operation, or a transform of another shape. Inputs are floats. Shapes
// may be nested to any depth: what walks them does not recurse.
class Shape {
  public:
    Shape(const Shape&) = delete;
    Shape& operator=(const Shape&) = delete;
    ~Shape();

    static ShapePointer sphere(const Vec3f& center, float radius);
    static ShapePointer box(const Vec3f& lower, const Vec3f& upper);
    static ShapePointer cylinder(const Vec3f& base, const Vec3f& top, float radius);
    static ShapePointer cone(const Vec3f& base, const Vec3f& apex, float radius, float top_radius);
    static ShapePointer disk(const Vec3f& center, const Vec3f& normal, float radius);
    static ShapePointer polygon(std::vector<Vec3f> vertices);
    static ShapePointer triangle_mesh(MeshPointer mesh);
    static ShapePointer quadric(std::vector<float> coefficients, const Vec3f& lower, const Vec3f& upper);
    static ShapePointer combine(ShapeKind operation, std::vector<ShapePointer> parts);
    static ShapePointer transformed(ShapePointer shape, const Affine& transform);

    ShapeKind kind() const { return kind_; }
    const Vec3f& first() const { return first_; }    // center, min, base
    const Vec3f& second() const { return second_; }  // max, top, apex, normal
    float radius() const { return radius_; }
    float top_radius() const { return top_radius_; }
    const std::vector<Vec3f>& vertices() const { return vertices_; }
    const MeshPointer& mesh() const { return mesh_; }
    const std::vector<float>& coefficients() const { return coefficients_; }  // of a quadric, A .. J
    const std::vector<ShapePointer>& parts() const { return parts_; }
    const Affine& transform() const { return transform_; }

    bool is_solid() const { return is_solid_; }     // encloses a volume: what CSG can combine
    int face_count() const { return face_count_; }  // faces of the parts count one after the other
    int primitive_count() const { return primitive_count_; }
    // shape_bounds where it is, for intersections: asked again at each step of a loop that cuts.
    const std::optional<Boxd>& own_bounds() const { return own_bounds_; }

  private:
    explicit Shape(ShapeKind kind);
    void adopt(const std::string& owner, std::vector<ShapePointer> parts);

    ShapeKind kind_;
    Vec3f first_, second_;
    float radius_ = 0, top_radius_ = 0;
    std::vector<Vec3f> vertices_;
    MeshPointer mesh_;
    std::vector<float> coefficients_;
    std::vector<ShapePointer> parts_;
    Affine transform_;
    bool is_solid_;
    int face_count_ = 1, primitive_count_ = 1;
    std::optional<Boxd> own_bounds_;
};

// What a shape's transforms are about, with them multiplied to its placement from the right.
const Shape& strip_transforms(const Shape& shape, Affine& placement);

// Bounds of the shape under a map, in double: exact up to double rounding.
Boxd shape_bounds(const Shape& shape, const Affine& placement);

// Parts that overlap in one position of the axes and not in another enclose nothing: bounds of no extent then.
Boxd collapsed(const Boxd& box);

// The same as a box of floats that surely holds the shape: double rounding is covered by 2^-40 of the size and 2^-50
// of the coordinates.
Box conservative_box(const Boxd& box);

// The map from a primitive's own unit coordinates (unit radius, unit height along z, centred cube) to its
// description's.
Affine unit_frame(const Shape& shape);

// Checks of numbers that enter, in one place; all throw std::invalid_argument.
void require_finite(const char* object, const char* argument, const Vec3f& value);
void require_finite(const char* object, const char* argument, double value);
std::string format(double value);
std::string format(const Vec3f& value);

// An affine map rounded to float once, as scene inputs are; throws if it is singular or out of range.
Affine checked_transform(const std::string& owner, const Affine& transform);

// Coordinates up to 2^60 and sizes down to 2^-60 keep every product of kernels within the range of float.
inline constexpr float largest_coordinate = 0x1p60f, least_size = 0x1p-60f;

}  // namespace raybound
