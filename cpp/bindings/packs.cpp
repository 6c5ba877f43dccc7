#include "bindings/arrays.h"
#include "raybound/geometry/ray.h"
#include "raybound/trace/pack_trials.h"

namespace raybound::python {

namespace {

void require_eights(std::size_t count, std::initializer_list<std::size_t> others) {
    for (const std::size_t other : others)
        if (other != count) throw std::invalid_argument("packs: arrays must have the same shape");
    if (count % pack_width != 0)
        throw std::invalid_argument("packs: rays must come in eights, got " + std::to_string(count));
}

py::array_t<PackHit> hits(const Snapshot& scene, const Floats& origins, const Floats& directions, bool packed) {
    const auto o = to_vectors<float>(origins), d = to_vectors<float>(directions);
    require_eights(o.size(), {d.size()});
    return from_vector(trial_hits(scene, o, d, packed));
}

py::array_t<std::uint8_t> blocked(const Snapshot& scene, const Floats& origins, const Floats& ends, bool directions,
                                  bool packed) {
    const auto o = to_vectors<float>(origins), e = to_vectors<float>(ends);
    require_eights(o.size(), {e.size()});
    return from_vector(trial_blocked(scene, o, e, directions, packed));
}

py::tuple light(const Snapshot& scene, std::uint32_t object, const Floats& points, const Floats& normals,
                const Floats& directions, bool packed) {
    const auto p = to_vectors<float>(points), n = to_vectors<float>(normals), d = to_vectors<float>(directions);
    require_eights(p.size(), {n.size(), d.size()});
    if (object >= scene.objects().size()) throw std::invalid_argument("packs: no such object");
    const PackLocalLight local = trial_light(scene, object, p, n, d, packed);
    return py::make_tuple(from_vector(local.lights), from_vector(local.rays));
}

// A function of one number, or of two.
template <class T>
T applied(const std::string& name, const T& x, const T& y) {
    if (name == "sqrt") return sqrt(x);
    if (name == "rsqrt") return rsqrt(x);
    if (name == "next_float_up") return next_float_up(x);
    if (name == "next_float_down") return next_float_down(x);
    if (name == "power_of_two_below") return power_of_two_below(x);
    if (name == "copysign") return copysign(x, y);
    if (name == "minimum") return minimum(x, y);
    if (name == "maximum") return maximum(x, y);
    if (name == "step_away") return step_away(x, T(0), y);
    if (name == "flush_component") return flush_component(x);
    if constexpr (std::is_same_v<Scalar<T>, float>) {
        if (name == "exp") return exp(x);
        if (name == "acos") return acos(x);
        if (name == "atan2") return atan2(x, y);
    }
    throw std::invalid_argument("packs: no such function");
}

template <class T>
using Numbers = py::array_t<T, py::array::c_style | py::array::forcecast>;

template <class T>
py::array_t<T> apply(const std::string& name, const Numbers<T>& x, const Numbers<T>& y, bool packed) {
    const auto count = std::size_t(x.size());
    require_eights(count, {std::size_t(y.size())});
    py::array_t<T> result(x.size());
    T* to = result.mutable_data();
    for (std::size_t i = 0; i < count; i += pack_width) {
        const auto all = applied(name, Pack<T>::load(x.data() + i), Pack<T>::load(y.data() + i));
        for (std::size_t k = i; k < i + pack_width; ++k)
            to[k] = packed ? all[int(k - i)] : applied(name, x.data()[k], y.data()[k]);
    }
    return result;
}

}  // namespace

void register_packs(py::module_& m) {
    PYBIND11_NUMPY_DTYPE(PackHit, hit, entering, face, primitive, leaf, t, t_error, point, point_error, normal, uv,
                         outer, inner, diffuse, crossing_t);
    PYBIND11_NUMPY_DTYPE(PackLight, direction, irradiance, factor, faces, shines, weighs);
    PYBIND11_NUMPY_DTYPE(PackSecondary, reflect, transmit, reflected, refracted, total);
    m.def("pack_apply", &apply<float>, "name"_a, "x"_a.noconvert(), "y"_a.noconvert(), "packed"_a);
    m.def("pack_apply", &apply<double>, "name"_a, "x"_a.noconvert(), "y"_a.noconvert(), "packed"_a);
    m.def("pack_hits", &hits, "scene"_a, "origins"_a, "directions"_a, "packed"_a);
    m.def("pack_blocked", &blocked, "scene"_a, "origins"_a, "ends"_a, "directions"_a, "packed"_a);
    m.def("pack_light", &light, "scene"_a, "object"_a, "points"_a, "normals"_a, "directions"_a, "packed"_a);
}

}  // namespace raybound::python
