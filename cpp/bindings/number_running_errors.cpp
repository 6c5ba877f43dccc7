#include "bindings/number_kinds.h"
#include "raybound/numbers/running_error_quadratic.h"

namespace raybound::python {

// value, lower, upper.
template <class T>
struct Record<RunningError<T, NoShadow>> {
    using Value = T;
    using Number = RunningError<T, NoShadow>;
    static constexpr int width = 3;
    static Number load(const T* p) { return {p[0], typename Number::Enclosure(p[1], p[2])}; }
    static void store(const Number& x, T* p) {
        p[0] = x.value();
        p[1] = x.lower();
        p[2] = x.upper();
    }
};

// The same in doubles, and the precise value of the shadow as the sum of two, as it may be a long double.
template <class T>
struct Record<RunningError<T, HighPrecision<T>>> {
    using Value = double;
    using Number = RunningError<T, HighPrecision<T>>;
    using Precise = HigherPrecision<T>;
    static constexpr int width = 5;
    static Number load(const double* p) {
        Number x{T(p[0]), typename Number::Enclosure{T(p[1]), T(p[2])}};
        x.follow("load", 0, Precise(p[3]) + Precise(p[4]), x.enclosure());
        return x;
    }
    static void store(const Number& x, double* p) {
        p[0] = double(x.value());
        p[1] = double(x.lower());
        p[2] = double(x.upper());
        const Precise precise = x.shadow().reference.value;
        p[3] = double(precise);
        p[4] = std::isfinite(p[3]) ? double(precise - Precise(p[3])) : 0.0;
    }
};

namespace {

// What `quadratic` gives, and its record: both roots, what is certain of their being real, what the plain kernel says.
template <class Number>
struct Roots {
    Number low, high;
    RunningVerdict real;
};

}  // namespace

template <class Number>
struct Record<Roots<Number>> {
    using Value = typename Record<Number>::Value;
    static constexpr int half = Record<Number>::width, width = 2 * half + 2;
    static void store(const Roots<Number>& x, Value* p) {
        Record<Number>::store(x.low, p);
        Record<Number>::store(x.high, p + half);
        p[2 * half] = static_cast<Value>(x.real.certain);
        p[2 * half + 1] = static_cast<Value>(x.real.computed);
    }
};

namespace {

// Beside the operations: a number with an error given, error and relative error of one (and of the precise kinds what
// the relative error really is), and a quadratic's roots.
template <class T, class Shadow>
void register_running_errors_of(const std::string& name) {
    using Number = RunningError<T, Shadow>;
    using Value = typename Record<Number>::Value;
    constexpr int width = Record<Number>::width;
    register_kind<Number>(name);
    auto& operations = number_kinds()[name].operations;
    operations["with_error"] = [](const std::vector<py::array>& a, double) {  // from (value, error, unused)
        return apply_to_rows<Value, width, width>(a, [](const Value* in, Value* out) {
            Record<Number>::store(Number(static_cast<T>(in[0]), static_cast<T>(in[1])), out);
        });
    };
    operations["errors"] = [](const std::vector<py::array>& a, double) {
        return apply_to_rows<Value, width, width>(a, [](const Value* in, Value* out) {
            const Number x = Record<Number>::load(in);
            std::fill(out, out + width, Value(0));
            out[0] = x.error();
            out[1] = x.relative_error();
            if constexpr (Shadow::checks) out[2] = static_cast<Value>(x.estimate_relative_error());
        });
    };
    operations["quadratic"] = [](const std::vector<py::array>& a, double) {
        return apply_to_records<Number, 3>(a, [](const auto& x) {
            Roots<Number> roots{};
            roots.real = quadratic(x[0], x[1], x[2], &roots.low, &roots.high);
            return roots;
        });
    };
}

}  // namespace

// The precise kinds make the check that debug builds make of every operation.
void register_running_error_kinds() {
    register_running_errors_of<float, NoShadow>("running_error_float32");
    register_running_errors_of<double, NoShadow>("running_error_float64");
    register_running_errors_of<float, HighPrecision<float>>("precise_running_error_float32");
    register_running_errors_of<double, HighPrecision<double>>("precise_running_error_float64");
}

}  // namespace raybound::python
