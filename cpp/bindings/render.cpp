#include "raybound/frame/render.h"

#include "bindings/arrays.h"
#include "bindings/offsets.h"
#include "bindings/origins.h"
#include "raybound/frame/query.h"

namespace raybound::python {

namespace {

// A read-only view of a buffer's array that keeps the buffer alive.
template <class T, class Element>
py::array_t<T> view(const std::shared_ptr<FrameBuffers>& buffers, LargeArray<Element>& data,
                    std::vector<py::ssize_t> shape) {
    py::array_t<T> array(std::move(shape), reinterpret_cast<const T*>(data.data()), py::cast(buffers));
    array.attr("flags").attr("writeable") = false;
    return array;
}

py::dict ray_counts(const RayCounts& r) {
    return py::dict("eye"_a = r.eye, "shadow"_a = r.shadow, "reflected"_a = r.reflected, "refracted"_a = r.refracted);
}

py::dict cell_counts(const CellCounts& c) {
    return py::dict("made"_a = c.made, "lit"_a = c.lit, "blocked"_a = c.blocked, "listed"_a = c.listed,
                    "refused"_a = c.refused);
}

RenderSettings settings_of(int max_depth, int threads, int stride) {
    RenderSettings settings;
    if (max_depth < 1 || threads < 0 || stride < 1)
        throw std::invalid_argument("render: max_depth and stride must be >= 1, threads >= 0");
    settings.max_depth = max_depth;
    settings.threads = threads;
    settings.stride = stride;
    return settings;
}

py::dict render_frame(const std::shared_ptr<Snapshot>& snapshot, const Camera& camera,
                      const std::shared_ptr<FrameBuffers>& buffers, int max_depth, int threads, int stride,
                      const std::string& precision, bool brute_force, Cells* cells, const py::object& progress) {
    RenderSettings settings = settings_of(max_depth, threads, stride);
    if (buffers->width != camera.width() || buffers->height != camera.height())
        throw std::invalid_argument("render: buffers must have the camera's size");
    if (precision != "float32" && precision != "float64")
        throw std::invalid_argument("render: precision must be 'float32' or 'float64', got '" + precision + "'");
    settings.precision = precision == "float64" ? Precision::float64 : Precision::float32;
    settings.acceleration = brute_force ? Acceleration::brute_force : Acceleration::bvh;
    RenderStatistics statistics;
    {
        const py::gil_scoped_release released;
        if (cells && stride == 1) {
            cells->begin_frame(*snapshot);
            statistics = render_exactly(*snapshot, camera, *buffers, *cells, settings, watcher(progress));
        } else {
            statistics = render(*snapshot, camera, *buffers, settings, watcher(progress));
        }
    }
    if (!progress.is_none()) progress(1.0);
    return py::dict("seconds"_a = statistics.seconds, "threads"_a = statistics.threads,
                    "rays"_a = ray_counts(statistics.rays), "tests"_a = statistics.tests,
                    "cells"_a = cell_counts(statistics.cells));
}

py::dict trace(const std::shared_ptr<Snapshot>& snapshot, const py::array& origins, const Floats& directions,
               int max_depth, int threads, const py::object& progress) {
    const RenderSettings settings = settings_of(max_depth, threads, 1);
    const auto d = to_vectors<float>(directions);
    const TracedRays result = with_origins("Renderer.trace", *snapshot, origins, [&](const RayOrigins& from) {
        if (from.size() != d.size())
            throw std::invalid_argument("Renderer.trace: origins and directions must have the same shape");
        const py::gil_scoped_release released;
        return trace_rays(*snapshot, from, {d.begin(), d.end()}, settings, watcher(progress));
    });
    std::vector<std::uint8_t> path;
    for (const std::int32_t id : result.object_id)
        path.push_back(std::uint8_t(id < 0 ? Path::background : Path::traced));
    return py::dict("radiance"_a = from_vectors(result.radiance), "object_id"_a = from_vector(result.object_id),
                    "path"_a = from_vector(path), "t"_a = from_vector(result.t),
                    "rays"_a = ray_counts(result.statistics.rays));
}

py::array_t<PathRecord> paths(const std::shared_ptr<Snapshot>& snapshot, const py::array& origins,
                              const Floats& directions, int max_depth, int threads) {
    const RenderSettings settings = settings_of(max_depth, threads, 1);
    const auto d = to_vectors<float>(directions);
    const py::object silent = py::none();
    return from_vector(with_origins("Renderer.paths", *snapshot, origins, [&](const RayOrigins& from) {
        if (from.size() != d.size())
            throw std::invalid_argument("Renderer.paths: origins and directions must have the same shape");
        const py::gil_scoped_release released;
        return trace_paths(*snapshot, from, {d.begin(), d.end()}, settings, watcher(silent));
    }));
}

py::dict closest_hits_dict(const Snapshot& scene, const Floats& origins, const Floats& directions, int threads) {
    const auto o = to_vectors<float>(origins), d = to_vectors<float>(directions);
    if (o.size() != d.size() || threads < 0)
        throw std::invalid_argument("closest_hits: origins and directions must have the same shape, threads >= 0");
    ClosestHits hits;
    const py::object silent = py::none();
    {
        const py::gil_scoped_release released;
        hits = closest_hits(scene, o, d, threads, watcher(silent));
    }
    return py::dict("t"_a = from_vector(hits.t), "object_id"_a = from_vector(hits.object_id),
                    "face_id"_a = from_vector(hits.face_id), "seconds"_a = hits.seconds);
}

py::tuple primary_hits_tuple(const Snapshot& scene, const Camera& camera, int threads) {
    if (threads < 0) throw std::invalid_argument("primary_hits: threads must be >= 0");
    PrimaryHits found;
    const py::object silent = py::none();
    {
        const py::gil_scoped_release released;
        found = primary_hits(scene, camera, threads, watcher(silent));
    }
    return py::make_tuple(found.hits, found.seconds);
}

py::dict bounces(const Snapshot& scene, const Doubles& origins, const Doubles& directions, const std::string& precision,
                 const std::string& offsets, bool skips, bool count) {
    const auto o = to_vectors<double>(origins), d = to_vectors<double>(directions);
    if (o.size() != d.size()) throw std::invalid_argument("trace_bounces: as many origins as directions are wanted");
    const Leaving leaving{offsets_named("trace_bounces", offsets), skips, count};
    Bounces counts;
    {
        const py::gil_scoped_release released;
        counts = precision == "float32" ? trace_bounces<float>(scene, o, d, leaving)
                                        : trace_bounces<double>(scene, o, d, leaving);
    }
    return py::dict("rays"_a = counts.rays, "hits"_a = counts.hits, "blocked"_a = counts.blocked,
                    "spawned"_a = counts.spawned, "nodes"_a = counts.visits.nodes,
                    "primitives"_a = counts.visits.primitives, "radiance"_a = counts.radiance,
                    "seconds"_a = counts.seconds);
}

py::tuple tuple_of(const Vec3d& v) { return py::make_tuple(v.x, v.y, v.z); }

py::dict tree_dict(const RayTreeNode& node) {
    static constexpr const char* kinds[] = {"eye", "reflected", "refracted"};
    static constexpr const char* verdicts[] = {"lit", "blocked", "behind", "outside cone"};
    py::list lights, children;
    for (const RayTreeLight& light : node.lights)
        lights.append(
            py::dict("id"_a = light.id, "verdict"_a = verdicts[int(light.verdict)], "blocker"_a = light.blocker));
    for (const RayTreeNode& child : node.children) children.append(tree_dict(child));
    return py::dict("kind"_a = kinds[int(node.kind)], "origin"_a = tuple_of(node.origin),
                    "direction"_a = tuple_of(node.direction), "hit"_a = node.hit, "object_id"_a = node.object,
                    "face_id"_a = node.face, "t"_a = node.t, "point"_a = tuple_of(node.point),
                    "normal"_a = tuple_of(node.normal), "radiance"_a = tuple_of(node.radiance), "lights"_a = lights,
                    "total_internal_reflection"_a = node.total_internal_reflection, "children"_a = children);
}

py::dict explain(const std::shared_ptr<Snapshot>& snapshot, const Camera& camera, int x, int y, int max_depth) {
    TraceSettings settings;
    settings.max_depth = max_depth;
    RayTreeNode root;
    {
        const py::gil_scoped_release released;
        root = Tracer<float>(*snapshot, settings)
                   .ray_tree(camera.eye(), camera.direction<float>(x, y), departure_at(*snapshot, camera.eye()));
    }
    return tree_dict(root);
}

}  // namespace

void register_render(py::module_& m) {
    using Pointer = std::shared_ptr<FrameBuffers>;
    py::class_<FrameBuffers, Pointer>(m, "FrameBuffers", py::is_final())
        .def(py::init<int, int>(), "width"_a, "height"_a)
        .def_property_readonly("image",
                               [](const Pointer& b) { return view<float>(b, b->image, {b->height, b->width, 3}); })
        .def_property_readonly("error_bound",
                               [](const Pointer& b) { return view<float>(b, b->error_bound, {b->height, b->width}); })
        .def_property_readonly("path",
                               [](const Pointer& b) { return view<std::uint8_t>(b, b->path, {b->height, b->width}); })
        .def_property_readonly("reason",
                               [](const Pointer& b) { return view<std::uint8_t>(b, b->reason, {b->height, b->width}); })
        .def_property_readonly(
            "object_id", [](const Pointer& b) { return view<std::int32_t>(b, b->object_id, {b->height, b->width}); })
        .def_property_readonly("depth",
                               [](const Pointer& b) { return view<float>(b, b->depth, {b->height, b->width}); });
    m.def("render", &render_frame, "snapshot"_a, "camera"_a, "buffers"_a, py::kw_only(), "max_depth"_a, "threads"_a,
          "stride"_a, "precision"_a, "brute_force"_a, "cells"_a = py::none(), "progress"_a = py::none());
    m.def("trace", &trace, "snapshot"_a, "origins"_a, "directions"_a, py::kw_only(), "max_depth"_a, "threads"_a,
          "progress"_a);
    PYBIND11_NUMPY_DTYPE(PathRecord, ray, parent, kind, depth, origin, point, t, object_id, face_id, weight);
    m.def("paths", &paths, "snapshot"_a, "origins"_a, "directions"_a, py::kw_only(), "max_depth"_a, "threads"_a);
    m.def("closest_hits", &closest_hits_dict, "snapshot"_a, "origins"_a, "directions"_a, py::kw_only(), "threads"_a);
    m.def("primary_hits", &primary_hits_tuple, "snapshot"_a, "camera"_a, py::kw_only(), "threads"_a);
    m.def("trace_bounces", &bounces, "snapshot"_a, "origins"_a, "directions"_a, py::kw_only(), "precision"_a,
          "offsets"_a, "skips"_a, "count"_a = false);
    m.def("explain", &explain, "snapshot"_a, "camera"_a, "x"_a, "y"_a, "max_depth"_a);
}

}  // namespace raybound::python
