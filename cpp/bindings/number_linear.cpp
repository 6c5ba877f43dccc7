#include "bindings/number_kinds.h"
#include "raybound/numbers/linear_interval_choices.h"
#include "raybound/numbers/linear_interval_functions.h"

namespace raybound::python {

// inf and sup of the constant, of each slope, and of the range.
template <int N, LinearRule R>
struct Record<LinearInterval<N, R>> {
    using Value = double;
    using Number = LinearInterval<N, R>;
    static constexpr int width = 2 * (N + 2);
    static Number load(const double* p) {
        typename Number::Slopes slopes;
        for (std::size_t i = 0; i < N; ++i) slopes[i] = {p[2 * i + 2], p[2 * i + 3]};
        return Number({p[0], p[1]}, slopes, {p[2 * N + 2], p[2 * N + 3]});
    }
    static void store(const Number& x, double* p) {
        const auto put = [&p](const Interval<double>& bound) {
            *p++ = bound.inf();
            *p++ = bound.sup();
        };
        put(x.constant());
        for (int i = 0; i < N; ++i) put(x.slope(i));
        put(x.range());
    }
};

namespace {

// Beside the operations: the range of what has none yet, and interpolation bound and corner bound of each.
template <int N, LinearRule R>
void register_linear(const std::string& name) {
    using Number = LinearInterval<N, R>;
    constexpr int width = Record<Number>::width;
    register_kind<Number>(name);
    auto& operations = number_kinds()[name].operations;
    operations["settled"] = [](const std::vector<py::array>& a, double) {
        return apply_to_records<Number, 1>(a, [](const auto& x) { return x[0]; });
    };
    operations["bounds"] = [](const std::vector<py::array>& a, double) {
        return apply_to_rows<double, width, width>(a, [](const double* in, double* out) {
            const Number x = Record<Number>::load(in);
            std::fill(out, out + width, 0.0);
            out[0] = x.interpolation_bound();
            out[1] = x.corner_bound();
        });
    };
}

template <int N>
void register_linear_rules() {
    const std::string n = std::to_string(N);
    register_linear<N, LinearRule::hansen>("linear_" + n + "_hansen");
    register_linear<N, LinearRule::second_order>("linear_" + n + "_second-order");
}

}  // namespace

void register_linear_kinds() {
    register_linear_rules<1>();
    register_linear_rules<2>();
    register_linear_rules<3>();
    register_linear_rules<4>();
}

}  // namespace raybound::python
