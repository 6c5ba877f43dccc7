#include <optional>

#include "bindings/arrays.h"
#include "bindings/offsets.h"
#include "raybound/frame/closed_forms.h"
#include "raybound/frame/query.h"
#include "raybound/shapes/mesh.h"

namespace raybound::python {

namespace {

std::vector<Vec3d> doubles(const Doubles& a) {
    const auto v = to_vectors<double>(a);
    return {v.begin(), v.end()};
}

py::array_t<ShapeHitRecord> intersect(const ShapePointer& shape, const Doubles& origins, const Doubles& directions,
                                      const std::string& precision, const std::string& offsets, bool inward) {
    if (precision != "float32" && precision != "float64")
        throw std::invalid_argument("intersect: precision must be 'float32' or 'float64', got '" + precision + "'");
    const std::vector<Vec3d> o = doubles(origins), d = doubles(directions);
    if (o.size() != d.size()) throw std::invalid_argument("intersect: origins and directions must have the same shape");
    const Offsets policy = offsets_named("intersect", offsets);
    std::vector<ShapeHitRecord> records;
    const py::object silent = py::none();
    {
        const py::gil_scoped_release released;
        records = precision == "float32" ? intersect_shape<float>(*shape, o, d, policy, inward, watcher(silent))
                                         : intersect_shape<double>(*shape, o, d, policy, inward, watcher(silent));
    }
    return from_vector(records);
}

py::array closed_forms_of(const ShapePointer& shape, const Doubles& origins, const Doubles& directions, bool wide) {
    const std::vector<Vec3d> o = doubles(origins), d = doubles(directions);
    if (o.size() != d.size())
        throw std::invalid_argument("closed_forms: origins and directions must have the same shape");
    return from_vector(wide ? closed_forms<double>(*shape, o, d) : closed_forms<float>(*shape, o, d));
}

using Indices = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

template <class Item, class Array>
std::vector<Item> rows(const Array& a, py::ssize_t columns, const char* name) {
    if (a.ndim() != 2 || a.shape(1) != columns)
        throw std::invalid_argument(std::string("Mesh: ") + name + " must have shape (n, " + std::to_string(columns) +
                                    ")");
    const auto* first = reinterpret_cast<const Item*>(a.data());
    return {first, first + a.shape(0)};
}

ShapePointer mesh(const Floats& vertices, const Indices& faces, const std::optional<Floats>& normals,
                  const std::optional<Floats>& uvs) {
    auto v = rows<Vec3f>(vertices, 3, "vertices");
    auto f = rows<Face>(faces, 3, "faces");
    auto n = normals ? rows<Vec3f>(*normals, 3, "normals") : std::vector<Vec3f>{};
    auto t = uvs ? rows<UV<float>>(*uvs, 2, "uvs") : std::vector<UV<float>>{};
    const py::object silent = py::none();
    const py::gil_scoped_release released;
    return Shape::triangle_mesh(
        MeshData::make(std::move(v), std::move(f), std::move(n), std::move(t), watcher(silent)));
}

}  // namespace

void register_shapes(py::module_& m) {
    PYBIND11_NUMPY_DTYPE(ShapeHitRecord, hit, t, t_error, point, point_error, normal, uv, face_id, next_origin);
    PYBIND11_NUMPY_DTYPE(ClosedFormRecord, known, point, point_error);

    py::class_<Shape, std::shared_ptr<Shape>>(m, "Shape", py::is_final())
        .def("bounds", [](const Shape& s) { return from_bounds(shape_bounds(s, {})); })
        .def_property_readonly("is_solid", &Shape::is_solid)
        .def_property_readonly("face_count", &Shape::face_count)
        .def_property_readonly("primitive_count", &Shape::primitive_count);

    const auto result = [](ShapePointer p) {
        return std::const_pointer_cast<Shape>(p);
    };  // pybind11 holds no pointers to const
    m.def(
        "mesh",
        [=](const Floats& v, const Indices& f, const std::optional<Floats>& n, const std::optional<Floats>& t) {
            return result(mesh(v, f, n, t));
        },
        "vertices"_a, "faces"_a, "normals"_a, "uvs"_a);
    m.def(
        "sphere",
        [=](const Floats& center, float radius) { return result(Shape::sphere(to_vec3<float>(center), radius)); },
        "center"_a, "radius"_a);
    m.def(
        "box",
        [=](const Floats& lower, const Floats& upper) {
            return result(Shape::box(to_vec3<float>(lower), to_vec3<float>(upper)));
        },
        "min"_a, "max"_a);
    m.def(
        "cylinder",
        [=](const Floats& base, const Floats& top, float radius) {
            return result(Shape::cylinder(to_vec3<float>(base), to_vec3<float>(top), radius));
        },
        "base"_a, "top"_a, "radius"_a);
    m.def(
        "cone",
        [=](const Floats& base, const Floats& apex, float radius, float top_radius) {
            return result(Shape::cone(to_vec3<float>(base), to_vec3<float>(apex), radius, top_radius));
        },
        "base"_a, "apex"_a, "radius"_a, "top_radius"_a);
    m.def(
        "disk",
        [=](const Floats& center, const Floats& normal, float radius) {
            return result(Shape::disk(to_vec3<float>(center), to_vec3<float>(normal), radius));
        },
        "center"_a, "normal"_a, "radius"_a);
    m.def(
        "polygon",
        [=](const Floats& vertices) {
            const auto v = to_vectors<float>(vertices);
            return result(Shape::polygon({v.begin(), v.end()}));
        },
        "vertices"_a);
    m.def(
        "quadric",
        [=](const Floats& coefficients, const Floats& lower, const Floats& upper) {
            const float* c = coefficients.data();
            return result(Shape::quadric({c, c + coefficients.size()}, to_vec3<float>(lower), to_vec3<float>(upper)));
        },
        "coefficients"_a, "min"_a, "max"_a);
    using Parts = std::vector<std::shared_ptr<Shape>>;
    m.def(
        "csg_union", [=](const Parts& p) { return result(Shape::combine(ShapeKind::csg_union, {p.begin(), p.end()})); },
        "shapes"_a);
    m.def(
        "csg_intersection",
        [=](const Parts& p) { return result(Shape::combine(ShapeKind::csg_intersection, {p.begin(), p.end()})); },
        "shapes"_a);
    m.def(
        "csg_difference",
        [=](const Parts& p) { return result(Shape::combine(ShapeKind::csg_difference, {p.begin(), p.end()})); },
        "shapes"_a);
    m.def(
        "shape_contains",
        [](const std::shared_ptr<Shape>& shape, const Doubles& points) {
            const std::vector<Vec3d> p = doubles(points);
            std::vector<std::uint8_t> inside;
            const py::object silent = py::none();
            {
                const py::gil_scoped_release released;
                inside = shape_contains(*shape, p, watcher(silent));
            }
            py::array_t<bool> answer(py::ssize_t(inside.size()));
            std::copy(inside.begin(), inside.end(), answer.mutable_data());
            return answer;
        },
        "shape"_a, "points"_a);
    m.def(
        "transformed",
        [=](const std::shared_ptr<Shape>& shape, const Doubles& matrix) {
            return result(Shape::transformed(
                shape, checked_transform("Shape.transformed", to_affine("Shape.transformed", matrix))));
        },
        "shape"_a, "matrix"_a);
    m.def(
        "intersect_shape",
        [](const std::shared_ptr<Shape>& shape, const Doubles& o, const Doubles& d, const std::string& precision,
           const std::string& offsets, bool inward) { return intersect(shape, o, d, precision, offsets, inward); },
        "shape"_a, "origins"_a, "directions"_a, "precision"_a, "offsets"_a, "inward"_a = false);
    m.def(
        "closed_forms",
        [](const std::shared_ptr<Shape>& shape, const Doubles& o, const Doubles& d, bool wide) {
            return closed_forms_of(shape, o, d, wide);
        },
        "shape"_a, "origins"_a, "directions"_a, "double"_a);
}

}  // namespace raybound::python
