#include "raybound/numbers/number_bench.h"

#include "bindings/arrays.h"
#include "raybound/numbers/number_trials.h"
#include "raybound/numbers/rounding.h"

namespace raybound::python {

namespace {

// `function` by name in one direction, element by element; b and c are read where it takes them.
template <class T, class Rounding>
py::array directed(const std::string& name, bool up, const py::array& a, const py::array& b, const py::array& c) {
    using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;
    const Array x(a), y(b), z(c);
    if (y.size() != x.size() || z.size() != x.size())
        throw std::invalid_argument("directed: a, b and c must have the same size");
    py::array_t<T> out(x.size());
    for (py::ssize_t i = 0; i < x.size(); ++i) {
        const T p = x.data()[i], q = y.data()[i], r = z.data()[i];
        T& result = out.mutable_data()[i];
        if (name == "add")
            result = up ? Rounding::add_up(p, q) : Rounding::add_down(p, q);
        else if (name == "subtract")
            result = up ? Rounding::subtract_up(p, q) : Rounding::subtract_down(p, q);
        else if (name == "multiply")
            result = up ? Rounding::multiply_up(p, q) : Rounding::multiply_down(p, q);
        else if (name == "divide")
            result = up ? Rounding::divide_up(p, q) : Rounding::divide_down(p, q);
        else if (name == "sqrt")
            result = up ? Rounding::sqrt_up(p) : Rounding::sqrt_down(p);
        else if (name == "fma")
            result = up ? Rounding::fma_up(p, q, r) : Rounding::fma_down(p, q, r);
        else
            throw std::invalid_argument("directed: unknown function '" + name + "'");
    }
    return out;
}

py::array directed_in(const std::string& name, bool up, const py::array& a, const py::array& b, const py::array& c,
                      const std::string& implementation) {
    const bool wide = a.dtype().is(py::dtype::of<double>());
#ifdef __AVX512F__
    if (implementation == "hardware")
        return wide ? directed<double, HardwareRounding>(name, up, a, b, c)
                    : directed<float, HardwareRounding>(name, up, a, b, c);
#endif
    if (implementation != "portable")
        throw std::invalid_argument("directed: implementation must be 'portable' or, with AVX-512, 'hardware', got '" +
                                    implementation + "'");
    return wide ? directed<double, PortableRounding>(name, up, a, b, c)
                : directed<float, PortableRounding>(name, up, a, b, c);
}

std::vector<std::string> implementations() {
#ifdef __AVX512F__
    return {"portable", "hardware"};
#else
    return {"portable"};
#endif
}

py::dict to_dict(const TrialCounts& c) {
    return py::dict("trials"_a = c.trials, "violations"_a = c.violations, "not_tight"_a = c.not_tight,
                    "differences"_a = c.differences, "first_failure"_a = c.first_failure, "inexact"_a = c.inexact,
                    "exact"_a = c.exact, "special"_a = c.special, "underflows"_a = c.underflows,
                    "overflows"_a = c.overflows, "cancellations"_a = c.cancellations, "points"_a = c.points,
                    "straddling"_a = c.straddling);
}

template <auto trials>
py::dict run(const std::string& operation, bool wide, const std::string& implementation, std::uint64_t seed,
             std::uint64_t count) {
    TrialCounts counts;
    {
        const py::gil_scoped_release released;
        counts = trials(operation, wide, implementation, seed, count);
    }
    return to_dict(counts);
}

}  // namespace

void register_number_bench(py::module_& m) {
    m.def("rounding_implementations", &implementations);
    m.def("directed", &directed_in, "name"_a, "up"_a, "a"_a, "b"_a, "c"_a, "implementation"_a);
    m.def("rounding_trials", &run<rounding_trials>, "operation"_a, "wide"_a, "implementation"_a, "seed"_a, "count"_a);
    m.def("interval_trials", &run<interval_trials>, "operation"_a, "wide"_a, "implementation"_a, "seed"_a, "count"_a);
    m.def("time_multiply_add", &time_multiply_add, "kind"_a, "n"_a, "repeats"_a,
          py::call_guard<py::gil_scoped_release>());
}

}  // namespace raybound::python
