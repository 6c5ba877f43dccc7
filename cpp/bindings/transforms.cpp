#include "bindings/arrays.h"
#include "raybound/geometry/rotation.h"
#include "raybound/geometry/transform_error.h"
#include "raybound/shapes/shape.h"

namespace raybound::python {

namespace {

Affine rotation_about(double degrees, const Vec3d& axis) {
    if (!(length(axis) > 0)) throw std::invalid_argument("Transform.rotate: axis must not be zero");
    return rotation(normalize(axis), degrees);
}

// Row i of values, and of errors, which are rounded up.
template <class T>
WithError<T> row(std::span<const Vec3d> values, std::span<const Vec3d> errors, std::size_t i) {
    WithError<T> result{Vec3<T>(values[i]), {}};
    for (int k = 0; k < 3; ++k) result.error[k] = Interval<T>(errors[i][k]).sup();
    return result;
}

void check_lengths(std::size_t count, std::initializer_list<std::size_t> others) {
    for (const std::size_t other : others)
        if (other != count) throw std::invalid_argument("transform: all arrays must have one length");
}

template <class T>
py::tuple points(const Affine& transform, bool vectors, const Doubles& p, const Doubles& error) {
    const auto values = to_vectors<double>(p), errors = to_vectors<double>(error);
    check_lengths(values.size(), {errors.size()});
    const Mat3<T> linear(transform.linear);
    const Vec3<T> offset = vectors ? Vec3<T>{} : Vec3<T>(transform.offset);
    std::vector<Vec3<T>> to, bounds;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const WithError<T> image = transformed(linear, offset, row<T>(values, errors, i));
        to.push_back(image.value);
        bounds.push_back(image.error);
    }
    return py::make_tuple(from_vectors(to), from_vectors(bounds));
}

// origin, direction, their errors, moved and t_max, in this order.
template <class T>
py::tuple rays(const Affine& transform, const std::array<Doubles, 4>& given, const Doubles& t_max) {
    std::array<std::span<const Vec3d>, 4> in;
    for (std::size_t k = 0; k < in.size(); ++k) in[k] = to_vectors<double>(given[k]);
    const auto& [origins, directions, origin_errors, direction_errors] = in;
    check_lengths(origins.size(),
                  {directions.size(), origin_errors.size(), direction_errors.size(), std::size_t(t_max.size())});
    std::array<std::vector<Vec3<T>>, 4> out;
    std::vector<T> moved, ends;
    for (std::size_t i = 0; i < origins.size(); ++i) {
        const TransformedRay<T> ray =
            transformed_ray(Mat3<T>(transform.linear), Vec3<T>(transform.offset), row<T>(origins, origin_errors, i),
                            row<T>(directions, direction_errors, i), T(t_max.data()[i]));
        out[0].push_back(ray.origin.value);
        out[1].push_back(ray.direction.value);
        out[2].push_back(ray.origin.error);
        out[3].push_back(ray.direction.error);
        moved.push_back(ray.moved);
        ends.push_back(ray.t_max);
    }
    return py::make_tuple(from_vectors(out[0]), from_vectors(out[1]), from_vectors(out[2]), from_vectors(out[3]),
                          from_vector(moved), from_vector(ends));
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
    m.def(
        "transform_points",
        [](const Doubles& a, bool vectors, const Doubles& p, const Doubles& error, bool wide) {
            const Affine transform = to_affine("Transform", a);
            return wide ? points<double>(transform, vectors, p, error) : points<float>(transform, vectors, p, error);
        },
        "m"_a, "vectors"_a, "p"_a, "error"_a, "double"_a);
    m.def(
        "transform_rays",
        [](const Doubles& a, const std::array<Doubles, 4>& given, const Doubles& t_max, bool wide) {
            const Affine transform = to_affine("Transform", a);
            return wide ? rays<double>(transform, given, t_max) : rays<float>(transform, given, t_max);
        },
        "m"_a, "rays"_a, "t_max"_a, "double"_a);
}

}  // namespace raybound::python
