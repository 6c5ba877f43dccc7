#include "bindings/arrays.h"
#include "raybound/scene/material.h"

namespace raybound::python {

namespace {

Wrap wrap_named(const std::string& name) {
    if (name == "chart") return Wrap::chart;
    if (name == "repeat") return Wrap::repeat;
    if (name == "clamp") return Wrap::clamp;
    if (name == "mirror") return Wrap::mirror;
    throw std::invalid_argument("Texture: wrap must be 'chart', 'repeat', 'clamp' or 'mirror', got '" + name + "'");
}

std::shared_ptr<Texture> make_texture(const Floats& texels, float scale_u, float scale_v, const std::string& wrap_u,
                                      const std::string& wrap_v) {
    if (texels.ndim() != 3 || texels.shape(2) != 3)
        throw std::invalid_argument("Texture: image must have shape (h, w, 3)");
    const auto* first = reinterpret_cast<const Vec3f*>(texels.data());
    std::vector<Vec3f> values(first, first + texels.shape(0) * texels.shape(1));
    return std::make_shared<Texture>(std::move(values), int(texels.shape(1)), int(texels.shape(0)),
                                     UV<float>{scale_u, scale_v}, wrap_named(wrap_u), wrap_named(wrap_v));
}

Floats lookup(const Texture& texture, const Floats& uv, bool around) {
    if (uv.ndim() != 2 || uv.shape(1) != 2) throw std::invalid_argument("Texture: uv must have shape (n, 2)");
    std::vector<Vec3f> colours;
    for (py::ssize_t i = 0; i < uv.shape(0); ++i)
        colours.push_back(texture.lookup(UV<float>{uv.at(i, 0), uv.at(i, 1)}, around));
    return from_vectors(colours);
}

}  // namespace

void register_materials(py::module_& m) {
    py::class_<Texture, std::shared_ptr<Texture>>(m, "Texture", py::is_final())
        .def("lookup", &lookup, "uv"_a, "around"_a = false);
    py::class_<Material, std::shared_ptr<Material>>(m, "Material", py::is_final());
    py::class_<Light, std::shared_ptr<Light>>(m, "Light", py::is_final());

    m.def("texture", &make_texture, "texels"_a, "scale_u"_a, "scale_v"_a, "wrap_u"_a, "wrap_v"_a);
    m.def(
        "material",
        [](const Floats& diffuse, const std::shared_ptr<Texture>& texture, const Floats& specular, float roughness,
           const Floats& reflect, const Floats& transmit, float ior) {
            return std::const_pointer_cast<Material>(
                make_material({to_vec3<float>(diffuse), texture, to_vec3<float>(specular), to_vec3<float>(reflect),
                               to_vec3<float>(transmit), roughness, ior}));
        },
        "diffuse"_a, py::arg("texture").none(true), "specular"_a, "roughness"_a, "reflect"_a, "transmit"_a, "ior"_a);

    const auto result = [](LightPointer p) { return std::const_pointer_cast<Light>(p); };
    m.def(
        "directional_light",
        [=](const Floats& direction, const Floats& radiance) {
            return result(make_directional_light(to_vec3<float>(direction), to_vec3<float>(radiance)));
        },
        "direction"_a, "radiance"_a);
    m.def(
        "point_light",
        [=](const Floats& position, const Floats& intensity, bool falloff) {
            return result(make_point_light(to_vec3<float>(position), to_vec3<float>(intensity), falloff));
        },
        "position"_a, "intensity"_a, "falloff"_a);
    m.def(
        "spot_light",
        [=](const Floats& position, const Floats& direction, float cutoff, const Floats& intensity, bool falloff) {
            return result(make_spot_light(to_vec3<float>(position), to_vec3<float>(direction), cutoff,
                                          to_vec3<float>(intensity), falloff));
        },
        "position"_a, "direction"_a, "cutoff"_a, "intensity"_a, "falloff"_a);
}

}  // namespace raybound::python
