#include "raybound/trace/cell_shading.h"

#include "raybound/numbers/taylor_powers.h"
#include "raybound/shapes/sphere.h"

namespace raybound {

namespace {

template <class W>
struct Met {
    Vec3<W> point, normal;
};

// The nearer crossing of a sphere, from outside: c over the stable numerator.
template <class W>
Met<W> meet_sphere(const CellSurface& sphere, const Vec3<W>& origin, const Vec3<W>& direction) {
    const Vec3<W> f = origin - Vec3<W>(sphere.center);
    const SphereTerms<W> terms = sphere_terms(f, direction, W(sphere.radius));
    const W discriminant = terms.r2 * terms.a - dot(terms.moment, terms.moment);
    const W t = (dot(f, f) - terms.r2) / stable_numerator(terms.b, discriminant);
    const Vec3<W> way = direction * t;
    return {origin + way, (f + way) * W(1.0 / double(sphere.radius))};
}

template <class W>
Met<W> meet_plane(const CellSurface& plane, const Vec3<W>& origin, const Vec3<W>& direction) {
    const Vec3<W> normal(plane.normal);
    const W t = dot(Vec3<W>(plane.center) - origin, normal) / dot(direction, normal);
    return {origin + direction * t, normal};
}

}  // namespace

template <class T, int N>
BundleRay<T> family_ray(const RayFamily<N>& family, const std::array<Wide<T>, std::size_t(N)>& x) {
    using W = Wide<T>;
    Vec3<W> origin, direction;
    std::array<double, std::size_t(N)> slopes;
    const auto component = [&](const Vec3d& middle, const std::array<Vec3d, std::size_t(N)>& all, int axis) {
        for (std::size_t i = 0; i < N; ++i) slopes[i] = all[i][axis];
        return affine(middle[axis], slopes, x);
    };
    for (int axis = 0; axis < 3; ++axis) {
        origin[axis] = component(family.origin, family.origin_slopes, axis);
        direction[axis] = component(family.direction, family.direction_slopes, axis);
    }
    return {Vec3<T>(origin), Vec3<T>(normalize(direction))};
}

template <class T>
Vec3<T> cell_radiance(const CellScene& scene, const BundleRay<T>& ray) {
    using W = Wide<T>;
    Vec3<T> origin = ray.origin, direction = ray.direction;
    for (const CellSurface& surface : scene.surfaces) {
        const Met<W> met = surface.kind == SurfaceKind::sphere
                               ? meet_sphere(surface, Vec3<W>(origin), Vec3<W>(direction))
                               : meet_plane(surface, Vec3<W>(origin), Vec3<W>(direction));
        const Vec3<T> point(met.point), normal(met.normal);
        if (surface.is_mirror) {
            origin = point;
            direction = reflected_direction(direction, normal);
            continue;
        }
        const Vec3<T> view = -direction, diffuse(surface.material.diffuse);
        const Incoming<T> from = incoming(scene.light, point);
        const T n_dot_l = dot(normal, from.direction), n_dot_v = dot(normal, view);
        const Vec3<T> factor =
            saturate(reflectance(diffuse, surface.material, normal, from.direction, view, n_dot_l, n_dot_v));
        return saturate(saturate(Vec3<T>(scene.ambient) * diffuse) + from.irradiance * factor);
    }
    return {};
}

// The number types that bound cells, and those that they bound.
template BundleRay<float> family_ray(const RayFamily<2>&, const std::array<Wide<float>, 2>&);
template BundleRay<float> family_ray(const RayFamily<4>&, const std::array<Wide<float>, 4>&);
template Vec3<float> cell_radiance(const CellScene&, const BundleRay<float>&);
template BundleRay<double> family_ray(const RayFamily<2>&, const std::array<Wide<double>, 2>&);
template BundleRay<double> family_ray(const RayFamily<4>&, const std::array<Wide<double>, 4>&);
template Vec3<double> cell_radiance(const CellScene&, const BundleRay<double>&);
using Real2 = TaylorModel<2, Arithmetic::real>;
using Executed2 = TaylorModel<2, Arithmetic::float32>;
template BundleRay<Real2> family_ray(const RayFamily<2>&, const std::array<Wide<Real2>, 2>&);
template Vec3<Real2> cell_radiance(const CellScene&, const BundleRay<Real2>&);
template BundleRay<Executed2> family_ray(const RayFamily<2>&, const std::array<Wide<Executed2>, 2>&);
template Vec3<Executed2> cell_radiance(const CellScene&, const BundleRay<Executed2>&);
using Real4 = TaylorModel<4, Arithmetic::real>;
using Executed4 = TaylorModel<4, Arithmetic::float32>;
template BundleRay<Real4> family_ray(const RayFamily<4>&, const std::array<Wide<Real4>, 4>&);
template Vec3<Real4> cell_radiance(const CellScene&, const BundleRay<Real4>&);
template BundleRay<Executed4> family_ray(const RayFamily<4>&, const std::array<Wide<Executed4>, 4>&);
template Vec3<Executed4> cell_radiance(const CellScene&, const BundleRay<Executed4>&);

}  // namespace raybound
