#include "bindings/number_kinds.h"
#include "raybound/numbers/interval.h"
#include "raybound/numbers/interval_functions.h"

namespace raybound::python {

template <class T, Arithmetic A, class R>
struct Record<Interval<T, A, R>> {
    using Value = T;
    static constexpr int width = 2;
    static Interval<T, A, R> load(const T* p) { return {p[0], p[1]}; }
    static void store(const Interval<T, A, R>& x, T* p) {
        p[0] = x.inf();
        p[1] = x.sup();
    }
};

namespace {

// The operations of sets, beside those of numbers.
template <class I>
void register_intervals(const std::string& name) {
    register_kind<I>(name);
    auto& operations = number_kinds()[name].operations;
    operations["hull"] = [](const std::vector<py::array>& a, double) {
        return apply_to_records<I, 2>(a, [](const auto& x) { return hull(x[0], x[1]); });
    };
    operations["select_by_less"] = [](const std::vector<py::array>& a, double) {
        return apply_to_records<I, 2>(a, [](const auto& x) { return select(x[0] < x[1], x[0], x[1]); });
    };
    operations["intersection"] = [](const std::vector<py::array>& a, double) {
        return apply_to_records<I, 2>(a, [](const auto& x) { return intersection(x[0], x[1]); });
    };
}

// mid, rad, wid, mag, mig of each: (n, 5).
template <class T>
py::array properties_of(const py::array& intervals) {
    const auto in = Records<Interval<T>>::ensure(intervals);
    py::array_t<T> out({in.size() / 2, py::ssize_t(5)});
    for (py::ssize_t i = 0; i < in.size() / 2; ++i) {
        const auto x = Record<Interval<T>>::load(in.data() + 2 * i);
        const T values[] = {x.mid(), x.rad(), x.wid(), x.mag(), x.mig()};
        std::copy(values, values + 5, out.mutable_data() + 5 * i);
    }
    return out;
}

py::array properties(const py::array& intervals) {
    return intervals.dtype().is(py::dtype::of<float>()) ? properties_of<float>(intervals)
                                                        : properties_of<double>(intervals);
}

// The tightest float intervals that hold numbers: (n, 2).
Floats points(const Doubles& values) {
    Floats out({values.size(), py::ssize_t(2)});
    for (py::ssize_t i = 0; i < values.size(); ++i)
        Record<Interval<float>>::store(Interval<float>(values.data()[i]), out.mutable_data() + 2 * i);
    return out;
}

}  // namespace

void register_interval_kinds(py::module_& m) {
    register_intervals<Interval<double>>("interval_float64");
    register_intervals<Interval<float>>("interval_float32");
    register_intervals<Interval<double, Arithmetic::float32>>("interval_float64_executed");
    register_intervals<Interval<float, Arithmetic::float32>>("interval_float32_executed");
    register_intervals<Interval<double, Arithmetic::real, PortableRounding>>("interval_float64_portable");
    register_intervals<Interval<float, Arithmetic::real, PortableRounding>>("interval_float32_portable");
    m.def("interval_properties", &properties, "intervals"_a);
    m.def("interval_points", &points, "values"_a);
}

}  // namespace raybound::python
