// Functions of intervals beyond arithmetic: integer powers and the elementary functions.
#pragma once

#include "raybound/numbers/elementary_range.h"
#include "raybound/numbers/interval.h"
#include "raybound/numbers/rounding_power.h"

namespace raybound {

namespace interval_functions {

// What an execution in float32 may add when its result differs from the exact one by at most `roundings` u of itself
// (and by `roundings` subnormals where numbers underflow): every end moves away from 0 or toward it by that much.
// Beyond 2^126 a quotient's divisor was subnormal, its relative error unbounded but for a factor of two.
template <class I>
I widen_for_float32(const I& x, double roundings) {
    using T = typename I::Value;
    if constexpr (I::arithmetic == Arithmetic::real) return x;
    if (x.is_empty()) return x;
    const double relative = roundings * 0x1p-24;
    if (!(relative < 0.25)) return x.inf() >= 0 ? I(T(0), infinity<T>) : x.sup() <= 0 ? I(-infinity<T>, T(0)) : I::entire();
    const double factor = 1 + 2 * relative, tiny = 0x1p-126, huge = 0x1p126;
    // The end at distance `size` from 0, moved outward (away from 0) or inward.
    const auto away = [&](double size) {
        return size > huge ? infinity<double> : multiply_up(size, factor) + (size < tiny ? roundings * 0x1p-148 : 0.0);
    };
    const auto toward = [&](double size) {
        return size < tiny ? 0.0 : size > huge ? 0x1p125 : multiply_down(size, 1 - 2 * relative);
    };
    const auto low = double(x.inf()), high = double(x.sup());
    const double inf = low > 0 ? toward(low) : -away(-low), sup = high < 0 ? -toward(-high) : away(high);
    return I::outward(inf, sup);
}

template <class I, class Function>
I elementary(const I& x, Function range) {
    if (x.is_empty()) return I::empty();
    const Range r = range(double(x.inf()), double(x.sup()));
    return widen_for_float32(I::outward(r.inf, r.sup), 2);
}

}  // namespace interval_functions
}  // namespace raybound
