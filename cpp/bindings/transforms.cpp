#include "bindings/arrays.h"
#include "raybound/geometry/rotation.h"
#include "raybound/shapes/shape.h"

namespace raybound::python {

namespace {

Affine rotation_about(double degrees, const Vec3d& axis) {
    if (!(length(axis) > 0)) throw std::invalid_argument("Transform.rotate: axis must not be zero");
    return rotation(normalize(axis), degrees);
}

}  // namespace

void register_transforms(py::module_& m) {
    m.def(
        "transform_check", [](const std::string& who, const Doubles& a) { checked_transform(who, to_affine(who, a)); },
        "who"_a, "m"_a);
    m.def("transform_inverse", [](const Doubles& a) { return from_affine(inverse(to_affine("Transform", a))); }, "m"_a);
    m.def(
        "transform_multiply",
        [](const Doubles& a, const Doubles& b) {
            return from_affine(to_affine("Transform", a) * to_affine("Transform", b));
        },
        "a"_a, "b"_a);
    m.def(
        "transform_rotate",
        [](double degrees, const Doubles& axis) { return from_affine(rotation_about(degrees, to_vec3<double>(axis))); },
        "degrees"_a, "axis"_a);
    m.def(
        "transform_round",
        [](const Doubles& a) { return from_affine(checked_transform("Transform", to_affine("Transform", a))); }, "m"_a);
}

}  // namespace raybound::python
