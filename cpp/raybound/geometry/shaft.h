// Shafts: what all rays of a bundle pass through. A bundle's origins lie in a patch, a parallelepiped; the rays end in
// one point, or go in one direction, or in any direction of a box (Haines and Wallace 1991; thesis 5.1.2).
#pragma once

#include "raybound/geometry/box.h"

namespace raybound {

// center + sum of r_i axis_i with |r_i| <= 1.
struct Patch {
    Vec3d center;
    std::array<Vec3d, 3> axis;

    Vec3d reach() const { return absolute(axis[0]) + absolute(axis[1]) + absolute(axis[2]); }
    Boxd bounds() const { return {center - reach(), center + reach()}; }

    // One that holds a box; its own roundings are within what it is larger.
    static Patch around(const Boxd& box) {
        const Vec3d half = box.extent() * (0.5 * (1 + 0x1p-40));
        return {box.center(), {Vec3d{half.x, 0, 0}, Vec3d{0, half.y, 0}, Vec3d{0, 0, half.z}}};
    }

    // The corner whose r_i are -1 or 1 by the bits of `index`.
    Vec3d corner(int index) const;

    // The point farthest along n.
    Vec3d support(const Vec3d& n) const {
        Vec3d p = center;
        for (const Vec3d& a : axis) p = p + (dot(a, n) > 0 ? a : -a);
        return p;
    }
};

inline Vec3d Patch::corner(int index) const {
    Vec3d p = center;
    for (int i = 0; i < 3; ++i) p = p + (index >> i & 1 ? axis[std::size_t(i)] : -axis[std::size_t(i)]);
    return p;
}

// A box that moves and grows: at the time s, 0 <= s <= s_max, it is [lower + s lower_rate, upper + s upper_rate]. Rays
// from a box of origins in a box of directions are in it at their t = s; rays between a box and a point, too, with the
// times counted from the point.
//
// Each face of another box is met from one time on, or until one time: the boxes have met if there is a time that
// suits all. A product (face - position) * reciprocal has three roundings, and what rays themselves compute against
// boxes has four on each side (D5): 2^-17 of the time is more than all of that (derivation D40).
class SweptBox {
  public:
    SweptBox(const Boxd& start, const Vec3d& least_rate, const Vec3d& greatest_rate, double s_max);

    // Which of eight boxes are met, and when at the earliest; plane(i) as in slab_interval.
    template <class Planes>
    std::uint32_t meets(const Planes& plane, float until, Pack<float>& near) const;

    bool meets(const Box& box, float until, float& near) const;
    bool meets(const Box& box) const {
        float near;
        return meets(box, s_max_, near);
    }

    // No position counted from the start is off by more than this part of the time.
    static constexpr float widening = 1 + 0x1p-17f;

  private:
    // A face against which the box moves: times (face - at) * rate are a beginning or an end.
    struct Side {
        float at, reciprocal;
        bool begins;
    };
    static float slow(float rate, int outward) {
        if (!(abs(rate) < least_direction<float>)) return rate;
        return rate * float(outward) > 0 ? float(outward) * least_direction<float> : 0.0f;
    }

    // From when, and until when, all sides are met.
    template <class V, class Planes>
    void times(const Planes& plane, V& first, V& last) const;

    std::array<Side, 3> lower_, upper_;
    float s_max_;
};

inline SweptBox::SweptBox(const Boxd& start, const Vec3d& least_rate, const Vec3d& greatest_rate, double s_max)
    : s_max_(s_max < 0x1p126 ? next_float_up(float(s_max)) : 0x1p126f) {
    const Box outward = round_outward(start);
    const Box rates = round_outward({least_rate, greatest_rate});
    for (int i = 0; i < 3; ++i) {
        // lower + s rate <= the box's upper face; a rate of 0 says the same of all times. (Rates whose reciprocal
        // would not be finite are rounded outward.)
        const float down = slow(rates.lower[i], -1), up = slow(rates.upper[i], 1);
        lower_[std::size_t(i)] = {outward.lower[i], down == 0 ? infinity<float> : 1 / down, down < 0};
        // upper + s rate >= the box's lower face
        upper_[std::size_t(i)] = {outward.upper[i], up == 0 ? -infinity<float> : 1 / up, up > 0};
    }
}

template <class V, class Planes>
inline void SweptBox::times(const Planes& plane, V& first, V& last) const {
    const auto bound = [&](const Side& side, const V& face) {
        const V time = (face - V(side.at)) * V(side.reciprocal);
        if (side.begins)
            first = maximum(first, time);
        else
            last = minimum(last, time);
    };
    for (std::uint32_t i = 0; i < 3; ++i) {
        bound(lower_[i], plane(i + 3));
        bound(upper_[i], plane(i));
    }
}

template <class Planes>
inline std::uint32_t SweptBox::meets(const Planes& plane, float until, Pack<float>& near) const {
    Pack<float> first(0.0f), last(minimum(until, s_max_));
    times(plane, first, last);
    near = first;
    return bits(first <= last * Pack<float>(widening));
}

inline bool SweptBox::meets(const Box& box, float until, float& near) const {
    float first = 0, last = minimum(until, s_max_);
    times([&](std::uint32_t i) { return i < 3 ? box.lower[int(i)] : box.upper[int(i) - 3]; }, first, last);
    near = first;
    return first <= last * widening;
}

}  // namespace raybound
