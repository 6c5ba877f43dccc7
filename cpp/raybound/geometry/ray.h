// Rays, and the origins of rays that leave a surface.
#pragma once

#include "raybound/geometry/vector.h"
#include "raybound/numbers/pack_functions.h"

namespace raybound {

// A ray o + t d, or, toward a light, the segment that ends in `target` at t = t_max.
template <class T>
struct Ray {
    Vec3<T> origin, direction;
    T t_max = infinity<T>;
    Vec3<T> target{};
    bool has_target = false;
};

// A component below this moves the ray by less than 2^-120 t: it is flushed to zero, so that its reciprocal stays
// finite (an infinite reciprocal of a subnormal would wrongly reject slabs).
template <class T>
inline constexpr T least_direction = T(0x1p-120);

template <class T>
inline T flush_component(T d) {
    return select(abs(d) < least_direction<T>, T(0), d);
}

template <class T>
inline Vec3<T> flushed(const Vec3<T>& d) {
    return {flush_component(d.x), flush_component(d.y), flush_component(d.z)};
}

// Rays are made in one go, where they stay: to copy what has just been written, in wider pieces, stalls a processor.
template <class T>
inline Ray<T> make_ray(const Vec3<T>& origin, const Vec3<T>& direction) {
    return {origin, flushed(direction)};
}

// The power of two at or below |x|, for x normal: a scale that rounds nothing.
template <std::floating_point T>
inline T power_of_two_below(T x) {
    constexpr auto exponent_mask = std::bit_cast<Bits<T>>(infinity<T>);
    return std::bit_cast<T>(static_cast<Bits<T>>(std::bit_cast<Bits<T>>(x) & exponent_mask));
}

// The segment from `origin` to `target`, parametrised so that its direction is about as long as 1 (squares of squares
// stay in range at every scale) and the target lies at t_max, a power of two.
template <class T>
inline Ray<T> make_segment(const Vec3<T>& origin, const Vec3<T>& target, T scale) {
    return {origin, flushed((target - origin) * (T(1) / scale)), scale, target, true};
}

template <class T>
inline Ray<T> make_segment(const Vec3<T>& origin, const Vec3<T>& target) {
    const T reach = max_component(absolute(target - origin));
    return make_segment(origin, target, power_of_two_below(maximum(reach, T(0x1p-100))));
}

// A direction as users give it, whose length is not subnormal, scaled by a power of two so that its largest component
// is in [1, 2): nothing but components too small to matter is rounded, and a t along it is `scale` times a t along the
// original.
template <std::floating_point T>
inline void scale_direction(Vec3<T>& d, T& scale) {
    scale = power_of_two_below(max_component(absolute(d)));
    d = d * (T(1) / scale);
}

// The unit vector of such a direction. One that is a unit vector up to rounding is kept bit for bit.
template <std::floating_point T>
inline void make_unit(Vec3<T>& d) {
    if (abs(dot(d, d) - T(1)) <= 16 * NumberTraits<T>::unit_roundoff) return;
    T scale;
    scale_direction(d, scale);
    d = normalize(d);
}

// The same ray for the wide type. A segment's direction is taken anew from its ends, which are exact: so "before the
// light" is decided without the rounding of the direction, and no shadow epsilon is needed (derivation D4).
template <class T>
inline Ray<Wide<T>> widen(const Ray<T>& ray) {
    using W = Wide<T>;
    if (ray.has_target) return make_segment(Vec3<W>(ray.origin), Vec3<W>(ray.target), W(ray.t_max));
    return {Vec3<W>(ray.origin), Vec3<W>(ray.direction), W(ray.t_max)};
}

// One coordinate moved by `offset` and rounded away from where it was, by at least one number.
template <class T>
inline T step_away(T p, T offset, T direction) {
    const T moved = p + offset;
    if constexpr (std::is_same_v<Mask<T>, bool>) {  // branches are cheaper than choices for one number
        if (direction > T(0)) return next_float_up(moved);
        return direction < T(0) ? next_float_down(moved) : moved;
    } else {
        return select(direction > T(0), next_float_up(moved), select(direction < T(0), next_float_down(moved), moved));
    }
}

// The origin of a ray that leaves p on the side to which `side` points (a unit normal or its opposite): outside the
// box p +- p_error, by the least move along the normal (seeds/000, 3.9.5). Unlike there a coordinate is also stepped
// when the bound is zero, so that an origin on an exact plane leaves it.
template <class T>
inline Vec3<T> offset_origin(const Vec3<T>& p, const Vec3<T>& p_error, const Vec3<T>& side) {
    const T d = dot(absolute(side), p_error) * (T(1) + gamma<T>(4));
    return {step_away(p.x, d * side.x, side.x), step_away(p.y, d * side.y, side.y), step_away(p.z, d * side.z, side.z)};
}

// The same with the side chosen by the new direction w: that of n, or of -n where w points against n.
template <std::floating_point T>
inline Vec3<T> spawn_origin(const Vec3<T>& p, const Vec3<T>& p_error, const Vec3<T>& n, const Vec3<T>& w) {
    return offset_origin(p, p_error, dot(w, n) < 0 ? -n : n);
}

}  // namespace raybound
