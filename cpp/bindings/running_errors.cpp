#include "bindings/number_rows.h"
#include "raybound/numbers/running_error_functions.h"

namespace raybound::python {

namespace {

// A number is a row: value, lower, upper.
template <class T>
T load(const double* row) {
    using V = typename T::Value;
    return T(static_cast<V>(row[0]), typename T::Enclosure(static_cast<V>(row[1]), static_cast<V>(row[2])));
}
template <class T>
void store(const T& x, double* row) {
    row[0] = x.value(), row[1] = x.lower(), row[2] = x.upper();
}

// Calls f with a number of float or double, whose shadow checks.
template <class Function>
void with_type(bool wide, Function f) {
    if (wide) return f(RunningError<double, HighPrecision<double>>());
    f(RunningError<float, HighPrecision<float>>());
}

// select(a < b, a, b), and per row what is certain of a < b (0 no, 1 yes, 2 unknown) and what the plain kernel says.
py::tuple running_error_lesser(const Doubles& a, const Doubles& b, bool wide) {
    const std::vector<Doubles> arrays{a, b};
    const Operands rows(arrays, 3);
    Doubles out({rows.count(), py::ssize_t(3)});
    py::array_t<int> answers({rows.count(), py::ssize_t(2)});
    with_type(wide, [&]<class T>(T) {
        for (py::ssize_t i = 0; i < rows.count(); ++i) {
            const T x = load<T>(rows.at(i, 0)), y = load<T>(rows.at(i, 1));
            store(select(x < y, x, y), out.mutable_data() + 3 * i);
            answers.mutable_data()[2 * i] = static_cast<int>((x < y).certain);
            answers.mutable_data()[2 * i + 1] = (x < y).computed;
        }
    });
    return py::make_tuple(out, answers);
}

// An addition whose enclosure forgets the second operand: the shadow must see it.
struct BrokenAddition {
    template <class T>
    auto operator()(T a, T b) const {
        if constexpr (requires { a.inf(); })
            return a;
        else
            return a + b;
    }
};

void running_error_broken_addition(double a, double b, bool wide) {
    with_type(wide, [&]<class T>(T) { T::apply("broken addition", 0, true, BrokenAddition{}, T(a), T(b)); });
}

}  // namespace

void register_running_errors(py::module_& m) {
    m.def("running_error_lesser", &running_error_lesser, "a"_a, "b"_a, "double"_a);
    m.def("running_error_broken_addition", &running_error_broken_addition, "a"_a, "b"_a, "double"_a);
}

}  // namespace raybound::python
