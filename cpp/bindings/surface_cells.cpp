#include "bindings/arrays.h"
#include "raybound/certify/cells.h"

namespace raybound::python {

namespace {

// One dictionary of arrays for all cells of an object: what linetrees() and pictures are made of.
py::dict views_dict(const Cells& cells, const Snapshot& scene, std::int32_t object) {
    const std::vector<Cells::View> views = cells.views(scene, object);
    const std::size_t n = views.size(), lights = scene.lights().size();
    std::vector<std::int32_t> face, piece, depth;
    std::vector<std::uint8_t> outward, leaf;
    std::vector<double> rectangle, patch;
    std::vector<std::int32_t> candidates;
    for (const Cells::View& view : views) {
        face.push_back(view.face);
        piece.push_back(view.piece);
        depth.push_back(view.depth);
        outward.push_back(view.outward);
        leaf.push_back(view.leaf);
        const ChartRectangle& r = view.rectangle;
        rectangle.insert(rectangle.end(), {r.center_u, r.center_v, r.half_u, r.half_v});
        for (const Vec3d& v : {view.patch.center, view.patch.axis[0], view.patch.axis[1], view.patch.axis[2]})
            patch.insert(patch.end(), {v.x, v.y, v.z});
        candidates.insert(candidates.end(), view.candidates.begin(), view.candidates.end());
    }
    const auto table = [](const auto& values, std::vector<py::ssize_t> shape) {
        return from_vector(values).attr("reshape")(shape);
    };
    const auto rows = py::ssize_t(n);
    return py::dict("face"_a = from_vector(face), "piece"_a = from_vector(piece), "depth"_a = from_vector(depth),
                    "outward"_a = from_vector(outward), "leaf"_a = from_vector(leaf),
                    "rectangle"_a = table(rectangle, {rows, 4}), "patch"_a = table(patch, {rows, 4, 3}),
                    "candidates"_a = table(candidates, {rows, py::ssize_t(lights)}));
}

// The smallest cell around a point of a face, or None.
py::object view_at(const Cells& cells, const Snapshot& scene, std::int32_t object, std::int32_t face,
                   const std::array<double, 3>& point) {
    const auto view = cells.view_at(scene, object, face, {point[0], point[1], point[2]});
    if (!view) return py::none();
    std::vector<std::int32_t> lights;
    for (const LightRecord& light : scene.lights()) lights.push_back(light.id);
    return py::dict("face"_a = view->face, "piece"_a = view->piece, "depth"_a = view->depth,
                    "outward"_a = view->outward, "lights"_a = lights, "candidates"_a = view->candidates);
}

// For each primitive: 0 no, 1 yes, 2 unknown; and for yes the distances from the origins.
py::dict bundle_hits(const Snapshot& scene, const Doubles& patch, const Floats& target, bool directional) {
    const auto rows = to_vectors<double>(patch);
    const auto ends = to_vectors<float>(target);
    if (rows.size() != 4 || ends.size() != 1)
        throw std::invalid_argument("bundle_hits: patch must have the shape (4, 3) and target (1, 3)");
    const Patch origins{rows[0], {rows[1], rows[2], rows[3]}};
    const Bundle bundle = directional ? Bundle::along(origins, ends[0]) : Bundle::toward_point(origins, ends[0]);
    std::vector<std::uint8_t> verdicts;
    std::vector<double> nearest, farthest;
    for (const Primitive& primitive : scene.geometry().primitives) {
        const BundleHits found = hits(bundle, scene.geometry(), primitive);
        verdicts.push_back(std::uint8_t(found.verdict));
        nearest.push_back(found.nearest);
        farthest.push_back(found.farthest);
    }
    return py::dict("verdict"_a = from_vector(verdicts), "nearest"_a = from_vector(nearest),
                    "farthest"_a = from_vector(farthest));
}

}  // namespace

void register_surface_cells(py::module_& m) {
    py::class_<Cells>(m, "Cells", py::is_final())
        .def(py::init<std::size_t, bool>(), "memory"_a, py::kw_only(), "keeps_blocks"_a = true)
        .def("clear", &Cells::clear)
        .def_property_readonly("bytes", &Cells::bytes)
        .def_property_readonly("count", &Cells::count)
        .def_property_readonly("block_bytes", [](const Cells& cells) { return cells.blocks().bytes(); })
        .def("views", &views_dict, "snapshot"_a, "object"_a)
        .def("view_at", &view_at, "snapshot"_a, "object"_a, "face"_a, "point"_a);
    m.def("bundle_hits", &bundle_hits, "snapshot"_a, "patch"_a, "target"_a, py::kw_only(), "directional"_a);
}

}  // namespace raybound::python
