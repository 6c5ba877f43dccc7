#include "bindings/number_operations.h"
#include "raybound/numbers/linear_interval_functions.h"

namespace raybound::python {

namespace {

// A number is a row: inf and sup of the constant, of each slope, and of the range.
template <class T>
constexpr py::ssize_t row_size = 2 * (T::variables + 2);

template <class T>
T load(const double* row) {
    const auto bound = [row](int k) { return typename T::Bound(row[2 * k], row[2 * k + 1]); };
    typename T::Slopes slopes;
    for (int i = 0; i < T::variables; ++i) slopes[i] = bound(1 + i);
    return T(bound(0), slopes, bound(T::variables + 1));
}
template <class T>
void store(const T& x, double* row) {
    const auto put = [row](int k, const typename T::Bound& b) { row[2 * k] = b.inf(), row[2 * k + 1] = b.sup(); };
    put(0, x.constant());
    for (int i = 0; i < T::variables; ++i) put(1 + i, x.slope(i));
    put(T::variables + 1, x.range());
}

template <int N, class Function>
auto with_rule(const std::string& rule, Function f) {
    if (rule == "hansen") return f(LinearInterval<N, LinearRule::hansen>());
    if (rule == "second-order") return f(LinearInterval<N, LinearRule::second_order>());
    if (rule == "second-order-slopes") return f(LinearInterval<N, LinearRule::second_order_slopes>());
    throw std::invalid_argument(
        "LinearInterval: rule must be 'hansen', 'second-order' or 'second-order-slopes', got '" + rule + "'");
}
template <class Function>
auto with_type(int variables, const std::string& rule, Function f) {
    if (variables == 1) return with_rule<1>(rule, f);
    if (variables == 2) return with_rule<2>(rule, f);
    if (variables == 4) return with_rule<4>(rule, f);
    throw std::invalid_argument("LinearInterval: variables must be 1, 2 or 4, got " + std::to_string(variables));
}

Doubles linear_interval_operation(const std::string& name, const std::vector<Doubles>& arrays, double parameter,
                                  int variables, const std::string& rule) {
    return with_type(variables, rule, [&]<class T>(T) {
        const Operands rows(arrays, row_size<T>);
        Doubles out({rows.count(), row_size<T>});
        for (py::ssize_t i = 0; i < rows.count(); ++i)
            store(operate<T>(name, {load<T>(rows.at(i, 0)), load<T>(rows.at(i, 1)), load<T>(rows.at(i, 2))}, parameter),
                  out.mutable_data() + row_size<T> * i);
        return out;
    });
}

// corner_bound and interpolation_bound, (n, 2).
Doubles linear_interval_bounds(const Doubles& numbers, int variables, const std::string& rule) {
    return with_type(variables, rule, [&]<class T>(T) {
        const std::vector<Doubles> arrays{numbers};
        const Operands rows(arrays, row_size<T>);
        Doubles out({rows.count(), py::ssize_t(2)});
        for (py::ssize_t i = 0; i < rows.count(); ++i) {
            const T x = load<T>(rows.at(i, 0));
            out.mutable_data()[2 * i] = x.corner_bound();
            out.mutable_data()[2 * i + 1] = x.interpolation_bound();
        }
        return out;
    });
}

}  // namespace

void register_linear_intervals(py::module_& m) {
    m.def("linear_interval_operation", &linear_interval_operation, "name"_a, "operands"_a, "parameter"_a, "variables"_a,
          "rule"_a);
    m.def("linear_interval_bounds", &linear_interval_bounds, "numbers"_a, "variables"_a, "rule"_a);
}

}  // namespace raybound::python
