// A quadratic polynomial in N variables with a certified remainder (certified-interpolants.md, section 2):
//
//   f(x) in c + sum l_i x_i + sum q_i x_i^2 + sum_{i<j} x_ij x_i x_j + [-r, r]   for x in [-1, 1]^N.
//
// The roundings of the coefficients are collected in r, and so are, if the arithmetic is not `real`, those that an
// execution in that floating-point type commits: then the enclosure holds f(x) and what such an execution computes,
// for whatever values of the operands within *their* enclosures at x. What is not known (a root of a negative number, a
// division by zero, an overflow) has r = infinity and all coefficients zero, forever after: `entire`. Nothing is NaN.
#pragma once

#include <concepts>
#include <limits>
#include <type_traits>

#include "raybound/numbers/arithmetic.h"
#include "raybound/numbers/number.h"
#include "raybound/numbers/taylor_layout.h"
#include "raybound/numbers/verdict.h"

namespace raybound {

// What an execution in the arithmetic's floating-point type does to a result: nothing for `real`.
template <Arithmetic A>
struct Execution {
    static constexpr double unit_roundoff = 0, underflow = 0, largest = std::numeric_limits<double>::max();
};
template <>
struct Execution<Arithmetic::float32> {
    static constexpr double unit_roundoff = 0x1p-24, underflow = 0x1p-150,
                            largest = double(std::numeric_limits<float>::max());
};
template <>
struct Execution<Arithmetic::float64> {
    static constexpr double unit_roundoff = 0x1p-53, underflow = 0x1p-1074,
                            largest = std::numeric_limits<double>::max() * 0.5;
};

// Rounding upward for sums and products of numbers that are not negative: after at most 63 operations in a row the
// result is below the exact one by a factor of at least (1 - 2^-53)^63; this factor is its inverse and more. Underflow
// is taken care of by `underflow_bound`, which is above all that 2^20 operations can lose.
inline constexpr double upward = 1 + 0x1p-47, underflow_bound = 0x1p-1050;

template <int N, Arithmetic A = Arithmetic::real>
class TaylorModel {
  public:
    static constexpr int variables = N;
    static constexpr Arithmetic arithmetic = A;
    using Polynomial = TaylorPolynomial<N>;
    using Run = Execution<A>;

    TaylorModel() = default;
    explicit TaylorModel(double constant) { polynomial_.part[0] = Four{constant, 0, 0, 0}; }
    // The variable x_i: center + radius x_i.
    static TaylorModel variable(int i, double center, double radius) {
        TaylorModel x(center);
        x.polynomial_.set(TaylorLayout<N>::linear(i), radius);
        x.first_ = std::abs(radius);
        return x;
    }
    static TaylorModel entire() {
        TaylorModel x;
        x.remainder_ = std::numeric_limits<double>::infinity();
        return x;
    }
    // The same function for an execution in another arithmetic; into float32 it is rounded once.
    template <Arithmetic B>
    explicit TaylorModel(const TaylorModel<N, B>& x) {
        constexpr bool narrows = A == Arithmetic::float32 && B == Arithmetic::float64;
        *this = narrows ? executed(x.polynomial(), x.remainder()) : certified(x.polynomial(), x.remainder());
    }

    const Polynomial& polynomial() const { return polynomial_; }
    double constant() const { return polynomial_.constant(); }
    double linear(int i) const { return polynomial_.linear(i); }
    double pure(int i) const { return polynomial_.pure(i); }
    double mixed(int i, int j) const { return polynomial_.mixed(i, j); }
    double remainder() const { return remainder_; }
    double first_norm() const { return first_; }    // |A_1| = sum |l_i|
    double second_norm() const { return second_; }  // |A_2| = sum |q_i| + sum |x_ij|
    // Bounds of |f - c| and |f|.
    double deviation() const { return first_ + second_ + remainder_; }
    double magnitude() const { return std::abs(constant()) + deviation(); }
    bool is_known() const { return remainder_ < std::numeric_limits<double>::infinity(); }
    bool is_constant() const { return deviation() == 0; }
    // Ends of the range, rounded outward.
    double low() const { return constant() - deviation() * upward - rounding(); }
    double high() const { return constant() + deviation() * upward + rounding(); }

