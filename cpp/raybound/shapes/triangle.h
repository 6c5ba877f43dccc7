// The triangle as meshes have it: edge functions in a ray's own sheared coordinates (Woop, Benthin and Wald 2013;
// seeds/000, 3.9.3), with bounds of their errors. In packs of T they are a filter; double decides (derivation D8).
#pragma once

#include "raybound/numbers/pack.h"
#include "raybound/shapes/shear.h"

namespace raybound {

template <class T>
struct Corners {
    Vec3<T> a, b, c;
};

// The edge functions of the three edges, each named by the corner opposite (their signs tell on which side of the
// edge the ray passes), and how far the corners are along the axis kz. `band` bounds the error of the edge functions,
// `z_band` that of the z.
template <class T>
struct EdgeFunctions {
    T a, b, c, band;
    T za, zb, zc, z_band;

    T largest() const { return maximum(maximum(a, b), c); }
    T least() const { return minimum(minimum(a, b), c); }
    T farthest() const { return maximum(maximum(za, zb), zc); }
    T nearest() const { return minimum(minimum(za, zb), zc); }
    // The line certainly passes beside the triangle.
    Mask<T> outside() const { return (least() < -band) & (largest() > band); }
};

template <class T>
struct ShearedPoint {
    T x, y, z;
};

template <class T>
inline T largest_of(const ShearedPoint<T>& a, const ShearedPoint<T>& b, const ShearedPoint<T>& c) {
    const T x = maximum(maximum(abs(a.x), abs(b.x)), abs(c.x)), y = maximum(maximum(abs(a.y), abs(b.y)), abs(c.y));
    return maximum(x, y);
}

// Corners and origin come permuted (Shear). `origin_error` bounds how far each component of the origin, or of a corner,
// is off. The direction may have been rounded once in each component. With m the largest component of a corner seen
// from the origin, its difference is off by e + m u, the shear's factor (at most 1) by 3u, the product by u, and the
// last difference (at most 2m) by u: a sheared coordinate by less than 2e + 9 m u.
template <class T>
inline EdgeFunctions<T> edge_functions(const Corners<T>& corners, const Vec3<T>& origin, T origin_error,
                                       const Shear<T>& shear) {
    const Vec3<T> pa = corners.a - origin, pb = corners.b - origin, pc = corners.c - origin;
    const ShearedPoint<T> a{shear.x(pa), shear.y(pa), pa.z}, b{shear.x(pb), shear.y(pb), pb.z},
        c{shear.x(pc), shear.y(pc), pc.z};
    const T reach =
        maximum(max_component(absolute(pa)), maximum(max_component(absolute(pb)), max_component(absolute(pc))));
    const T off = gamma<T>(16) * reach + T(2.125f) * origin_error, size = largest_of(a, b, c);
    EdgeFunctions<T> edges;
    edges.a = edge_side(c.x, c.y, b.x, b.y);
    edges.b = edge_side(a.x, a.y, c.x, c.y);
    edges.c = edge_side(b.x, b.y, a.x, a.y);
    edges.band =
        (T(4) * off + gamma<T>(6) * size) * size + (T(2) * off * off + T(std::numeric_limits<Scalar<T>>::min()));
    edges.za = a.z;
    edges.zb = b.z;
    edges.zc = c.z;
    edges.z_band = gamma<T>(3) * reach + T(1.0625f) * origin_error;
    return edges;
}

// The filter: does the line pass the triangle, in exact terms, perhaps? And is the hit perhaps neither behind nor
// beyond `reach` (measured along kz)?
template <class T>
inline Mask<T> may_pierce(const EdgeFunctions<T>& e, const Shear<T>& shear, T reach) {
    const Mask<T> forward = shear.forward;
    const T nearest = select(forward, e.nearest(), -e.farthest()),
            farthest = select(forward, e.farthest(), -e.nearest());
    return !(e.outside() | (farthest < -e.z_band) | (nearest > reach + e.z_band));
}

}  // namespace raybound
