// Eight spheres or triangles side by side, as filters before the deciding type: a lane is dropped only if the ray
// certainly does not meet it.
#pragma once

#include "raybound/shapes/sphere.h"
#include "raybound/shapes/triangle.h"

namespace raybound {

struct alignas(32) SpherePack {
    float center[3][pack_width] = {}, radius[pack_width] = {};
    std::uint32_t id[pack_width] = {};
    std::uint32_t lanes = 0;  // a bit for each lane in use
};

struct alignas(64) TrianglePack {
    float corner[3][3][pack_width] = {};  // by corner and axis
    std::uint32_t lanes = 0;              // in use; within the five cache lines that a filter reads
    float error = 0;                      // how far each coordinate may be from the corner it was rounded from
    std::uint32_t id[pack_width] = {};
};

template <class T>
inline Vec3<Pack<T>> broadcast(const Vec3<T>& v) {
    return {Pack<T>(v.x), Pack<T>(v.y), Pack<T>(v.z)};
}

// What the filter needs of a ray.
template <class T>
struct TrianglePackRay {
    Shear<T> scalar_shear;
    Shear<Pack<T>> shear;
    Vec3<Pack<T>> origin;  // permuted
    T origin_error;

    TrianglePackRay(const Vec3<T>& o, const Vec3<T>& direction, T error)
        : scalar_shear(direction),
          shear(scalar_shear),
          origin(broadcast(scalar_shear.permuted(o))),
          origin_error(error) {}
};

// Packs hold floats. Where a transform gave the sphere a centre or radius that is not one, each is off by a rounding of
// float: in T = float the bands of the kernel cover that (D8), in double the filter asks about a sphere that holds it.
template <class T>
inline Pack<T> filter_radius(const Vec3<Pack<T>>& center, const Pack<T>& radius) {
    if constexpr (std::is_same_v<T, float>) return radius;
    return radius + (norm1(center) + radius) * Pack<T>(T(0x1.001p-24));
}

template <class T>
inline std::uint32_t may_cross(const SpherePack& pack, const Vec3<T>& origin, const Vec3<T>& direction) {
    using P = Pack<T>;
    const Vec3<P> center{P::load(pack.center[0]), P::load(pack.center[1]), P::load(pack.center[2])};
    const P radius = filter_radius(center, P::load(pack.radius)), reach(norm1(direction));
    return bits(!sphere_missed(center, radius, broadcast(origin), broadcast(direction), reach)) & pack.lanes;
}

template <class T>
inline Vec3<Pack<T>> load_corner(const TrianglePack& pack, int corner, const Shear<T>& shear) {
    const auto& c = pack.corner[corner];
    return {Pack<T>::load(c[shear.kx]), Pack<T>::load(c[shear.ky]), Pack<T>::load(c[shear.kz])};
}

// `t_max` is measured along the ray; hits that are certainly farther are of no interest.
template <class T>
[[gnu::always_inline]] inline std::uint32_t may_cross(const TrianglePack& pack, const TrianglePackRay<T>& ray,
                                                      T t_max) {
    using P = Pack<T>;
    const Shear<T>& s = ray.scalar_shear;
    const Corners<P> corners{load_corner(pack, 0, s), load_corner(pack, 1, s), load_corner(pack, 2, s)};
    const EdgeFunctions<P> edges = edge_functions(corners, ray.origin, P(ray.origin_error + T(pack.error)), ray.shear);
    const T reach = t_max * abs(s.dz) * (T(1) + gamma<T>(16));
    return bits(may_pierce(edges, ray.shear, P(reach))) & pack.lanes;
}

}  // namespace raybound
