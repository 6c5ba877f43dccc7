// The operations that every number type offers, declared once: the bindings of all types and the suite of conformance
// are made from these lists. A type offers them as operators and as free functions of these names.
#pragma once

#include <tuple>

#include "raybound/numbers/elementary.h"

namespace raybound::operations {

template <class Function>
struct Operation {
    const char* name;
    Function apply;
};

inline constexpr auto unary = std::tuple{
    Operation{"negative", [](const auto& x) { return -x; }},
    Operation{"abs", [](const auto& x) { return abs(x); }},
    Operation{"square", [](const auto& x) { return square(x); }},
    Operation{"sqrt", [](const auto& x) { return sqrt(x); }},
    Operation{"rsqrt", [](const auto& x) { return rsqrt(x); }},
    Operation{"reciprocal", [](const auto& x) { return reciprocal(x); }},
    Operation{"exp", [](const auto& x) { return exp(x); }},
    Operation{"log", [](const auto& x) { return log(x); }},
    Operation{"sin", [](const auto& x) { return sin(x); }},
    Operation{"cos", [](const auto& x) { return cos(x); }},
    Operation{"tan", [](const auto& x) { return tan(x); }},
    Operation{"asin", [](const auto& x) { return asin(x); }},
    Operation{"acos", [](const auto& x) { return acos(x); }},
    Operation{"atan", [](const auto& x) { return atan(x); }},
};

inline constexpr auto binary = std::tuple{
    Operation{"add", [](const auto& x, const auto& y) { return x + y; }},
    Operation{"subtract", [](const auto& x, const auto& y) { return x - y; }},
    Operation{"multiply", [](const auto& x, const auto& y) { return x * y; }},
    Operation{"divide", [](const auto& x, const auto& y) { return x / y; }},
    Operation{"minimum", [](const auto& x, const auto& y) { return minimum(x, y); }},
    Operation{"maximum", [](const auto& x, const auto& y) { return maximum(x, y); }},
};

inline constexpr auto ternary = std::tuple{
    Operation{"fma", [](const auto& x, const auto& y, const auto& z) { return fma(x, y, z); }},
};

// With a parameter that is a plain number.
inline constexpr auto parametric = std::tuple{
    Operation{"power", [](const auto& x, double n) { return power(x, static_cast<int>(n)); }},
    Operation{"ward_lobe", [](const auto& x, double sigma) { return ward_lobe(x, sigma); }},
};

template <class... Operations, class Visitor>
constexpr void for_each(const std::tuple<Operations...>& list, Visitor visit) {
    std::apply([&](const auto&... operation) { (visit(operation), ...); }, list);
}

}  // namespace raybound::operations
