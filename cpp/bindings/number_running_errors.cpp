#include "bindings/number_kinds.h"
#include "raybound/numbers/running_error_functions.h"

namespace raybound::python {

// value, lower, upper.
template <class T, class Shadow>
struct Record<RunningError<T, Shadow>> {
    using Value = T;
    using Number = RunningError<T, Shadow>;
    static constexpr int width = 3;
    static Number load(const T* p) { return {p[0], typename Number::Enclosure(p[1], p[2])}; }
    static void store(const Number& x, T* p) {
        p[0] = x.value();
        p[1] = x.lower();
        p[2] = x.upper();
    }
};

namespace {

// Beside the operations: a number with an error given, and error and relative error of one.
template <class T>
void register_running_errors_of(const std::string& name) {
    using Number = RunningError<T, NoShadow>;
    register_kind<Number>(name);
    auto& operations = number_kinds()[name].operations;
    operations["with_error"] = [](const std::vector<py::array>& a, double) {  // from (value, error, unused)
        return apply_to_rows<T, 3, 3>(a, [](const T* in, T* out) { Record<Number>::store(Number(in[0], in[1]), out); });
    };
    operations["errors"] = [](const std::vector<py::array>& a, double) {
        return apply_to_rows<T, 3, 3>(a, [](const T* in, T* out) {
            const Number x = Record<Number>::load(in);
            out[0] = x.error();
            out[1] = x.relative_error();
            out[2] = 0;
        });
    };
}

}  // namespace

void register_running_error_kinds() {
    register_running_errors_of<float>("running_error_float32");
    register_running_errors_of<double>("running_error_float64");
}

}  // namespace raybound::python
