#include "bindings/arrays.h"
#include "raybound/geometry/ray.h"
#include "raybound/numbers/elementary.h"
#include "raybound/numbers/elementary_check.h"

namespace raybound::python {

namespace {

template <class T, class Function>
py::array map(const py::array& input, Function f) {
    const auto in = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(input);
    py::array_t<decltype(f(T()))> out(std::vector<py::ssize_t>(in.shape(), in.shape() + in.ndim()));
    for (py::ssize_t i = 0; i < in.size(); ++i) out.mutable_data()[i] = f(in.data()[i]);
    return out;
}

template <class Function>
py::array map_float_or_double(const py::array& array, Function f) {
    if (array.dtype().is(py::dtype::of<double>())) return map<double>(array, f);
    return map<float>(array, f);
}

Floats spawn_origins(const Floats& p, const Floats& p_error, const Floats& n, const Floats& w) {
    const auto points = to_vectors<float>(p), errors = to_vectors<float>(p_error), normals = to_vectors<float>(n),
               directions = to_vectors<float>(w);
    if (errors.size() != points.size() || normals.size() != points.size() || directions.size() != points.size())
        throw std::invalid_argument("spawn_origin: p, p_error, n and w must have the same shape");
    std::vector<Vec3f> origins;
    for (std::size_t i = 0; i < points.size(); ++i)
        origins.push_back(spawn_origin(points[i], errors[i], normals[i], directions[i]));
    return from_vectors(origins);
}

py::array elementary_values(const std::string& name, const Floats& x, const std::optional<Floats>& y) {
    if (name == "exp") return map<float>(x, [](float v) { return exp(v); });
    if (name == "acos") return map<float>(x, [](float v) { return acos(v); });
    if (name != "atan2" || !y || y->size() != x.size())
        throw std::invalid_argument("elementary: name must be 'exp', 'acos', or 'atan2' with x and y alike");
    Floats out(std::vector<py::ssize_t>(x.shape(), x.shape() + x.ndim()));
    for (py::ssize_t i = 0; i < x.size(); ++i) out.mutable_data()[i] = atan2(x.data()[i], y->data()[i]);
    return out;
}

}  // namespace

void register_numbers(py::module_& m) {
    m.def(
        "next_float_up",
        [](const py::array& a) { return map_float_or_double(a, [](auto x) { return next_float_up(x); }); }, "array"_a);
    m.def(
        "next_float_down",
        [](const py::array& a) { return map_float_or_double(a, [](auto x) { return next_float_down(x); }); },
        "array"_a);
    m.def(
        "float_bits", [](const py::array& a) { return map_float_or_double(a, [](auto x) { return float_bits(x); }); },
        "array"_a);
    m.def(
        "float_from_bits",
        [](const py::array& bits, bool wide) {
            if (wide) return map<std::uint64_t>(bits, [](std::uint64_t x) { return float_from_bits<double>(x); });
            return map<std::uint32_t>(bits, [](std::uint32_t x) { return float_from_bits<float>(x); });
        },
        "bits"_a, "double"_a);
    m.def(
        "epsilon",
        [](const Floats& x, float scale) { return map<float>(x, [scale](float v) { return epsilon(v, scale); }); },
        "x"_a, "scale"_a);
    m.def(
        "gamma", [](int n, bool wide) { return wide ? gamma<double>(n) : double(gamma<float>(n)); }, "n"_a, "double"_a);
    m.def("spawn_origin", &spawn_origins, "p"_a, "p_error"_a, "n"_a, "w"_a);
    m.def("elementary", &elementary_values, "name"_a, "x"_a, "y"_a = py::none());
    m.def(
        "check_elementary",
        [](const std::string& name, std::uint32_t first, std::uint64_t count, std::uint32_t stride) {
            const py::gil_scoped_release released;
            const ElementaryError worst = check_elementary(name, first, count, stride);
            return std::tuple(worst.ulp, worst.bits, worst.tested);
        },
        "name"_a, "first"_a, "count"_a, "stride"_a);
}

}  // namespace raybound::python
