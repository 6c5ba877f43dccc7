// What a RunningError carries beside its enclosure to check it: nothing, or the same computation in higher precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <type_traits>

namespace raybound {

// The type that checks T: double for float; long double for double, which has 64 bits of precision on x86 and 113 on
// 64-bit Arm. (Where it is double itself the check is weaker, but no less sound.)
template <std::floating_point T>
using HigherPrecision = std::conditional_t<std::same_as<T, float>, double, long double>;

// A number of higher precision, with the operations that all number types share. Those of IEEE 754 are correctly
// rounded and hence monotone, and every T is an S: so if operands lie in enclosures with ends in T, the result as
// rounded lies in the enclosure of the results. The others are off by a few units in the last place of S.
template <std::floating_point S>
struct Reference {
    S value;

    friend Reference operator-(Reference a) { return {-a.value}; }
    friend Reference operator+(Reference a, Reference b) { return {a.value + b.value}; }
    friend Reference operator-(Reference a, Reference b) { return {a.value - b.value}; }
    friend Reference operator*(Reference a, Reference b) { return {a.value * b.value}; }
    friend Reference operator/(Reference a, Reference b) { return {a.value / b.value}; }
    friend Reference fma(Reference a, Reference b, Reference c) { return {std::fma(a.value, b.value, c.value)}; }
    friend Reference minimum(Reference a, Reference b) { return {std::min(a.value, b.value)}; }
    friend Reference maximum(Reference a, Reference b) { return {std::max(a.value, b.value)}; }
    friend Reference abs(Reference x) { return {std::abs(x.value)}; }
    friend Reference square(Reference x) { return {x.value * x.value}; }
    friend Reference sqrt(Reference x) { return {std::sqrt(x.value)}; }
    friend Reference reciprocal(Reference x) { return {1 / x.value}; }
    friend Reference rsqrt(Reference x) { return {1 / std::sqrt(x.value)}; }
    friend Reference exp(Reference x) { return {std::exp(x.value)}; }
    friend Reference log(Reference x) { return {std::log(x.value)}; }
    friend Reference sin(Reference x) { return {std::sin(x.value)}; }
    friend Reference cos(Reference x) { return {std::cos(x.value)}; }
    friend Reference tan(Reference x) { return {std::tan(x.value)}; }
    friend Reference asin(Reference x) { return {std::asin(x.value)}; }
    friend Reference acos(Reference x) { return {std::acos(x.value)}; }
    friend Reference atan(Reference x) { return {std::atan(x.value)}; }
    friend Reference power(Reference x, int n) { return {std::pow(x.value, S(n))}; }
    // (1 - 1/c^2) = (c - 1)(c + 1) / c^2 without cancellation.
    friend Reference ward_lobe(Reference c, double sigma) {
        return {std::exp((c.value - 1) * (c.value + 1) / (c.value * c.value * S(sigma) * S(sigma)))};
    }
};

// The two kinds of shadow.
struct NoShadow {
    static constexpr bool checks = false;
};

template <std::floating_point T>
struct HighPrecision {
    static constexpr bool checks = true;
    Reference<HigherPrecision<T>> reference;
};

#ifdef NDEBUG
template <std::floating_point T>
using DefaultShadow = NoShadow;
#else
template <std::floating_point T>
using DefaultShadow = HighPrecision<T>;
#endif

}  // namespace raybound
