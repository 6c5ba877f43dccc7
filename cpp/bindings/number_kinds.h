// Arrays of any number type: each number is a record of so many floats or doubles, and an operation runs over records.
#pragma once

#include <array>
#include <functional>
#include <map>

#include "bindings/arrays.h"
#include "raybound/numbers/operations.h"

namespace raybound::python {

// How a number lies in an array: `Value` is the dtype, `width` the length of the last axis.
template <class T>
struct Record;

template <std::floating_point T>
struct Record<T> {
    using Value = T;
    static constexpr int width = 1;
    static T load(const T* p) { return *p; }
    static void store(T x, T* p) { *p = x; }
};

template <class T>
using Records = py::array_t<typename Record<T>::Value, py::array::c_style | py::array::forcecast>;

// Called with contiguous arrays of equal length and a parameter; what is not used is empty or zero.
using Apply = std::function<py::array(const std::vector<py::array>&, double)>;

struct NumberKind {
    int width;
    std::map<std::string, Apply> operations;
};

std::map<std::string, NumberKind>& number_kinds();

// Applies a function of `arity` numbers to records. Results may be of another kind.
template <class T, int arity, class Function>
py::array apply_to_records(const std::vector<py::array>& arrays, Function f) {
    using Value = typename Record<T>::Value;
    using Result = std::decay_t<decltype(f(std::array<T, std::size_t(arity)>{}))>;
    if (arrays.size() != std::size_t(arity)) throw std::invalid_argument("apply: wrong number of operands");
    std::vector<Records<T>> operands;
    for (const py::array& a : arrays) operands.push_back(Records<T>::ensure(a));
    const py::ssize_t n = operands[0].size() / Record<T>::width;
    for (const auto& a : operands)
        if (a.size() != n * Record<T>::width) throw std::invalid_argument("apply: operands must have the same shape");
    py::array_t<typename Record<Result>::Value> out({n, py::ssize_t(Record<Result>::width)});
    std::array<const Value*, std::size_t(arity)> in;
    for (std::size_t k = 0; k < in.size(); ++k) in[k] = operands[k].data();
    auto* const to = out.mutable_data();
    {
        const py::gil_scoped_release released;
        std::array<T, std::size_t(arity)> x;
        for (py::ssize_t i = 0; i < n; ++i) {
            for (std::size_t k = 0; k < in.size(); ++k) x[k] = Record<T>::load(in[k] + i * Record<T>::width);
            Record<Result>::store(f(x), to + i * Record<Result>::width);
        }
    }
    return out;
}

// The same for what is no operation of the type: rows of `from` values give rows of `to`.
template <class Value, int from, int to, class Function>
py::array apply_to_rows(const std::vector<py::array>& arrays, Function f) {
    if (arrays.size() != 1) throw std::invalid_argument("apply: wrong number of operands");
    const auto in = py::array_t<Value, py::array::c_style | py::array::forcecast>::ensure(arrays[0]);
    const py::ssize_t n = in.size() / from;
    py::array_t<Value> out({n, py::ssize_t(to)});
    for (py::ssize_t i = 0; i < n; ++i) f(in.data() + i * from, out.mutable_data() + i * to);
    return out;
}

// All operations of operations.h for one number type.
template <class T>
void register_kind(const std::string& name) {
    NumberKind& kind = number_kinds()[name];
    kind.width = Record<T>::width;
    operations::for_each(operations::unary, [&](const auto& operation) {
        kind.operations[operation.name] = [f = operation.apply](const std::vector<py::array>& a, double) {
            return apply_to_records<T, 1>(a, [f](const auto& x) { return T(f(x[0])); });
        };
    });
    operations::for_each(operations::binary, [&](const auto& operation) {
        kind.operations[operation.name] = [f = operation.apply](const std::vector<py::array>& a, double) {
            return apply_to_records<T, 2>(a, [f](const auto& x) { return T(f(x[0], x[1])); });
        };
    });
    operations::for_each(operations::ternary, [&](const auto& operation) {
        kind.operations[operation.name] = [f = operation.apply](const std::vector<py::array>& a, double) {
            return apply_to_records<T, 3>(a, [f](const auto& x) { return T(f(x[0], x[1], x[2])); });
        };
    });
    operations::for_each(operations::parametric, [&](const auto& operation) {
        kind.operations[operation.name] = [f = operation.apply](const std::vector<py::array>& a, double parameter) {
            return apply_to_records<T, 1>(a, [f, parameter](const auto& x) { return T(f(x[0], parameter)); });
        };
    });
}

void register_float_kinds();
void register_interval_kinds(py::module_& m);
void register_running_error_kinds();
void register_linear_kinds();
void register_taylor_kinds(py::module_& m);

}  // namespace raybound::python
