// RunningError: a number as T computes it, with an enclosure of what real arithmetic would have computed (running error
// analysis: seeds/000 and 002, 3.9.1, whose EFloat this is).
//
// The value has the bits of the plain kernel. The two forms of EFloat, an absolute error (000) and interval ends (002),
// are one: ends are kept, because an error around the value is wider and its recurrences (err + err + eps * ...) round
// themselves, which 000 does not count; the error is what lies between the value and the farther end, rounded up. The
// ends are the IEEE 754 results toward either infinity of exact interval arithmetic, not next-floats of rounded ones.
//
// A domain error (the root of a range that reaches below zero, a divisor that reaches zero, a NaN) makes the enclosure
// entire: error infinite, `is_defined` false. It absorbs: what is computed from it is entire too.
#pragma once

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "raybound/numbers/elementary.h"
#include "raybound/numbers/interval.h"
#include "raybound/numbers/shadow.h"

namespace raybound {

// The answer to a comparison: what is certain of the exact numbers, and what the plain kernel sees.
struct RunningVerdict {
    Verdict certain;
    bool computed;

    operator Verdict() const { return certain; }
    friend RunningVerdict operator!(RunningVerdict a) { return {!a.certain, !a.computed}; }
    friend RunningVerdict operator&(RunningVerdict a, RunningVerdict b) {
        return {a.certain & b.certain, a.computed && b.computed};
    }
    friend RunningVerdict operator|(RunningVerdict a, RunningVerdict b) {
        return {a.certain | b.certain, a.computed || b.computed};
    }
    friend bool none(RunningVerdict a) { return none(a.certain); }
};

template <std::floating_point T, class Shadow = DefaultShadow<T>>
class RunningError {
  public:
    using Value = T;
    using Enclosure = Interval<T>;

    RunningError() : RunningError(T(0)) {}
    // Exactly x: the value is x rounded to T.
    template <class X>
        requires std::is_arithmetic_v<X>
    RunningError(X x) : RunningError(static_cast<T>(x), Enclosure(x)) {
        follow("construction", 0, x, Enclosure(x));
    }
    // An exact number within `error` of the value. Throws std::invalid_argument unless error >= 0.
    RunningError(T value, T error) : RunningError(value, Enclosure(subtract_down(value, error), add_up(value, error))) {
        if (!(error >= 0))
            throw std::invalid_argument("RunningError: error must be >= 0, got " + std::to_string(error));
    }
    RunningError(T value, const Enclosure& enclosure) : value_(value), enclosure_(enclosure) {
        if constexpr (Shadow::checks) shadow_.reference.value = value;
        settle();
    }
    // From the other precision: the value is rounded, the enclosure outward.
    template <std::floating_point U, class OtherShadow>
        requires(!std::same_as<T, U>)
    explicit RunningError(const RunningError<U, OtherShadow>& x)
        : RunningError(static_cast<T>(x.value()), hull(Enclosure(x.lower()), Enclosure(x.upper()))) {
        if constexpr (Shadow::checks && OtherShadow::checks)
            follow("conversion", 0, x.shadow().reference.value, enclosure_);
    }

    explicit operator T() const { return value_; }
    T value() const { return value_; }
    T lower() const { return enclosure_.inf(); }
    T upper() const { return enclosure_.sup(); }
    const Enclosure& enclosure() const { return enclosure_; }
    const Shadow& shadow() const { return shadow_; }
    bool is_defined() const { return !enclosure_.is_entire(); }

    // |value - exact|, rounded up.
    T error() const {
        const T above = subtract_up(upper(), value_), below = subtract_up(value_, lower());
        return above >= 0 && below >= 0 ? std::max(above, below) : infinity<T>;
    }
    // |value - exact| / |exact|, rounded up; infinite where the exact number may be 0, unless it certainly is.
    T relative_error() const {
        if (lower() == 0 && upper() == 0) return value_ == 0 ? T(0) : infinity<T>;
        if (!(lower() > 0 || upper() < 0) || error() == infinity<T>) return infinity<T>;
        return std::max(divide_up(subtract_up(upper(), value_), std::abs(upper())),
                        divide_up(subtract_up(value_, lower()), std::abs(lower())));
    }

    // |precise - value| / |precise|, where the shadow's value is taken for the exact one (seeds/000: GetRelativeError).
    // An estimate, as the shadow rounds as well; 0 where there is no error, infinite for an error of 0.
    HigherPrecision<T> estimate_relative_error() const
        requires(Shadow::checks)
    {
        const auto precise = shadow_.reference.value;
        return precise == value_ ? 0 : std::abs((precise - value_) / precise);
    }

