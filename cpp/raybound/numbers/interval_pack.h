// Intervals side by side, as many as registers hold, with the same bits as Interval's.
#pragma once

#include <cstring>

#include "raybound/numbers/interval.h"

namespace raybound {

// As in Interval, the ends are kept as -inf and sup, so that both round up. Where a lane holds a special case (an empty
// or unbounded operand, a divisor around 0), all go through Interval.
template <std::floating_point T, class Rounding = DirectedRounding>
struct IntervalPack {
    static constexpr int width = native_lanes;
    using V = Lanes<T, width>;
    using One = Interval<T, Arithmetic::real, Rounding>;

    V minus_inf, sup;

    static IntervalPack load(const T* infs, const T* sups) {
        IntervalPack x;
        std::memcpy(&x.minus_inf, infs, sizeof(V));
        std::memcpy(&x.sup, sups, sizeof(V));
        x.minus_inf = -x.minus_inf;
        return x;
    }
    // Zeros are stored as +0.
    void store(T* infs, T* sups) const {
        const V inf = V{} - minus_inf, positive_sup = V{} + sup;
        std::memcpy(infs, &inf, sizeof(V));
        std::memcpy(sups, &positive_sup, sizeof(V));
    }
    One operator[](int i) const { return One(-minus_inf[i], sup[i]); }

    friend IntervalPack operator+(const IntervalPack& a, const IntervalPack& b) {
        return {sum(a.minus_inf, b.minus_inf), sum(a.sup, b.sup)};
    }
    friend IntervalPack operator-(const IntervalPack& a, const IntervalPack& b) {
        return {sum(a.minus_inf, b.sup), sum(a.sup, b.minus_inf)};
    }
    friend IntervalPack operator*(const IntervalPack& a, const IntervalPack& b) {
        const auto up = [](V x, V y, V) { return Rounding::multiply_up(x, y); };
        return of_products(a, b, a, up, [](One x, One y, One) { return x * y; });
    }
    friend IntervalPack fma(const IntervalPack& a, const IntervalPack& b, const IntervalPack& c) {
        const auto up = [](V x, V y, V z) { return Rounding::fma_up(x, y, z); };
        return of_products(a, b, c, up, [](One x, One y, One z) { return fma(x, y, z); });
    }
    friend IntervalPack operator/(const IntervalPack& a, const IntervalPack& b) {
        const V zero{};
        const auto negative = b.sup < zero;
        const V b_inf = negative ? -b.sup : -b.minus_inf, b_sup = negative ? b.minus_inf : b.sup;
        const V a_minus_inf = negative ? a.sup : a.minus_inf, a_sup = negative ? a.minus_inf : a.sup;
        if (!(lanes::all(b_inf > zero) && are_bounded(a, b))) [[unlikely]]
            return one_by_one(a, b, a, [](One x, One y, One) { return x / y; });
        return {Rounding::divide_up(a_minus_inf, a_minus_inf >= zero ? b_inf : b_sup),
                Rounding::divide_up(a_sup, a_sup >= zero ? b_inf : b_sup)};
    }
    friend IntervalPack sqrt(const IntervalPack& x) {
        if (!(lanes::all(x.minus_inf <= V{}) && are_bounded(x, x))) [[unlikely]]
            return one_by_one(x, x, x, [](One y, One, One) { return sqrt(y); });
        return {-Rounding::sqrt_down(-x.minus_inf), Rounding::sqrt_up(x.sup)};
    }
    friend IntervalPack square(const IntervalPack& x) {
        if (!are_bounded(x, x)) [[unlikely]]
            return one_by_one(x, x, x, [](One y, One, One) { return square(y); });
        const V least = lanes::greater(lanes::greater(-x.minus_inf, -x.sup), V{});
        const V most = lanes::greater(lanes::magnitude(x.minus_inf), lanes::magnitude(x.sup));
        return {Rounding::multiply_up(-least, least), Rounding::multiply_up(most, most)};
    }

  private:
    // Neither empty nor unbounded (nor so wide that the sum of the widths overflows).
    static bool are_bounded(const IntervalPack& a, const IntervalPack& b) {
        return lanes::all_finite((a.minus_inf + a.sup) + (b.minus_inf + b.sup));
    }
    static V sum(V a, V b) { return lanes::greater(Rounding::add_up(a, b), lanes::every<V>(-infinity<T>)); }

    template <class Function>
    [[gnu::noinline]] static IntervalPack one_by_one(IntervalPack a, IntervalPack b, IntervalPack c, Function f) {
        IntervalPack result{};
        for (int i = 0; i < width; ++i) {
            const One x = f(a[i], b[i], c[i]);
            result.minus_inf[i] = -x.inf();
            result.sup[i] = x.sup();
        }
        return result;
    }

    // Either end of a times that end of b which makes the product least, and greatest (see Interval).
    template <class Up, class Special>
    static IntervalPack of_products(const IntervalPack& a, const IntervalPack& b, const IntervalPack& c, Up up,
                                    Special special) {
        if (!are_bounded(a, b)) [[unlikely]]
            return one_by_one(a, b, c, special);
        const V zero{}, a_inf = -a.minus_inf, b_inf = -b.minus_inf;
        const auto from_zero = a_inf >= zero, above = a.sup >= zero;
        const IntervalPack first{up(a.minus_inf, from_zero ? b_inf : b.sup, c.minus_inf),
                                 up(a_inf, from_zero ? b.sup : b_inf, c.sup)};
        const IntervalPack second{up(-a.sup, above ? b_inf : b.sup, c.minus_inf),
                                  up(a.sup, above ? b.sup : b_inf, c.sup)};
        return {lanes::greater(first.minus_inf, second.minus_inf), lanes::greater(first.sup, second.sup)};
    }
};

}  // namespace raybound
