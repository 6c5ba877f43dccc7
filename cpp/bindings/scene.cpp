#include "bindings/arrays.h"
#include "bindings/origins.h"
#include "raybound/frame/query.h"
#include "raybound/scene/document.h"

namespace raybound::python {

namespace {

// Calls answer(origins, ends) with the GIL released, where origins are points or records of hits.
template <class Answer>
auto ask(const char* who, const Snapshot& scene, const py::array& origins, const Floats& ends, const Answer& answer) {
    return with_origins(who, scene, origins, [&](const RayOrigins& from) {
        const auto to = to_vectors<float>(ends);
        if (from.size() != to.size())
            throw std::invalid_argument(std::string(who) + ": both arguments must have the same shape");
        const py::object silent = py::none();
        const py::gil_scoped_release released;
        return answer(from, to, watcher(silent));
    });
}

py::array_t<bool> bools(const std::vector<std::uint8_t>& values) {
    py::array_t<bool> result(py::ssize_t(values.size()));
    std::copy(values.begin(), values.end(), result.mutable_data());
    return result;
}

py::array_t<HitRecord> intersect(const Snapshot& scene, const py::array& origins, const Floats& directions) {
    return from_vector(ask("Scene.intersect", scene, origins, directions,
                           [&](const RayOrigins& from, std::span<const Vec3f> along, const Watch& watch) {
                               return intersect_rays(scene, from, along, watch);
                           }));
}

py::tuple intersect_all_tuple(const Snapshot& scene, const py::array& origins, const Floats& directions) {
    const AllHits all = ask("Scene.intersect_all", scene, origins, directions,
                            [&](const RayOrigins& from, std::span<const Vec3f> along, const Watch& watch) {
                                return intersect_all(scene, from, along, watch);
                            });
    return py::make_tuple(from_vector(all.records), from_vector(all.offsets));
}

py::array_t<bool> occluded_array(const Snapshot& scene, const py::array& origins, const Floats& targets) {
    return bools(ask("Scene.occluded", scene, origins, targets,
                     [&](const RayOrigins& from, std::span<const Vec3f> to, const Watch& watch) {
                         return occluded(scene, from, to, watch);
                     }));
}

py::tuple containing_tuple(const Snapshot& scene, const Floats& points) {
    const auto p = to_vectors<float>(points);
    Containing all;
    const py::object silent = py::none();
    {
        const py::gil_scoped_release released;
        all = containing(scene, p, watcher(silent));
    }
    return py::make_tuple(from_vector(all.object_ids), from_vector(all.offsets));
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
    PYBIND11_NUMPY_DTYPE(HitRecord, hit, t, t_error, point, point_error, normal, uv, object_id, face_id, entering,
                         within_id, touching, direction, seal);
    m.attr("hit_record") = py::dtype::of<HitRecord>();

    py::class_<Snapshot, std::shared_ptr<Snapshot>>(m, "Snapshot", py::is_final())
        .def_property_readonly("revision", &Snapshot::revision)
        .def_property_readonly("object_count", [](const Snapshot& s) { return s.objects().size(); })
        .def_property_readonly("primitive_count", [](const Snapshot& s) { return s.geometry().leaves.size(); })
        .def_property_readonly("light_count", [](const Snapshot& s) { return s.lights().size(); })
        .def_property_readonly("bytes", &Snapshot::bytes)
        .def("intersect", &intersect, "origins"_a, "directions"_a)
        .def("intersect_all", &intersect_all_tuple, "origins"_a, "directions"_a)
        .def("occluded", &occluded_array, "origins"_a, "targets"_a)
        .def("containing", &containing_tuple, "points"_a);
    register_document(m);
}

}  // namespace raybound::python
