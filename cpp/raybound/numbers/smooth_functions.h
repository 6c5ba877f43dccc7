// Smooth functions with bounds of their derivatives over an interval, for expansions around a point of it (D21).
//
// Each offers, over intervals K and Y with K within Y (Y convex: it holds what lies between k and y),
//   is_defined(Y), is_smooth(Y)   f is defined, and twice differentiable, at every point of Y
//   value(Y), derivative(K)       enclosures of f and f'
//   slope(K, Y)                   of (f(y) - f(k)) / (y - k), which is f' somewhere between
//   curvature(K, Y)               of (f(y) - f(k) - f'(k) (y - k)) / (y - k)^2, which is f''/2 somewhere between
// The last two are closed forms where there are any: they are tighter than f'(Y) and f''(Y)/2. Underflow or overflow
// within them makes them unbounded, not wrong.
#pragma once

#include <algorithm>
#include <climits>

#include "raybound/numbers/interval_functions.h"

namespace raybound::smooth {

using Bound = Interval<double>;

inline bool is_positive(const Bound& x) { return x.inf() > 0; }

// For functions that know f'(Y) and f''(Y): slope and curvature by the mean value.
template <class Function>
struct ByMeanValue {
    bool is_defined(const Bound& y) const { return is_smooth(y); }
    bool is_smooth(const Bound& y) const { return !y.is_empty(); }
    Bound slope(const Bound&, const Bound& y) const { return self().derivative(y); }
    Bound curvature(const Bound&, const Bound& y) const { return self().second_derivative(y) * Bound(0.5); }

  private:
    const Function& self() const { return static_cast<const Function&>(*this); }
};

struct Exponential : ByMeanValue<Exponential> {
    Bound value(const Bound& x) const { return exp(x); }
    Bound derivative(const Bound& x) const { return exp(x); }
    Bound second_derivative(const Bound& x) const { return exp(x); }
};

struct Logarithm : ByMeanValue<Logarithm> {
    bool is_defined(const Bound& x) const { return is_positive(x); }
    bool is_smooth(const Bound& x) const { return is_positive(x); }
    Bound value(const Bound& x) const { return log(x); }
    Bound derivative(const Bound& x) const { return reciprocal(x); }
    Bound second_derivative(const Bound& x) const { return -reciprocal(square(x)); }
};

struct Sine : ByMeanValue<Sine> {
    Bound value(const Bound& x) const { return sin(x); }
    Bound derivative(const Bound& x) const { return cos(x); }
    Bound second_derivative(const Bound& x) const { return -sin(x); }
};

struct Cosine : ByMeanValue<Cosine> {
    Bound value(const Bound& x) const { return cos(x); }
    Bound derivative(const Bound& x) const { return -sin(x); }
    Bound second_derivative(const Bound& x) const { return -cos(x); }
};

struct Tangent : ByMeanValue<Tangent> {
    bool is_defined(const Bound& x) const { return is_smooth(x); }
    bool is_smooth(const Bound& x) const {
        const Bound t = tan(x);
        return t.inf() > -infinity<double> && t.sup() < infinity<double>;  // no pole
    }
    Bound value(const Bound& x) const { return tan(x); }
    Bound derivative(const Bound& x) const { return Bound(1.0) + square(tan(x)); }
    Bound second_derivative(const Bound& x) const {
        const Bound t = tan(x);
        return (t + power(t, 3)) * Bound(2.0);
    }
};

struct ArcSine : ByMeanValue<ArcSine> {
    bool is_defined(const Bound& x) const { return x.mag() <= 1; }
    bool is_smooth(const Bound& x) const { return x.mag() < 1; }
    Bound value(const Bound& x) const { return asin(x); }
    Bound derivative(const Bound& x) const { return rsqrt(Bound(1.0) - square(x)); }
    // x (1 - x^2)^(-3/2) rises.
    Bound second_derivative(const Bound& x) const { return hull(second_at(x.inf()), second_at(x.sup())); }

