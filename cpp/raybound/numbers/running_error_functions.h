// Functions of numbers with a running error: the operations that all number types share.
#pragma once

#include "raybound/numbers/interval_functions.h"
#include "raybound/numbers/running_error.h"

namespace raybound {

// The third argument of `apply` says where a function is defined: intervals would cut their argument to the domain, but
// here the exact argument may be outside. The second is the error of the C library in higher precision, with room.

template <std::floating_point T, class S>
inline RunningError<T, S> sqrt(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("sqrt", 0, x.lower() >= 0, [](auto v) { return sqrt(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> square(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("square", 0, true, [](auto v) { return square(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> abs(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("abs", 0, true, [](auto v) { return abs(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> reciprocal(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply(
        "reciprocal", 0, !x.enclosure().contains_zero(), [](auto v) { return reciprocal(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> rsqrt(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("rsqrt", 2, x.lower() > 0, [](auto v) { return rsqrt(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> exp(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("exp", 4, true, [](auto v) { return exp(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> log(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("log", 4, x.lower() > 0, [](auto v) { return log(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> sin(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("sin", 4, true, [](auto v) { return sin(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> cos(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("cos", 4, true, [](auto v) { return cos(v); }, x);
}
// Over a pole the interval is entire by itself.
template <std::floating_point T, class S>
inline RunningError<T, S> tan(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("tan", 4, true, [](auto v) { return tan(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> asin(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("asin", 4, x.enclosure().mag() <= 1, [](auto v) { return asin(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> acos(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("acos", 4, x.enclosure().mag() <= 1, [](auto v) { return acos(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> atan(const RunningError<T, S>& x) {
    return RunningError<T, S>::apply("atan", 4, true, [](auto v) { return atan(v); }, x);
}
template <std::floating_point T, class S>
inline RunningError<T, S> minimum(const RunningError<T, S>& a, const RunningError<T, S>& b) {
    return RunningError<T, S>::apply("minimum", 0, true, [](auto x, auto y) { return minimum(x, y); }, a, b);
}
template <std::floating_point T, class S>
inline RunningError<T, S> maximum(const RunningError<T, S>& a, const RunningError<T, S>& b) {
    return RunningError<T, S>::apply("maximum", 0, true, [](auto x, auto y) { return maximum(x, y); }, a, b);
}
template <std::floating_point T, class S>
inline RunningError<T, S> fma(const RunningError<T, S>& a, const RunningError<T, S>& b, const RunningError<T, S>& c) {
    return RunningError<T, S>::apply("fma", 0, true, [](auto x, auto y, auto z) { return fma(x, y, z); }, a, b, c);
}
template <std::floating_point T, class S>
inline RunningError<T, S> power(const RunningError<T, S>& x, int n) {
    const bool defined = n >= 0 || !x.enclosure().contains_zero();
    return RunningError<T, S>::apply("power", 4, defined, [n](auto v) { return power(v, n); }, x);
}
// The shadow's exponent, up to 800 in size where the result is not 0, has a relative error of 6 units.
template <std::floating_point T, class S>
inline RunningError<T, S> ward_lobe(const RunningError<T, S>& cosine, double sigma) {
    return RunningError<T, S>::apply(
        "ward_lobe", 5000, sigma > 0, [sigma](auto v) { return ward_lobe(v, sigma); }, cosine);
}

static_assert(Number<RunningError<float>> && Number<RunningError<double>>);

}  // namespace raybound
