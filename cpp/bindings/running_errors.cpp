#include "bindings/number_operations.h"
#include "raybound/numbers/running_error_quadratic.h"

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

// Calls f with a number type's name: float or double, its shadow checking or not.
template <class Function>
auto with_type(bool wide, bool shadow, Function f) {
    if (wide) return shadow ? f(RunningError<double, HighPrecision<double>>()) : f(RunningError<double, NoShadow>());
    return shadow ? f(RunningError<float, HighPrecision<float>>()) : f(RunningError<float, NoShadow>());
}

Doubles running_error_operation(const std::string& name, const std::vector<Doubles>& arrays, double parameter,
                                bool wide, bool shadow) {
    const Operands rows(arrays, 3);
    Doubles out({rows.count(), py::ssize_t(3)});
    with_type(wide, shadow, [&]<class T>(T) {
        for (py::ssize_t i = 0; i < rows.count(); ++i)
            store(operate<T>(name, {load<T>(rows.at(i, 0)), load<T>(rows.at(i, 1)), load<T>(rows.at(i, 2))}, parameter),
                  out.mutable_data() + 3 * i);
    });
    return out;
}

// error and relative_error, (n, 2).
Doubles running_error_sizes(const Doubles& x, bool wide) {
    const std::vector<Doubles> arrays{x};
    const Operands rows(arrays, 3);
    Doubles out({rows.count(), py::ssize_t(2)});
    with_type(wide, false, [&]<class T>(T) {
        for (py::ssize_t i = 0; i < rows.count(); ++i) {
            const T number = load<T>(rows.at(i, 0));
            out.mutable_data()[2 * i] = number.error();
            out.mutable_data()[2 * i + 1] = number.relative_error();
        }
    });
    return out;
}

// The two roots as rows of six, and per row the verdict (0 no, 1 yes, 2 unknown) and what the plain kernel says.
py::tuple running_error_quadratic(const std::vector<Doubles>& coefficients, bool wide, bool shadow) {
    const Operands rows(coefficients, 3);
    Doubles roots({rows.count(), py::ssize_t(6)});
    py::array_t<int> answers({rows.count(), py::ssize_t(2)});
    with_type(wide, shadow, [&]<class T>(T) {
        for (py::ssize_t i = 0; i < rows.count(); ++i) {
            T low, high;
            const RunningVerdict real =
                quadratic(load<T>(rows.at(i, 0)), load<T>(rows.at(i, 1)), load<T>(rows.at(i, 2)), &low, &high);
            store(low, roots.mutable_data() + 6 * i);
            store(high, roots.mutable_data() + 6 * i + 3);
            answers.mutable_data()[2 * i] = static_cast<int>(real.certain);
            answers.mutable_data()[2 * i + 1] = real.computed;
        }
    });
    return py::make_tuple(roots, answers);
}

// select(a < b, a, b), with the comparison's answers as above.
py::tuple running_error_lesser(const Doubles& a, const Doubles& b, bool wide) {
    const std::vector<Doubles> arrays{a, b};
    const Operands rows(arrays, 3);
    Doubles out({rows.count(), py::ssize_t(3)});
    py::array_t<int> answers({rows.count(), py::ssize_t(2)});
    with_type(wide, true, [&]<class T>(T) {
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
    with_type(wide, true, [&]<class T>(T) { T::apply("broken addition", 0, true, BrokenAddition{}, T(a), T(b)); });
}

}  // namespace

void register_running_errors(py::module_& m) {
    m.def("running_error_operation", &running_error_operation, "name"_a, "operands"_a, "parameter"_a, "double"_a,
          "shadow"_a);
    m.def("running_error_sizes", &running_error_sizes, "numbers"_a, "double"_a);
    m.def("running_error_quadratic", &running_error_quadratic, "coefficients"_a, "double"_a, "shadow"_a);
    m.def("running_error_lesser", &running_error_lesser, "a"_a, "b"_a, "double"_a);
    m.def("running_error_broken_addition", &running_error_broken_addition, "a"_a, "b"_a, "double"_a);
}

}  // namespace raybound::python
