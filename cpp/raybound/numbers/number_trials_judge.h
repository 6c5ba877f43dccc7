// Whether a rounded result is the right one, by exact integers (number_trials_exact.h).
#pragma once

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "raybound/numbers/number_trials_exact.h"
#include "raybound/numbers/rounding.h"

namespace raybound::trials {

enum class Operation { add, subtract, multiply, divide, sqrt, fma, square };

inline Operation operation_named(const std::string& name) {
    const char* const names[] = {"add", "subtract", "multiply", "divide", "sqrt", "fma", "square"};
    for (int i = 0; i < 7; ++i)
        if (name == names[i]) return static_cast<Operation>(i);
    throw std::invalid_argument(
        "number_trials: operation must be 'add', 'subtract', 'multiply', 'divide', 'sqrt', "
        "'fma' or 'square', got '" +
        name + "'");
}

// The sign of the exact result less r, for finite operands in the domain.
inline int sign_of_excess(Operation operation, double a, double b, double c, double r) {
    if (std::isinf(r)) return r > 0 ? -1 : 1;
    ExactNumber excess;
    switch (operation) {
        case Operation::add:
            return excess.add(a).add(b).add(r, -1).sign();
        case Operation::subtract:
            return excess.add(a).add(b, -1).add(r, -1).sign();
        case Operation::multiply:
            return excess.add_product(a, b).add(r, -1).sign();
        case Operation::divide:
            return excess.add(a).add_product(r, b, -1).sign() * (b < 0 ? -1 : 1);
        case Operation::sqrt:
            return r < 0 ? 1 : excess.add(a).add_product(r, r, -1).sign();
        case Operation::fma:
            return excess.add_product(a, b).add(c).add(r, -1).sign();
        case Operation::square:
            break;
    }
    return excess.add_product(a, a).add(r, -1).sign();
}

// Of plain numbers, rounded to nearest, or of intervals.
template <class X>
X apply(Operation operation, const X& a, const X& b, const X& c) {
    using std::fma;
    using std::sqrt;
    switch (operation) {
        case Operation::add:
            return a + b;
        case Operation::subtract:
            return a - b;
        case Operation::multiply:
            return a * b;
        case Operation::divide:
            return a / b;
        case Operation::sqrt:
            return sqrt(a);
        case Operation::fma:
            return fma(a, b, c);
        case Operation::square:
            break;
    }
    return square(a);
}

// Calls f with the way of rounding of this name.
template <class Function>
auto with_rounding(const char* who, const std::string& implementation, Function f) {
    if (implementation == "portable") return f(PortableRounding());
#ifdef __AVX512F__
    if (implementation == "hardware") return f(HardwareRounding());
#endif
    throw std::invalid_argument(std::string(who) +
                                ": implementation must be 'portable' or, with AVX-512, 'hardware', got '" +
                                implementation + "'");
}

// Where rounding has nothing to do: an operand that is no number, a division by zero, a root of a negative number.
template <class T>
bool is_special(Operation operation, T a, T b, T c) {
    const bool takes_b = operation != Operation::sqrt && operation != Operation::square;
    if (!std::isfinite(a) || (takes_b && !std::isfinite(b))) return true;
    if (operation == Operation::fma && !std::isfinite(c)) return true;
    return (operation == Operation::divide && b == 0) || (operation == Operation::sqrt && a < 0);
}

// The sign of an exact zero (IEEE 754-2019, 6.3): a sum that is zero is -0 only of two of them, or rounded down.
template <class T>
bool exact_zero_is_negative(Operation operation, bool up, T a, T b, T c) {
    const bool x = std::signbit(a), y = std::signbit(b), product = x != y;
    const auto sum = [up](T p, bool p_negative, T q, bool q_negative) {
        return p == 0 && q == 0 && p_negative == q_negative ? p_negative : !up;
    };
    switch (operation) {
        case Operation::add:
            return sum(a, x, b, y);
        case Operation::subtract:
            return sum(a, x, b, !y);
        case Operation::fma:
            return sum(a == 0 || b == 0 ? T(0) : T(1), product, c, std::signbit(c));
        case Operation::sqrt:
            return x;
        case Operation::square:
            return false;
        default:
            return product;
    }
}

enum class Judgement { tight, not_tight, wrong };

// Of a result rounded up or down. Operands are not special.
template <class T>
Judgement judge(Operation operation, bool up, T a, T b, T c, T result) {
    if (result != result) return Judgement::wrong;
    const int excess = sign_of_excess(operation, a, b, c, result);
    if (excess == 0) {
        const bool negative = exact_zero_is_negative(operation, up, a, b, c);
        return result == 0 && std::signbit(result) != negative ? Judgement::wrong : Judgement::tight;
    }
    if ((excess > 0) == up) return Judgement::wrong;
    if (result == 0 && std::signbit(result) != up) return Judgement::wrong;  // -0 of negative numbers, +0 of positive
    constexpr T infinity = std::numeric_limits<T>::infinity();
    const T inward = std::nextafter(result, up ? -infinity : infinity);
    const int inner = sign_of_excess(operation, a, b, c, inward);
    return inner != 0 && (inner > 0) == up ? Judgement::tight : Judgement::not_tight;
}

}  // namespace raybound::trials
