#include "bindings/arrays.h"
#include "raybound/frame/query.h"
#include "raybound/scene/document.h"

namespace raybound::python {

namespace {

py::array_t<HitRecord> intersect(const Snapshot& scene, const Floats& origins, const Floats& directions) {
    const auto o = to_vectors<float>(origins), d = to_vectors<float>(directions);
    if (o.size() != d.size())
        throw std::invalid_argument("Scene.intersect: origins and directions must have the same shape");
    std::vector<HitRecord> records;
    const py::object silent = py::none();
    {
        const py::gil_scoped_release released;
        records = intersect_rays(scene, o, d, watcher(silent));
    }
    return from_vector(records);
}

py::array_t<bool> occluded_array(const Snapshot& scene, const Floats& origins, const Floats& targets) {
    const auto o = to_vectors<float>(origins), t = to_vectors<float>(targets);
    if (o.size() != t.size())
        throw std::invalid_argument("Scene.occluded: origins and targets must have the same shape");
    std::vector<std::uint8_t> blocked;
    const py::object silent = py::none();
    {
        const py::gil_scoped_release released;
        blocked = occluded(scene, o, t, watcher(silent));
    }
    py::array_t<bool> result(py::ssize_t(blocked.size()));
    std::copy(blocked.begin(), blocked.end(), result.mutable_data());
    return result;
}

void register_document(py::module_& m) {
    using ShapeArgument = std::shared_ptr<Shape>;
    using MaterialArgument = std::shared_ptr<Material>;
    using LightArgument = std::shared_ptr<Light>;
    py::class_<Document, std::shared_ptr<Document>>(m, "Document", py::is_final())
        .def(py::init([](const Floats& ambient, const Floats& background) {
                 return std::make_shared<Document>(to_vec3<float>(ambient), to_vec3<float>(background));
             }),
             "ambient"_a, "background"_a)
        .def(
            "add_object",
            [](Document& d, const ShapeArgument& shape, const MaterialArgument& material, const Doubles& matrix) {
                return d.add_object(shape, material, to_affine("Scene.add: transform", matrix));
            },
            "shape"_a, "material"_a, "matrix"_a)
        .def(
            "set_object",
            [](Document& d, int id, const ShapeArgument& shape, const MaterialArgument& material,
               const Doubles& matrix) { d.set_object(id, shape, material, to_affine("Object: transform", matrix)); },
            "id"_a, "shape"_a, "material"_a, "matrix"_a)
        .def("remove_object", &Document::remove_object, "id"_a)
        .def(
            "add_light", [](Document& d, const LightArgument& light) { return d.add_light(light); }, "light"_a)
        .def(
            "set_light", [](Document& d, int id, const LightArgument& light) { d.set_light(id, light); }, "id"_a,
            "light"_a)
        .def("remove_light", &Document::remove_light, "id"_a)
        .def(
            "set_ambient", [](Document& d, const Floats& ambient) { d.set_ambient(to_vec3<float>(ambient)); },
            "ambient"_a)
        .def(
            "set_background",
            [](Document& d, const Floats& background) { d.set_background(to_vec3<float>(background)); }, "background"_a)
        .def("begin_edit", &Document::begin_edit)
        .def("commit_edit", &Document::commit_edit)
        .def("rollback_edit", &Document::rollback_edit)
        .def_property_readonly("revision", &Document::revision)
        .def(
            "object_bounds", [](const Document& d, int id) { return from_bounds(d.object_bounds(id)); }, "id"_a)
        .def("bounds",
             [](const Document& d) -> py::object {
                 const auto box = d.bounds();
                 return box ? py::object(from_bounds(*box)) : py::none();
             })
        .def("snapshot",
             [](const Document& d) {
                 const py::object silent = py::none();
                 const py::gil_scoped_release released;
                 return std::const_pointer_cast<Snapshot>(d.snapshot(watcher(silent)));
             })
        .def("copy", [](const Document& d) { return std::make_shared<Document>(d); });
}

}  // namespace

void register_scene(py::module_& m) {
    PYBIND11_NUMPY_DTYPE(HitRecord, hit, t, t_error, point, point_error, normal, uv, object_id, face_id);

    py::class_<Snapshot, std::shared_ptr<Snapshot>>(m, "Snapshot", py::is_final())
        .def_property_readonly("revision", &Snapshot::revision)
        .def_property_readonly("object_count", [](const Snapshot& s) { return s.objects().size(); })
        .def_property_readonly("primitive_count", [](const Snapshot& s) { return s.geometry().leaves.size(); })
        .def_property_readonly("light_count", [](const Snapshot& s) { return s.lights().size(); })
        .def_property_readonly("bytes", &Snapshot::bytes)
        .def("intersect", &intersect, "origins"_a, "directions"_a)
        .def("occluded", &occluded_array, "origins"_a, "targets"_a);
    register_document(m);
}

}  // namespace raybound::python