  private:
    static Bound second_at(double x) {
        const Bound point(x), rest = Bound(1.0) - square(point);
        return point / (rest * sqrt(rest));
    }
};

struct ArcCosine : ByMeanValue<ArcCosine> {
    bool is_defined(const Bound& x) const { return ArcSine{}.is_defined(x); }
    bool is_smooth(const Bound& x) const { return ArcSine{}.is_smooth(x); }
    Bound value(const Bound& x) const { return acos(x); }
    Bound derivative(const Bound& x) const { return -ArcSine{}.derivative(x); }
    Bound second_derivative(const Bound& x) const { return -ArcSine{}.second_derivative(x); }
};

struct ArcTangent : ByMeanValue<ArcTangent> {
    Bound value(const Bound& x) const { return atan(x); }
    Bound derivative(const Bound& x) const { return reciprocal(Bound(1.0) + square(x)); }
    // -2 x / (1 + x^2)^2, whose extremes are -+ 3 sqrt(3) / 8 = 0.6495...
    Bound second_derivative(const Bound& x) const {
        return intersection(x * Bound(-2.0) * square(derivative(x)), Bound(-0.65, 0.65));
    }
};

struct SquareRoot {
    bool is_defined(const Bound& x) const { return x.inf() >= 0; }
    bool is_smooth(const Bound& x) const { return is_positive(x); }
    Bound value(const Bound& x) const { return sqrt(x); }
    Bound derivative(const Bound& k) const { return reciprocal(sqrt(k) * Bound(2.0)); }
    Bound slope(const Bound& k, const Bound& y) const { return reciprocal(sqrt(k) + sqrt(y)); }
    Bound curvature(const Bound& k, const Bound& y) const { return -(derivative(k) * square(slope(k, y))); }
};

// With p = sqrt(k) and q = sqrt(y): slope -1 / (p q (p + q)), curvature (2 p + q) / (2 p^3 q (p + q)^2), where
// (2 p + q) / (p + q) = 1 + 1 / (1 + q / p).
struct ReciprocalSquareRoot {
    bool is_defined(const Bound& x) const { return is_positive(x); }
    bool is_smooth(const Bound& x) const { return is_positive(x); }
    Bound value(const Bound& x) const { return rsqrt(x); }
    Bound derivative(const Bound& k) const { return -reciprocal(k * sqrt(k) * Bound(2.0)); }
    Bound slope(const Bound& k, const Bound& y) const {
        const Bound p = sqrt(k), q = sqrt(y);
        return -reciprocal(p * q * (p + q));
    }
    Bound curvature(const Bound& k, const Bound& y) const {
        const Bound p = sqrt(k), q = sqrt(y), one(1.0);
        return derivative(k) * (one + reciprocal(one + q / p)) * -reciprocal(q * (p + q));
    }
};

struct Reciprocal {
    bool is_defined(const Bound& x) const { return !x.contains_zero(); }
    bool is_smooth(const Bound& x) const { return !x.contains_zero(); }
    Bound value(const Bound& x) const { return reciprocal(x); }
    Bound derivative(const Bound& k) const { return -reciprocal(square(k)); }
    Bound slope(const Bound& k, const Bound& y) const { return -reciprocal(k * y); }
    Bound curvature(const Bound& k, const Bound& y) const { return reciprocal(square(k) * y); }
};

struct Power : ByMeanValue<Power> {
    explicit Power(int n) : exponent(n) {}
    bool is_defined(const Bound& x) const { return is_smooth(x); }
    bool is_smooth(const Bound& x) const { return exponent >= 0 || !x.contains_zero(); }
    Bound value(const Bound& x) const { return power(x, exponent); }
    Bound derivative(const Bound& x) const { return falling(1) * lowered(x, 1); }
    Bound second_derivative(const Bound& x) const { return falling(1) * falling(2) * lowered(x, 2); }

    int exponent;