    // The model with just these coefficients and this remainder; `entire` if they are not numbers.
    static TaylorModel exactly(const Polynomial& polynomial, double remainder) {
        const auto [first, second] = polynomial.norms();
        TaylorModel result;
        result.polynomial_ = polynomial;
        result.first_ = first;
        result.second_ = second;
        result.remainder_ = remainder;
        return result.magnitude() < Run::largest ? result : entire();
    }
    // A model from coefficients and a bound of everything that was left out, computed upward but for the last factor.
    static TaylorModel certified(const Polynomial& polynomial, double remainder) {
        return finished(polynomial, remainder, false);
    }
    // The same for the result of an operation, which the execution rounds.
    static TaylorModel executed(const Polynomial& polynomial, double remainder) {
        return finished(polynomial, remainder, true);
    }
    // ... and for one of which the execution's result is off by several roundings.
    static TaylorModel executed(const Polynomial& polynomial, double remainder, double roundings) {
        return finished(polynomial, remainder, true, roundings);
    }

    friend TaylorModel operator+(const TaylorModel& a, const TaylorModel& b) {
        const Polynomial sum = a.polynomial_ + b.polynomial_;
        return summed(sum, a.remainder_ + b.remainder_);
    }
    friend TaylorModel operator-(const TaylorModel& a, const TaylorModel& b) {
        return summed(a.polynomial_ - b.polynomial_, a.remainder_ + b.remainder_);
    }
    friend TaylorModel operator-(const TaylorModel& a) {
        TaylorModel negated = a;
        negated.polynomial_ = Polynomial{} - a.polynomial_;
        return negated;
    }
    friend TaylorModel operator*(const TaylorModel& a, const TaylorModel& b) {
        if (b.first_ + b.second_ == 0) return scaled(a, b);
        if (a.first_ + a.second_ == 0) return scaled(b, a);
        return executed(product(a.polynomial_, b.polynomial_), product_remainder(a, b));
    }

    // What the polynomials' product leaves out, and what rounding it may have changed.
    static double product_remainder(const TaylorModel& a, const TaylorModel& b) {
        const double a0 = std::abs(a.constant()), b0 = std::abs(b.constant());
        const double a_known = a0 + a.first_ + a.second_, b_known = b0 + b.first_ + b.second_;
        return a.first_ * b.second_ + a.second_ * (b.first_ + b.second_) + a.remainder_ * (b_known + b.remainder_) +
               b.remainder_ * a_known + (0x1p-50 * a_known * b_known + underflow_bound);
    }

  private:
    double rounding() const { return 0x1p-52 * (std::abs(constant()) + deviation()) + underflow_bound; }

    // a times a number that is the same everywhere, up to its remainder.
    static TaylorModel scaled(const TaylorModel& a, const TaylorModel& s) {
        const double factor = std::abs(s.constant()), size = a.magnitude();
        return executed(a.polynomial_ * s.constant(),
                        a.remainder_ * factor + size * s.remainder_ + (0x1p-53 * size * factor + underflow_bound));
    }
    // A sum's coefficients have one rounding each, of the result; nothing underflows.
    static TaylorModel summed(const Polynomial& sum, double remainder) {
        const auto [first, second] = sum.norms();
        const double known = std::abs(sum.constant()) + first + second;
        return finished(sum, first, second, known, remainder + 0x1p-53 * known, Run::unit_roundoff, 0);
    }
    static TaylorModel finished(const Polynomial& polynomial, double remainder, bool rounds, double roundings = 1) {
        const auto [first, second] = polynomial.norms();
        const double known = std::abs(polynomial.constant()) + first + second;
        const double relative = rounds ? Run::unit_roundoff * roundings : 0;
        return finished(polynomial, first, second, known, remainder, relative, rounds ? Run::underflow * roundings : 0);
    }
    static TaylorModel finished(const Polynomial& polynomial, double first, double second, double known,
                                double remainder, double relative, double absolute) {
        TaylorModel result;
        if constexpr (Run::unit_roundoff > 0) remainder += relative * (known + remainder) + absolute;
        remainder *= upward;
        if (!(known + remainder < Run::largest)) return entire();  // NaN too
        result.polynomial_ = polynomial;
        result.first_ = first;
        result.second_ = second;
        result.remainder_ = remainder;
        return result;
    }

    Polynomial polynomial_;
    double first_ = 0, second_ = 0, remainder_ = 0;
};

// All of them may run their kernels; what float64 decides, float32 shades.
template <int N, Arithmetic A>
struct NumberTraits<TaylorModel<N, A>> {
    using Mask = Verdict;
    using Wide = TaylorModel<N, A == Arithmetic::float32 ? Arithmetic::float64 : A>;
    static constexpr double unit_roundoff = Execution<A>::unit_roundoff;
};
template <int N, Arithmetic A>
struct ScalarOf<TaylorModel<N, A>> {
    using type = std::conditional_t<A == Arithmetic::float32, float, double>;
};

}  // namespace raybound
