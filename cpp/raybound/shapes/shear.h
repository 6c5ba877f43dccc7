// A ray's own coordinates: its largest direction component becomes z, the others are sheared away (Woop, Benthin and
// Wald 2013). Edges shared by two polygons give the same numbers from both sides, so nothing passes between them.
#pragma once

#include "raybound/geometry/vector.h"

namespace raybound {

template <class T>
struct Shear {
    int kx, ky, kz;
    T sx, sy, dz;
    Mask<T> forward;  // dz > 0

    explicit Shear(const Vec3<T>& d) {
        const Vec3<T> a = absolute(d);
        const bool y_over_x = !(a.x > a.y), z_over_both = !((y_over_x ? a.y : a.x) > a.z);
        kz = z_over_both * 2 + !z_over_both * y_over_x;  // arithmetic, as a branch would often be mispredicted
        kx = (kz + 1) % 3;
        ky = (kz + 2) % 3;
        const Vec3<T> turned = permuted(d);
        dz = turned.z;
        sx = turned.x / dz;
        sy = turned.y / dz;
        forward = dz > T(0);
    }
    // The same in every lane of a pack.
    template <class S>
    explicit Shear(const Shear<S>& o)
        : kx(o.kx), ky(o.ky), kz(o.kz), sx(o.sx), sy(o.sy), dz(o.dz), forward(dz > T(0)) {}

    // A vector's components in the order (kx, ky, kz); the others take it so.
    Vec3<T> permuted(const Vec3<T>& p) const {
        const T component[3] = {p.x, p.y, p.z};
        return {component[kx], component[ky], component[kz]};
    }
    T x(const Vec3<T>& p) const { return p.x - sx * p.z; }
    T y(const Vec3<T>& p) const { return p.y - sy * p.z; }
};

// On which side of the line from a to b the sheared ray, at (0, 0), passes. The sign is that of the exact value, or it
// is zero (rounding is monotone; seeds/000, 3.9.3).
template <class T>
inline T edge_side(T ax, T ay, T bx, T by) {
    return ax * by - ay * bx;
}

}  // namespace raybound
