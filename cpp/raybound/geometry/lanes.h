// Single lanes of packs and of vectors of packs: taken out, and put back.
#pragma once

#include "raybound/geometry/vector.h"
#include "raybound/numbers/pack.h"

namespace raybound {

template <class T>
inline Vec3<T> lane_of(const Vec3<Pack<T>>& v, int lane) {
    return {v.x[lane], v.y[lane], v.z[lane]};
}
template <class T>
inline void set_lane(Pack<T>& pack, int lane, T x) {
    pack.v[lane] = x;
}
template <class T>
inline void set_lane(Vec3<Pack<T>>& v, int lane, const Vec3<T>& x) {
    set_lane(v.x, lane, x.x);
    set_lane(v.y, lane, x.y);
    set_lane(v.z, lane, x.z);
}
template <class T>
inline void set_lane(PackMask<T>& mask, int lane, bool yes) {
    mask.lanes[lane] = yes ? -1 : 0;
}
// The vectors lane(0), lane(1), ... side by side.
template <class T, class Function>
inline Vec3<Pack<T>> side_by_side(const Function& lane) {
    T x[pack_width], y[pack_width], z[pack_width];
    for (int i = 0; i < pack_width; ++i) {
        const Vec3<T>& v = lane(i);
        x[i] = v.x, y[i] = v.y, z[i] = v.z;
    }
    return {Pack<T>::load(x), Pack<T>::load(y), Pack<T>::load(z)};
}

// Calls visit(lane) for each of a set.
template <class Visit>
inline void for_each_lane(std::uint32_t lanes, const Visit& visit) {
    for (; lanes != 0; lanes &= lanes - 1) visit(std::countr_zero(lanes));
}

}  // namespace raybound
