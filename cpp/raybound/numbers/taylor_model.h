// A quadratic polynomial in N variables with a certified remainder (certified-interpolants.md, section 2;
// cpp/derivations.md, D30):
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
#ifdef RAYBOUND_SABOTAGE_ROUNDING
    static constexpr double unit_roundoff = 0;  // the sabotage build: as if executions rounded nothing
#else
    static constexpr double unit_roundoff = 0x1p-24;
#endif
    static constexpr double underflow = 0x1p-150, largest = double(std::numeric_limits<float>::max());
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
    RAYBOUND_INLINE TaylorModel(const TaylorModel& o)
        : polynomial_(o.polynomial_),
          first_(o.first_),
          second_(o.second_),
          known_(o.known_),
          remainder_(o.remainder_) {}
    RAYBOUND_INLINE TaylorModel& operator=(const TaylorModel& o) {
        polynomial_ = o.polynomial_;
        first_ = o.first_;
        second_ = o.second_;
        known_ = o.known_;
        remainder_ = o.remainder_;
        return *this;
    }
    // A plain number, which executions have exactly: for float32 a float.
    explicit TaylorModel(double constant) : known_(std::abs(constant)) {
        polynomial_.part[0] = Four{constant, 0, 0, 0};
    }
    // The variable x_i: center + radius x_i.
    static TaylorModel variable(int i, double center, double radius) {
        TaylorModel x(center);
        x.polynomial_.set(TaylorLayout<N>::linear(i), radius);
        x.first_ = std::abs(radius);
        x.known_ += x.first_;
        return x;
    }
    static TaylorModel entire() {
        TaylorModel x;
        x.remainder_ = std::numeric_limits<double>::infinity();
        return x;
    }
    // The same function for an execution in another arithmetic; into float32 it is rounded once.
    template <Arithmetic B>
    RAYBOUND_INLINE explicit TaylorModel(const TaylorModel<N, B>& x)
        : polynomial_(x.polynomial()),
          first_(x.first_norm()),
          second_(x.second_norm()),
          known_(x.known()),
          remainder_(x.remainder()) {
        if constexpr (A == Arithmetic::float32 && B == Arithmetic::float64)
            remainder_ =
                (remainder_ + (Run::unit_roundoff * known_ + Run::underflow)) * ((1 + Run::unit_roundoff) * upward);
        if constexpr (Run::largest < Execution<B>::largest)
            if (!(magnitude() < Run::largest)) [[unlikely]]
                forget();
    }

    const Polynomial& polynomial() const { return polynomial_; }
    double constant() const { return polynomial_.constant(); }
    double linear(int i) const { return polynomial_.linear(i); }
    double pure(int i) const { return polynomial_.pure(i); }
    double mixed(int i, int j) const { return polynomial_.mixed(i, j); }
    double remainder() const { return remainder_; }
    double first_norm() const { return first_; }    // |A_1| = sum |l_i|
    double second_norm() const { return second_; }  // |A_2| = sum |q_i| + sum |x_ij|
    double known() const { return known_; }         // |c| + |A_1| + |A_2|
    // Bounds of |f - c| and |f|.
    RAYBOUND_INLINE double deviation() const { return first_ + second_ + remainder_; }
    RAYBOUND_INLINE double magnitude() const { return known_ + remainder_; }
    bool is_known() const { return remainder_ < std::numeric_limits<double>::infinity(); }
    bool is_constant() const { return deviation() == 0; }
    // Ends of the range, rounded outward.
    RAYBOUND_INLINE double low() const { return constant() - deviation() * upward - rounding(); }
    RAYBOUND_INLINE double high() const { return constant() + deviation() * upward + rounding(); }

    // The model with just these coefficients and this remainder; `entire` if they are not numbers.
    static TaylorModel exactly(const Polynomial& polynomial, double remainder) {
        const auto [first, second] = polynomial.norms();
        TaylorModel result;
        result.polynomial_ = polynomial;
        result.first_ = first;
        result.second_ = second;
        result.known_ = std::abs(polynomial.constant()) + (first + second);
        result.remainder_ = remainder;
        return result.magnitude() < Run::largest ? result : entire();
    }
    // A model from coefficients and a bound of everything that was left out, computed upward but for the last factor.
    RAYBOUND_INLINE static TaylorModel certified(const Polynomial& polynomial, double remainder) {
        return finished(polynomial, remainder, 0, 0, 0);
    }
    // The same for the result of an operation, which an execution rounds; a function of several may be off by as many
    // `roundings`.
    RAYBOUND_INLINE static TaylorModel executed(const Polynomial& polynomial, double remainder, double roundings = 1) {
        return finished(polynomial, remainder, 0, Run::unit_roundoff * roundings, Run::underflow * roundings);
    }

    RAYBOUND_INLINE friend TaylorModel operator+(const TaylorModel& a, const TaylorModel& b) {
        return summed(a.polynomial_ + b.polynomial_, a.remainder_ + b.remainder_);
    }
    RAYBOUND_INLINE friend TaylorModel operator-(const TaylorModel& a, const TaylorModel& b) {
        return summed(a.polynomial_ - b.polynomial_, a.remainder_ + b.remainder_);
    }
    RAYBOUND_INLINE friend TaylorModel operator-(const TaylorModel& a) {
        TaylorModel negated = a;
        negated.polynomial_ = Polynomial{} - a.polynomial_;
        return negated;
    }
    RAYBOUND_INLINE friend TaylorModel operator*(const TaylorModel& a, const TaylorModel& b) {
        if (b.first_ + b.second_ == 0) return scaled(a, b);
        if (a.first_ + a.second_ == 0) return scaled(b, a);
        return product_of(a, b);
    }
    RAYBOUND_INLINE static TaylorModel product_of(const TaylorModel& a, const TaylorModel& b) {
        return finished(product(a.polynomial_, b.polynomial_), product_remainder(a, b),
                        product_cut(a, b) + (0x1p-50 * (a.known_ * b.known_) + underflow_bound), Run::unit_roundoff,
                        Run::underflow);
    }

    // a b + c d + e f and a b - c d, of which an execution rounds each product and each sum. A product's bound stands
    // for its range: |a b| <= |a| |b|.
    friend TaylorModel sum_of_products(const TaylorModel& a, const TaylorModel& b, const TaylorModel& c,
                                       const TaylorModel& d, const TaylorModel& e, const TaylorModel& f) {
        const double ab = a.known_ * b.known_, cd = c.known_ * d.known_, ef = e.known_ * f.known_;
        return fused(product(a.polynomial_, b.polynomial_) + product(c.polynomial_, d.polynomial_) +
                         product(e.polynomial_, f.polynomial_),
                     product_remainder(a, b) + product_remainder(c, d) + product_remainder(e, f),
                     product_cut(a, b) + product_cut(c, d) + product_cut(e, f), ab + cd + ef, (ab + cd) * 2 + ef);
    }
    RAYBOUND_INLINE friend TaylorModel difference_of_products(const TaylorModel& a, const TaylorModel& b,
                                                              const TaylorModel& c, const TaylorModel& d) {
        const double sizes = a.known_ * b.known_ + c.known_ * d.known_;
        return fused(product(a.polynomial_, b.polynomial_) - product(c.polynomial_, d.polynomial_),
                     product_remainder(a, b) + product_remainder(c, d), product_cut(a, b) + product_cut(c, d), sizes,
                     sizes);
    }

    // constant + sum slopes[i] x[i], of which an execution rounds each product and each sum.
    template <std::size_t M>
    friend TaylorModel affine(double constant, const std::array<double, M>& slopes,
                              const std::array<TaylorModel, M>& x) {
        Polynomial sum = TaylorModel(constant).polynomial_;
        double sizes = std::abs(constant), remainder = 0;
        for (std::size_t i = 0; i < M; ++i) {
            if (slopes[i] == 0) continue;
            sum = sum + x[i].polynomial_ * slopes[i];
            sizes += x[i].known_ * std::abs(slopes[i]);
            remainder += x[i].remainder_ * std::abs(slopes[i]);
        }
        static_assert(M <= 4, "coefficients are off by gamma_(M + 1)");
        return fused(sum, remainder * (1 + 2 * Run::unit_roundoff), 0, sizes, (M + 1) * sizes);
    }

  private:
    RAYBOUND_INLINE double rounding() const { return 0x1p-52 * magnitude() + underflow_bound; }

    // What a product of polynomials leaves out, and what it makes of the factors' remainders.
    RAYBOUND_INLINE static double product_cut(const TaylorModel& a, const TaylorModel& b) {
        return a.first_ * b.second_ + a.second_ * (b.first_ + b.second_);
    }
    RAYBOUND_INLINE static double product_remainder(const TaylorModel& a, const TaylorModel& b) {
        return a.remainder_ * b.known_ + b.remainder_ * (a.known_ + a.remainder_);
    }
    // a times a number that is the same everywhere, up to its remainder.
    RAYBOUND_INLINE static TaylorModel scaled(const TaylorModel& a, const TaylorModel& s) {
        return finished(a.polynomial_ * s.constant(), product_remainder(a, s),
                        0x1p-53 * (a.known_ * s.known_) + underflow_bound, Run::unit_roundoff, Run::underflow);
    }
    // A sum of products: `sizes` bounds the sum of what was multiplied, `intermediate` the sum of what an execution
    // rounds before its last sum; it does so at most four times to anything, and once more to its own roundings.
    // Coefficients are off by at most gamma_7 of `sizes`.
    RAYBOUND_INLINE static TaylorModel fused(const Polynomial& sum, double remainder, double cut, double sizes,
                                             double intermediate) {
        constexpr double u = Run::unit_roundoff;
        const double rest =
            cut + (0x1p-49 * sizes + u * (1 + 8 * u) * intermediate) + (underflow_bound + 5 * Run::underflow);
        TaylorModel result = finished(sum, remainder * (1 + 3 * u), rest, u, 0);
        if (!(sizes + result.remainder_ < Run::largest)) [[unlikely]]
            result.forget();  // the execution's products may overflow where their sum does not
        return result;
    }
    // A sum's coefficients have one rounding each, of the result; nothing underflows.
    RAYBOUND_INLINE static TaylorModel summed(const Polynomial& sum, double remainder) {
        return finished(sum, remainder, 0, Run::unit_roundoff, 0, 0x1p-53);
    }
    // The bound is (remainder + rest + own |polynomial|) plus `relative` of all and `absolute`. What depends on other
    // remainders stands apart: it is what the next operation waits for.
    RAYBOUND_INLINE static TaylorModel finished(const Polynomial& polynomial, double remainder, double rest,
                                                double relative, double absolute, double own = 0) {
        TaylorModel result;
        result.polynomial_ = polynomial;
        const auto [first, second] = polynomial.norms();
        const double known = std::abs(polynomial.constant()) + (first + second);
        const double added = rest + ((relative + own) * known + absolute), factor = (1 + relative) * upward;
        result.first_ = first;
        result.second_ = second;
        result.known_ = known;
        result.remainder_ = (remainder + added) * factor;
        if (!(known + result.remainder_ < Run::largest)) [[unlikely]]
            result.forget();  // NaN too
        return result;
    }
    [[gnu::noinline]] void forget() { *this = entire(); }

    Polynomial polynomial_;
    double first_ = 0, second_ = 0, known_ = 0, remainder_ = 0;  // known_: |c| + first_ + second_
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
