#include "bindings/arrays.h"
#include "raybound/numbers/interval.h"
#include "raybound/numbers/interval_arrays.h"

namespace raybound::python {

namespace {

// Intervals come and go as arrays of shape (2, n), infs before sups; operands of an operation as (k, 2, n).

template <class I, class Function>
Doubles rows(const Doubles& x, int count, Function f) {
    using T = typename I::Value;
    if (x.ndim() != 2 || x.shape(0) != 2) throw std::invalid_argument("interval: ends must have shape (2, n)");
    const py::ssize_t n = x.shape(1);
    Doubles out({py::ssize_t(count), n});
    for (py::ssize_t i = 0; i < n; ++i) {
        const auto values = f(I::checked(static_cast<T>(x.data()[i]), static_cast<T>(x.data()[n + i])));
        for (int k = 0; k < count; ++k) out.mutable_data()[k * n + i] = double(values[std::size_t(k)]);
    }
    return out;
}

// mid, rad, wid, mag, mig of intervals with checked ends.
Doubles interval_measures(const Doubles& x, bool single) {
    const auto measure = [](const auto& i) { return std::array{i.mid(), i.rad(), i.wid(), i.mag(), i.mig()}; };
    return single ? rows<Interval<float>>(x, 5, measure) : rows<Interval<double>>(x, 5, measure);
}

// The interval of a number as kernels write constants.
Doubles interval_of(const Doubles& x, const std::string& kind) {
    const auto make = [&]<class I>(I) {
        Doubles out({py::ssize_t(2), x.size()});
        for (py::ssize_t i = 0; i < x.size(); ++i) {
            const I point(x.data()[i]);
            out.mutable_data()[i] = point.inf(), out.mutable_data()[x.size() + i] = point.sup();
        }
        return out;
    };
    if (kind == "double") return make(Interval<double>());
    if (kind == "float") return make(Interval<float>());
    if (kind == "double float32") return make(Interval<double, Arithmetic::float32>());
    throw std::invalid_argument("interval_of: unknown kind '" + kind + "'");
}

// a < b, a <= b, a > b, a >= b: 0 no, 1 yes, 2 unknown.
py::array_t<std::uint8_t> interval_comparisons(const Doubles& a, const Doubles& b) {
    if (a.ndim() != 2 || b.ndim() != 2 || a.shape(0) != 2 || b.shape(0) != 2 || a.shape(1) != b.shape(1))
        throw std::invalid_argument("interval_comparisons: a and b must have the same shape (2, n)");
    const py::ssize_t n = a.shape(1);
    py::array_t<std::uint8_t> out({py::ssize_t(4), n});
    for (py::ssize_t i = 0; i < n; ++i) {
        const Interval<double> x(a.data()[i], a.data()[n + i]), y(b.data()[i], b.data()[n + i]);
        const Verdict verdicts[] = {x<y, x <= y, x> y, x >= y};
        for (int k = 0; k < 4; ++k) out.mutable_data()[k * n + i] = static_cast<std::uint8_t>(verdicts[k]);
    }
    return out;
}

template <class T>
py::array array_operation(const std::string& name, const py::array& operands) {
    const auto in = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(operands);
    if (!in || in.ndim() != 3 || in.shape(0) < 1 || in.shape(0) > 3 || in.shape(1) != 2)
        throw std::invalid_argument("interval_array_operation: operands must have shape (k, 2, n), k = 1, 2 or 3");
    const py::ssize_t n = in.shape(2), last = in.shape(0) - 1;
    const auto operand = [&](py::ssize_t k) {
        const T* at = in.data() + 2 * n * std::min(k, last);
        return IntervalArray<const T>{at, at + n};
    };
    py::array_t<T> out({py::ssize_t(2), n});
    T* at = out.mutable_data();
    interval_array_operation<T>(name, operand(0), operand(1), operand(2), {at, at + n}, static_cast<std::size_t>(n));
    return out;
}

}  // namespace

void register_intervals(py::module_& m) {
    m.def("interval_measures", &interval_measures, "ends"_a, "single"_a);
    m.def("interval_of", &interval_of, "x"_a, "kind"_a);
    m.def("interval_comparisons", &interval_comparisons, "a"_a, "b"_a);
    m.def(
        "interval_array_operation",
        [](const std::string& name, const py::array& operands) {
            return operands.dtype().is(py::dtype::of<float>()) ? array_operation<float>(name, operands)
                                                               : array_operation<double>(name, operands);
        },
        "name"_a, "operands"_a);
}

}  // namespace raybound::python
