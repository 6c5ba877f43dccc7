#include <algorithm>
#include <map>

#include "bindings/arrays.h"
#include "raybound/numbers/elementary_range.h"
#include "raybound/numbers/elementary_range_values.h"

namespace raybound::python {

namespace {

using RangeFunction = Range (*)(double, double);

RangeFunction range_function(const std::string& name) {
    static const std::map<std::string, RangeFunction> functions = {
        {"exp", exp_range}, {"log", log_range},   {"sin", sin_range},   {"cos", cos_range},
        {"tan", tan_range}, {"asin", asin_range}, {"acos", acos_range}, {"atan", atan_range}};
    const auto found = functions.find(name);
    if (found == functions.end())
        throw std::invalid_argument(
            "elementary_range: name must be 'exp', 'log', 'sin', 'cos', 'tan', 'asin', 'acos' or 'atan', got '" + name +
            "'");
    return found->second;
}

// The ranges over [lo, hi], element by element: (inf, sup).
std::tuple<Doubles, Doubles> elementary_range(const std::string& name, const Doubles& lo, const Doubles& hi) {
    const RangeFunction range = range_function(name);
    const std::vector<py::ssize_t> shape(lo.shape(), lo.shape() + lo.ndim());
    if (!std::equal(shape.begin(), shape.end(), hi.shape(), hi.shape() + hi.ndim()))
        throw std::invalid_argument("elementary_range: lo and hi must have the same shape");
    const std::span<const double> los(lo.data(), std::size_t(lo.size())), his(hi.data(), std::size_t(hi.size()));
    for (std::size_t i = 0; i < los.size(); ++i)
        if (!(los[i] <= his[i]))
            throw std::invalid_argument("elementary_range: lo must be <= hi, got lo = " + std::to_string(los[i]) +
                                        ", hi = " + std::to_string(his[i]));
    Doubles inf(shape), sup(shape);
    double *const infs = inf.mutable_data(), *const sups = sup.mutable_data();
    {
        const py::gil_scoped_release released;
        for (std::size_t i = 0; i < los.size(); ++i) {
            const Range r = range(los[i], his[i]);
            infs[i] = r.inf, sups[i] = r.sup;
        }
    }
    return {inf, sup};
}

DoubleDouble exp_double_double(double x) {
    const elementary_values::Scaled v = elementary_values::exp_value(x);
    const double scale = power_of_two(v.exponent);
    return {v.significand.high * scale, v.significand.low * scale};
}

// What is rounded outward, at points of the domain that need no special care (exp: 2^-54 <= |x| < 600; the others: |x|
// >= 2^-26).
std::tuple<Doubles, Doubles> elementary_range_values(const std::string& name, const Doubles& x) {
    namespace v = elementary_values;
    static const std::map<std::string, DoubleDouble (*)(double)> functions = {
        {"exp", exp_double_double},
        {"log", v::log_value},
        {"sin", [](double a) { return v::sine_value(quarter_turns(a), 0); }},
        {"cos", [](double a) { return v::sine_value(quarter_turns(a), 1); }},
        {"tan", [](double a) { return v::tangent_value(quarter_turns(a)); }},
        {"asin", v::asin_value},
        {"acos", v::acos_value},
        {"atan", v::atan_value}};
    const auto value = functions.at(name);
    const std::vector<py::ssize_t> shape(x.shape(), x.shape() + x.ndim());
    Doubles high(shape), low(shape);
    for (py::ssize_t i = 0; i < x.size(); ++i) {
        const DoubleDouble found = value(x.data()[i]);
        high.mutable_data()[i] = found.high, low.mutable_data()[i] = found.low;
    }
    return {high, low};
}

template <class Table>
Doubles from_table(const Table& table) {
    Doubles a({py::ssize_t(table.size()), py::ssize_t(2)});
    for (std::size_t i = 0; i < table.size(); ++i) {
        a.mutable_data()[2 * i] = table[i].high;
        a.mutable_data()[2 * i + 1] = table[i].low;
    }
    return a;
}

// The first coefficients, and the rest with zeros as low parts.
template <class Series>
Doubles from_series(const Series& series) {
    std::vector<DoubleDouble> all(series.first.begin(), series.first.end());
    for (const double c : series.rest) all.push_back({c, 0});
    return from_table(all);
}

// What the functions are computed from, for a test against arbitrary precision.
py::dict elementary_tables_of_ranges() {
    namespace t = elementary_tables;
    return py::dict("pi"_a = std::pair(t::pi.high, t::pi.low), "ln_2"_a = std::pair(t::ln_2.high, t::ln_2.low),
                    "pi_down"_a = pi_down, "pi_up"_a = pi_up,
                    "two_over_pi"_a = std::vector<std::uint64_t>(t::two_over_pi.begin(), t::two_over_pi.end()),
                    "atan"_a = from_table(t::atan_table), "log"_a = from_table(t::log_table),
                    "exp2"_a = from_table(t::exp2_table), "exp_minus_one"_a = from_series(t::exp_minus_one),
                    "sine_over_angle"_a = from_series(t::sine_over_angle),
                    "cosine_minus_one"_a = from_series(t::cosine_minus_one),
                    "arc_over_tangent"_a = from_series(t::arc_over_tangent));
}

}  // namespace

void register_elementary_ranges(py::module_& m) {
    m.def("elementary_range", &elementary_range, "name"_a, "lo"_a, "hi"_a);
    m.def("elementary_range_values", &elementary_range_values, "name"_a, "x"_a);
    m.def("elementary_range_tables", &elementary_tables_of_ranges);
}

}  // namespace raybound::python
