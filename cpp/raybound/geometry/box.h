// Axis-aligned boxes that bound what they hold, and slab tests that never lose a ray (seeds/000, 3.9.2).
#pragma once

#include "raybound/geometry/ray.h"
#include "raybound/numbers/pack.h"

namespace raybound {

template <class T>
struct Bounds {
    Vec3<T> lower{infinity<T>, infinity<T>, infinity<T>};
    Vec3<T> upper{-infinity<T>, -infinity<T>, -infinity<T>};

    bool operator==(const Bounds&) const = default;
    bool is_empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
    void extend(const Vec3<T>& p) {
        lower = minimum(lower, p);
        upper = maximum(upper, p);
    }
    void extend(const Bounds& b) {
        lower = minimum(lower, b.lower);
        upper = maximum(upper, b.upper);
    }
    Vec3<T> extent() const { return upper - lower; }
    Vec3<T> center() const { return (lower + upper) * T(0.5); }
    T half_area() const {
        const Vec3<T> e = extent();
        return e.x * e.y + e.y * e.z + e.z * e.x;
    }
};

using Box = Bounds<float>;
using Boxd = Bounds<double>;

inline Boxd intersection(const Boxd& a, const Boxd& b) {
    return {maximum(a.lower, b.lower), minimum(a.upper, b.upper)};
}

// The least box of floats around a box of doubles.
inline Box round_outward(const Boxd& box) {
    const auto down = [](double x) { return double(float(x)) > x ? next_float_down(float(x)) : float(x); };
    const auto up = [](double x) { return double(float(x)) < x ? next_float_up(float(x)) : float(x); };
    return {{down(box.lower.x), down(box.lower.y), down(box.lower.z)},
            {up(box.upper.x), up(box.upper.y), up(box.upper.z)}};
}

// How much a slab's exit is pushed out: entry and exit each carry three roundings (difference, reciprocal, product),
// so 2 gamma_3 on one side covers both. Exit times 1 + 2 gamma_3 is conservative also with its own two roundings.
template <class T>
inline constexpr T slab_widening = T(1) + 2 * gamma<T>(4);

// Where the ray is inside a box, for one box (V = T) or four at once. A zero direction component on a slab's plane
// gives 0 * infinity = NaN, which `maximum` and `minimum` ignore: a box that is touched is never rejected.
//
// The interval is monotone, since every rounding is: computed numbers too enter a box no earlier than a box around it.
template <class V>
struct BoxInterval {
    V near, far;
};

template <class V, class T>
inline BoxInterval<V> slab_interval(const V (&lower)[3], const V (&upper)[3], const Ray<T>& ray, T t_min, T t_max) {
    V near = V{} + t_min, far = V{} + t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const T r = ray.reciprocal[axis];
        const V first = r < 0 ? upper[axis] : lower[axis], last = r < 0 ? lower[axis] : upper[axis];
        near = maximum(near, (first - ray.origin[axis]) * r);
        far = minimum(far, (last - ray.origin[axis]) * r * slab_widening<T>);
    }
    return {near, far};
}

// Does the ray cross the box within [0, t_max]? `entry` tells where, at the earliest.
template <class T>
inline Mask<T> crosses(const Box& box, const Ray<T>& ray, T t_max, T* entry) {
    const T lower[3] = {T(box.lower.x), T(box.lower.y), T(box.lower.z)};
    const T upper[3] = {T(box.upper.x), T(box.upper.y), T(box.upper.z)};
    const BoxInterval<T> inside = slab_interval(lower, upper, ray, T(0), t_max);
    *entry = inside.near;
    return inside.near <= inside.far;
}

}  // namespace raybound