  private:
    // n - order + 1, the factor that the order-th derivative brings: 0 for the derivatives that vanish.
    Bound falling(int order) const { return Bound(double(exponent) - order + 1); }
    // x^(n - order); whatever where `falling` is 0.
    Bound lowered(const Bound& x, int order) const {
        if (exponent < INT_MIN + order) return power(x, exponent) / power(x, order);
        return power(x, exponent >= 0 ? std::max(exponent - order, 0) : exponent - order);
    }
};

// g(x) = exp((1 - 1/x^2) / sigma^2), g(0) = 0: a Gaussian in the tangent of arccos x, and smooth everywhere. With
// s = 1 / (sigma x)^2,
//     g' = 2 s g / x,   |g'| greatest at s = 3/2;   g'' = (4 s - 6) s g / x^2,   extreme at s = (9 -+ sqrt 33) / 4,
// monotone in between, and falling to 0 with x: so their ranges are those of a few points, where interval arithmetic
// on the formulas meets 1/0 times 0 (thesis 4.3.7, which prints tan^2 = 1 - 1/x^2 for 1/x^2 - 1 but has the right g).
struct WardLobe : ByMeanValue<WardLobe> {
    // Throws std::invalid_argument unless sigma > 0.
    explicit WardLobe(double roughness) : sigma(roughness) {
        if (!(roughness > 0 && roughness < infinity<double>))
            throw std::invalid_argument("ward_lobe: sigma must be > 0 and finite, got " + std::to_string(roughness));
    }
    Bound value(const Bound& x) const { return ward_lobe(x, sigma); }
    // g' is odd.
    Bound derivative(const Bound& x) const {
        if (x.inf() >= 0) return slope_over(x);
        if (x.sup() <= 0) return -slope_over(-x);
        return hull(slope_over({0, x.sup()}), -slope_over({0, -x.inf()}));
    }
    // g'' is even.
    Bound second_derivative(const Bound& x) const {
        const Bound size = abs(x);
        Bound range = hull(bend_at(size.inf()), bend_at(size.sup()));
        for (const double extreme : {0x1.a0b22bd3a5e20p-1, 0x1.d7d3750b16878p+1}) {
            const Bound s(next_float_down(extreme), next_float_up(extreme));
            if (reaches(size, s))
                range = hull(range, (s * Bound(4.0) - Bound(6.0)) * square(s * Bound(sigma)) * lobe(s));
        }
        return range;
    }

    double sigma;

  private:
    Bound inverse_square(double x) const { return reciprocal(square(Bound(x) * Bound(sigma))); }
    // g as a function of s.
    Bound lobe(const Bound& s) const { return exp(reciprocal(square(Bound(sigma))) - s); }
    // Does 1 / (sigma x)^2 take the value s for an x of the range, as far as can be told?
    bool reaches(const Bound& x, const Bound& s) const {
        return inverse_square(x.sup()).inf() <= s.sup() && (x.inf() == 0 || inverse_square(x.inf()).sup() >= s.inf());
    }
    // g < e^-10000 at x: with any power of s that doubles can express it is below the least of them.
    bool vanishes_at(double x) const {
        return x == 0 || (inverse_square(x) - reciprocal(square(Bound(sigma)))).inf() > 1e4;
    }
    Bound slope_at(double x) const {
        if (vanishes_at(x)) return {0, std::numeric_limits<double>::denorm_min()};
        return inverse_square(x) * Bound(2.0) / Bound(x) * value(Bound(x));
    }
    Bound slope_over(const Bound& x) const {
        const Bound range = hull(slope_at(x.inf()), slope_at(x.sup())), s(1.5);
        return reaches(x, s) ? hull(range, s * sqrt(s) * Bound(2.0) * Bound(sigma) * lobe(s)) : range;
    }
    Bound bend_at(double x) const {
        if (vanishes_at(x)) return {0, std::numeric_limits<double>::denorm_min()};
        const Bound s = inverse_square(x);
        return (s * Bound(4.0) - Bound(6.0)) * (s / square(Bound(x))) * value(Bound(x));
    }
};

}  // namespace raybound::smooth
