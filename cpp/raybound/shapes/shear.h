// A ray's own coordinates: its largest direction component becomes z, the others are sheared away (Woop, Benthin and
// Wald 2013). Edges shared by two polygons give the same numbers from both sides, so nothing passes between them.
#pragma once

#include "raybound/geometry/vector.h"

namespace raybound {

// Which component is z: one order of components for a ray, or for all lanes of a pack.
template <class T>
struct AxisOrder {
    int kx, ky, kz;

    explicit AxisOrder(int z) : kx((z + 1) % 3), ky((z + 2) % 3), kz(z) {}
    AxisOrder(Mask<T> y_over_x, Mask<T> z_over_both)  // arithmetic, as a branch would often be mispredicted
        : AxisOrder(z_over_both * 2 + !z_over_both * y_over_x) {}

    // A vector's components in the order (kx, ky, kz); the shear takes it so.
    Vec3<T> permuted(const Vec3<T>& p) const {
        const T component[3] = {p.x, p.y, p.z};
        return {component[kx], component[ky], component[kz]};
    }
};

// An order for each lane.
template <class T>
struct LaneOrder {
    Mask<T> y_is_z, z_is_z;

    LaneOrder(const Mask<T>& y_over_x, const Mask<T>& z_over_both)
        : y_is_z(y_over_x & !z_over_both), z_is_z(z_over_both) {}

    Vec3<T> permuted(const Vec3<T>& p) const {
        return {select(z_is_z, p.x, select(y_is_z, p.z, p.y)), select(z_is_z, p.y, select(y_is_z, p.x, p.z)),
                select(z_is_z, p.z, select(y_is_z, p.y, p.x))};
    }
};

template <class T, class Order = AxisOrder<T>>
struct Shear : Order {
    T sx, sy, dz;
    Mask<T> forward;  // dz > 0

    explicit Shear(const Vec3<T>& d) : Shear(d, absolute(d)) {}
    // The same in every lane of a pack.
    template <class S>
    explicit Shear(const Shear<S>& o) : Order(o.kz), sx(o.sx), sy(o.sy), dz(o.dz), forward(dz > T(0)) {}

    T x(const Vec3<T>& p) const { return p.x - sx * p.z; }
    T y(const Vec3<T>& p) const { return p.y - sy * p.z; }

  private:
    Shear(const Vec3<T>& d, const Vec3<T>& size) : Shear(d, size, !(size.x > size.y)) {}
    Shear(const Vec3<T>& d, const Vec3<T>& size, const Mask<T>& y_over_x)
        : Order(y_over_x, !(select(y_over_x, size.y, size.x) > size.z)) {
        const Vec3<T> turned = this->permuted(d);
        dz = turned.z;
        sx = turned.x / dz;
        sy = turned.y / dz;
        forward = dz > T(0);
    }
};

// On which side of the line from a to b the sheared ray, at (0, 0), passes. The sign is that of the exact value, or it
// is zero (rounding is monotone; seeds/000, 3.9.3).
template <class T>
inline T edge_side(T ax, T ay, T bx, T by) {
    return ax * by - ay * bx;
}

}  // namespace raybound
