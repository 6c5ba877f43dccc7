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
// so 2 gamma_3 on one side covers both. Exit times 1 + 2 gamma_3 is conservative also with its own two roundings. A
// direction that is itself rounded (in the coordinates of a mesh) adds one: gamma_5.
template <class T>
inline constexpr T slab_widening = T(1) + 2 * gamma<T>(4);
template <class T>
inline constexpr T rounded_slab_widening = T(1) + 2 * gamma<T>(6);

// A ray as slabs see it. The origin that entries are measured from and the one of exits differ where the origin is
// only known within an error: every box is then as good as larger by that error.
template <class T>
struct SlabRay {
    Vec3<T> near_origin, far_origin, reciprocal;
    T widening;
    // Which planes the ray enters and leaves by, of lower x, y, z, upper x, y, z. (Unsigned: addresses need no more.)
    std::uint32_t near_plane[3], far_plane[3];

    // origin +- origin_error is rounded once: the error has to cover that too, where it is not zero.
    SlabRay(const Vec3<T>& origin, const Vec3<T>& origin_error, const Vec3<T>& direction, T widening_)
        : near_origin(origin), far_origin(origin), widening(widening_) {
        for (int axis = 0; axis < 3; ++axis) {
            reciprocal[axis] = T(1) / direction[axis];  // infinite where the direction is 0
            const bool falling = reciprocal[axis] < T(0);
            near_plane[axis] = std::uint32_t(axis + (falling ? 3 : 0));
            far_plane[axis] = std::uint32_t(axis + (falling ? 0 : 3));
            const T error = falling ? -origin_error[axis] : origin_error[axis];
            near_origin[axis] = origin[axis] + error;
            far_origin[axis] = origin[axis] - error;
        }
    }
    explicit SlabRay(const Ray<T>& ray) : SlabRay(ray.origin, {}, ray.direction, slab_widening<T>) {}
};

// Where a ray is inside a box, for one box (V = T) or eight at once (V a pack). A zero direction component on a slab's
// plane gives 0 * infinity = NaN, which `maximum` and `minimum` ignore: a box that is touched is never rejected.
//
// The interval is monotone, since every rounding is: computed numbers too enter a box no earlier than a box around it.
template <class V>
struct BoxInterval {
    V near, far;
};

// plane(i): the planes of number i, as above.
template <class V, class T, class Planes>
inline BoxInterval<V> slab_interval(const SlabRay<T>& ray, T t_max, const Planes& plane) {
    V near(T(0)), far(infinity<T>);
    for (int axis = 0; axis < 3; ++axis) {
        const V r(ray.reciprocal[axis]);
        near = maximum(near, (plane(ray.near_plane[axis]) - V(ray.near_origin[axis])) * r);
        far = minimum(far, (plane(ray.far_plane[axis]) - V(ray.far_origin[axis])) * r);
    }
    return {near, minimum(V(t_max), far * V(ray.widening))};
}

// Does the ray cross the box within [0, t_max]? `entry` tells where, at the earliest.
template <class T>
inline bool crosses(const Box& box, const SlabRay<T>& ray, T t_max, T* entry) {
    const float planes[6] = {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z};
    const auto plane = [&planes](std::uint32_t i) { return T(planes[i]); };
    const BoxInterval<T> inside = slab_interval<T>(ray, t_max, plane);
    *entry = inside.near;
    return inside.near <= inside.far;
}

}  // namespace raybound
