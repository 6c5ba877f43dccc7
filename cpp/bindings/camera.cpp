#include "raybound/frame/camera.h"

#include "bindings/arrays.h"

namespace raybound::python {

namespace {

py::tuple camera_rays(const Camera& camera) {
    const std::vector<py::ssize_t> shape{camera.height(), camera.width(), 3};
    Floats origins(shape), directions(shape);
    auto* o = reinterpret_cast<Vec3f*>(origins.mutable_data());
    auto* d = reinterpret_cast<Vec3f*>(directions.mutable_data());
    for (int y = 0; y < camera.height(); ++y)
        for (int x = 0; x < camera.width(); ++x) {
            *o++ = camera.eye();
            *d++ = camera.direction<float>(x, y);
        }
    return py::make_tuple(origins, directions);
}

}  // namespace

void register_camera(py::module_& m) {
    py::class_<Camera>(m, "Camera", py::is_final())
        .def(py::init([](const Floats& eye, const Floats& target, const Floats& up, float fov, int width, int height) {
                 return Camera(to_vec3<float>(eye), to_vec3<float>(target), to_vec3<float>(up), fov, width, height);
             }),
             "eye"_a, "target"_a, "up"_a, "fov"_a, "width"_a, "height"_a)
        .def_property_readonly("eye", [](const Camera& c) { return from_vec3(c.eye()); })
        .def_property_readonly("target", [](const Camera& c) { return from_vec3(c.target()); })
        .def_property_readonly("up", [](const Camera& c) { return from_vec3(c.up()); })
        .def_property_readonly("fov", &Camera::fov)
        .def_property_readonly("width", &Camera::width)
        .def_property_readonly("height", &Camera::height)
        .def("rays", &camera_rays)
        .def("orbit", &Camera::orbit, "azimuth"_a, "elevation"_a)
        .def("dolly", &Camera::dolly, "distance"_a)
        .def("pan", &Camera::pan, "right"_a, "up"_a)
        .def("look", &Camera::look, "yaw"_a, "pitch"_a);
}

}  // namespace raybound::python