    // An operation that T, intervals and the shadow's numbers all have, applied to the operands' three parts. Where it
    // is not `defined` on the operands' enclosures the result is flagged. `slack` is the error of the shadow's
    // operation in its units in the last place, 0 if it is correctly rounded. Throws std::logic_error if the shadow
    // leaves.
    template <class Operation, class... Operands>
    static RunningError apply(const char* name, int slack, bool defined, Operation operation, const Operands&... x) {
        const bool whole = defined && (x.is_defined() && ...);
        const Enclosure enclosure = whole ? operation(x.enclosure_...) : Enclosure::entire();
        RunningError result(operation(x.value_...), enclosure);
        if constexpr (Shadow::checks)
            result.follow(name, slack, operation(x.shadow_.reference...).value, enclosure, x...);
        return result;
    }

    // The shadow of a result that was computed otherwise. It is checked against the enclosure as the operation made it,
    // before the value was taken in, which might hide a wrong one. Throws std::logic_error if it is outside.
    template <class S, class... Operands>
    void follow(const char* name, int slack, S exact, const Enclosure& enclosure, const Operands&... x) {
        if constexpr (Shadow::checks) {
            shadow_.reference.value = exact;
            if (is_defined()) check(name, slack, enclosure, x...);
        }
    }

    RunningError operator-() const {
        return apply("negate", 0, true, [](auto a) { return -a; }, *this);
    }
    friend RunningError operator+(const RunningError& a, const RunningError& b) {
        return apply("add", 0, true, [](auto x, auto y) { return x + y; }, a, b);
    }
    friend RunningError operator-(const RunningError& a, const RunningError& b) {
        return apply("subtract", 0, true, [](auto x, auto y) { return x - y; }, a, b);
    }
    friend RunningError operator*(const RunningError& a, const RunningError& b) {
        return apply("multiply", 0, true, [](auto x, auto y) { return x * y; }, a, b);
    }
    friend RunningError operator/(const RunningError& a, const RunningError& b) {
        return apply("divide", 0, !b.enclosure_.contains_zero(), [](auto x, auto y) { return x / y; }, a, b);
    }

    friend RunningVerdict operator<(const RunningError& a, const RunningError& b) {
        return {a.enclosure_ < b.enclosure_, a.value_ < b.value_};
    }
    friend RunningVerdict operator<=(const RunningError& a, const RunningError& b) {
        return {a.enclosure_ <= b.enclosure_, a.value_ <= b.value_};
    }
    friend RunningVerdict operator>(const RunningError& a, const RunningError& b) { return b < a; }
    friend RunningVerdict operator>=(const RunningError& a, const RunningError& b) { return b <= a; }

    // The value that the plain kernel selects, in an enclosure of what might have been selected.
    friend RunningError select(RunningVerdict which, const RunningError& yes, const RunningError& no) {
        RunningError result = which.computed ? yes : no;
        result.enclosure_ = select(which.certain, yes.enclosure_, no.enclosure_);
        result.settle();
        return result;
    }

  private:
    // The value lies in the enclosure, which rounding alone guarantees only where T's operation is correctly rounded.
    void settle() {
        if (value_ != value_ || enclosure_.is_empty() || lower() == infinity<T> || upper() == -infinity<T>)
            enclosure_ = Enclosure::entire();
        else
            enclosure_ = hull(enclosure_, Enclosure(value_, value_));
    }

    // Is the shadow in the enclosure, but for `slack` units in its last place? From there on it is moved inside, so
    // that the next operation may count on it.
    template <class... Operands>
    void check(const char* name, int slack, const Enclosure& enclosure, const Operands&... x) {
        auto& exact = shadow_.reference.value;
        using S = std::remove_reference_t<decltype(exact)>;
        const S low = enclosure.inf(), high = enclosure.sup();
        const S margin = slack * std::numeric_limits<S>::epsilon() * std::abs(exact);
        if (!((exact >= low || exact + margin >= low) && (exact <= high || exact - margin <= high)))
            throw std::logic_error("RunningError: " + account(name, enclosure, x...));
        exact = std::min(std::max(exact, low), high);
    }

    template <class... Operands>
    std::string account(const char* name, const Enclosure& enclosure, const Operands&... x) const {
        std::ostringstream text;
        text.precision(21);
        text << name << " gave " << shadow_.reference.value << ", outside of [" << enclosure.inf() << ", "
             << enclosure.sup() << "]";
        ((text << ", of " << x.shadow_.reference.value << " in [" << x.lower() << ", " << x.upper() << "]"), ...);
        return text.str();
    }

    T value_;
    Enclosure enclosure_;
    [[no_unique_address]] Shadow shadow_;
};

template <std::floating_point T, class Shadow>
struct NumberTraits<RunningError<T, Shadow>> {
    using Mask = RunningVerdict;
    using Wide = RunningError<double, std::conditional_t<Shadow::checks, HighPrecision<double>, NoShadow>>;
    static constexpr T unit_roundoff = NumberTraits<T>::unit_roundoff;
};

}  // namespace raybound
