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

    explicit SlabRay(const Ray<T>& ray) : SlabRay(ray.origin, ray.origin, ray.direction, slab_widening<T>) {}

    // origin +- origin_error is rounded once: the error has to cover that too.
    SlabRay(const Vec3<T>& origin, const Vec3<T>& origin_error, const Vec3<T>& direction)
        : SlabRay(origin + turned(origin_error, direction), origin - turned(origin_error, direction), direction,
                  rounded_slab_widening<T>) {}

  private:
    // 1/d is infinite where d is 0.
    SlabRay(const Vec3<T>& near, const Vec3<T>& far, const Vec3<T>& d, T widening_)
        : near_origin(near.x, near.y, near.z),
          far_origin(far.x, far.y, far.z),
          reciprocal(T(1) / d.x, T(1) / d.y, T(1) / d.z),
          widening(widening_) {
        for (int axis = 0; axis < 3; ++axis) {
            const bool falling = reciprocal[axis] < T(0);
            near_plane[axis] = std::uint32_t(axis + (falling ? 3 : 0));
            far_plane[axis] = std::uint32_t(axis + (falling ? 0 : 3));
        }
    }
    static Vec3<T> turned(const Vec3<T>& error, const Vec3<T>& d) {
        return {copysign(error.x, d.x), copysign(error.y, d.y), copysign(error.z, d.z)};
    }
};

// Several rays from one origin. Every operation of a slab test is monotone, so the least entry and the greatest exit of
// the bundle's reciprocals bound those of each of its rays, as computed.
struct SlabBundle {
    Vec3f origin;
    Vec3f least, greatest;  // of the reciprocals

    explicit SlabBundle(const Vec3f& o)
        : origin(o),
          least{infinity<float>, infinity<float>, infinity<float>},
          greatest{-infinity<float>, -infinity<float>, -infinity<float>} {}
    void add(const Vec3f& reciprocal) {
        least = minimum(least, reciprocal);
        greatest = maximum(greatest, reciprocal);
    }
    // Rays of both directions along an axis, or across it, are not told apart from boxes by it.
    bool tells(int axis) const {
        return (least[axis] > 0 && greatest[axis] < infinity<float>) ||
               (greatest[axis] < 0 && least[axis] > -infinity<float>);
    }
};

// Where a ray is inside a box, for one box (V = T) or eight at once (V a pack). A zero direction component on a slab's
// plane gives 0 * infinity = NaN, which `maximum` and `minimum` ignore: a box that is touched is never rejected.
//
// The interval is monotone, since every rounding is: computed numbers too enter a box no earlier than a box around it.
template <class V>
struct BoxInterval {
    V near, far;
};

template <class V>
inline void clip_to_slab(BoxInterval<V>& inside, const V& near_distance, const V& far_distance, const V& reciprocal) {
    inside.near = maximum(inside.near, near_distance * reciprocal);
    inside.far = minimum(inside.far, far_distance * reciprocal);
}

// plane(i): the planes of number i, as above.
template <class V, class T, class Planes>
inline BoxInterval<V> slab_interval(const SlabRay<T>& ray, T t_max, const Planes& plane) {
    BoxInterval<V> inside{V(T(0)), V(infinity<T>)};
    for (int axis = 0; axis < 3; ++axis)
        clip_to_slab(inside, plane(ray.near_plane[axis]) - V(ray.near_origin[axis]),
                     plane(ray.far_plane[axis]) - V(ray.far_origin[axis]), V(ray.reciprocal[axis]));
    return {inside.near, minimum(V(t_max), inside.far * V(ray.widening))};
}

// The same for several rays at one box: each lane has near and far planes of its own.
template <class T>
inline BoxInterval<Pack<T>> slab_interval(const Box& box, const Ray<Pack<T>>& rays, const Pack<T>& t_max) {
    using P = Pack<T>;
    BoxInterval<P> inside{P(T(0)), P(infinity<T>)};
    const auto clip = [&](float lower, float upper, const P& origin, const P& direction) {
        const P r = P(T(1)) / direction, to_lower = P(T(lower)) - origin, to_upper = P(T(upper)) - origin;
        const Mask<P> falling = r < P(T(0));
        clip_to_slab(inside, select(falling, to_upper, to_lower), select(falling, to_lower, to_upper), r);
    };
    clip(box.lower.x, box.upper.x, rays.origin.x, rays.direction.x);
    clip(box.lower.y, box.upper.y, rays.origin.y, rays.direction.y);
    clip(box.lower.z, box.upper.z, rays.origin.z, rays.direction.z);
    return {inside.near, minimum(t_max, inside.far * P(slab_widening<T>))};
}

// The same for a bundle: from the first entry to the last exit.
template <class Planes>
inline BoxInterval<Pack<float>> slab_interval(const SlabBundle& bundle, const Planes& plane) {
    using P = Pack<float>;
    P near(0.0f), far(infinity<float>);
    for (int axis = 0; axis < 3; ++axis) {
        if (!bundle.tells(axis)) continue;
        const bool falling = bundle.greatest[axis] < 0;
        const P low(bundle.least[axis]), high(bundle.greatest[axis]), o(bundle.origin[axis]);
        const P entry = plane(std::uint32_t(axis + (falling ? 3 : 0))) - o;
        const P exit = plane(std::uint32_t(axis + (falling ? 0 : 3))) - o;
        near = maximum(near, minimum(entry * low, entry * high));
        far = minimum(far, maximum(exit * low, exit * high));
    }
    return {near, far * P(slab_widening<float>)};
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
