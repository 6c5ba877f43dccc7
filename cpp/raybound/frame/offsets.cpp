#include "raybound/frame/offsets.h"

#include <ctime>

#include "raybound/frame/user_rays.h"
#include "raybound/trace/shading.h"

namespace raybound {

namespace {

// Where rays leave a hit, and the normal turned toward the viewer.
template <class T>
struct Departing {
    Vec3<T> origin, side;
    Departure departed;
};

template <class T>
Departing<T> depart(const Geometry& geometry, const Nearest<T>& nearest, const WideRay<T>& ray,
                    const Leaving& leaving) {
    const Departure left = leaving.skips ? departures(geometry, nearest).outer : Departure{};
    if (leaving.offsets == Offsets::bounded) {
        const SurfacePoint<T> hit = surface_point<T>(geometry, nearest.crossing, ray.wide, {});
        const Vec3<T> side = hit.entering ? hit.normal : -hit.normal;
        return {offset_origin(hit.point, hit.point_error, side), side, left};
    }
    const PlainPoint<T> hit = estimate_point<T>(geometry, nearest.crossing, ray.narrow);
    const bool outward = !(dot(ray.narrow.direction, hit.normal) > T(0));
    const Vec3<T> side = outward ? hit.normal : -hit.normal;
    return {epsilon_origin(hit.point, side, leaving.offsets), side, left};
}

template <class T, class Observer>
Vec3<T> light_of(const Snapshot& scene, const Material& material, const Departing<T>& from, const Vec3<T>& view,
                 Bounces& counts, Observer observer) {
    const Vec3<T> diffuse(material.diffuse);
    const T n_dot_v = dot(from.side, view);
    Vec3<T> sum = Vec3<T>(scene.ambient()) * diffuse;
    for (const LightRecord& entry : scene.lights()) {
        const Light& light = *entry.light;
        const Incoming<T> in = incoming(light, from.origin);
        const T n_dot_l = dot(from.side, in.direction);
        if (!(n_dot_l > T(0))) continue;
        const WideRay<T> ray = light.kind == LightKind::directional
                                   ? WideRay<T>(from.origin, in.direction)
                                   : WideRay<T>::segment(from.origin, Vec3<T>(light.position));
        const bool blocked = is_blocked(scene, ray, from.departed, nullptr, Acceleration::bvh, nullptr, observer);
        ++counts.rays, ++counts.spawned;
        counts.blocked += blocked;
        if (!blocked)
            sum = sum + in.irradiance * reflectance(diffuse, material, from.side, in.direction, view, n_dot_l, n_dot_v);
    }
    return sum;
}

// The light that a hit sends back (for a miss, the background), and what comes by the mirrored ray, once.
template <class T, class Observer>
Vec3<T> bounce(const Snapshot& scene, const WideRay<T>& ray, const Nearest<T>& nearest, const Leaving& leaving,
               bool is_last, Bounces& counts, Observer observer) {
    ++counts.rays;
    if (!nearest.hit) return Vec3<T>(scene.background());
    ++counts.hits;
    const Material& material = *scene.objects()[scene.geometry().primitives[nearest.primitive].object].material;
    const Vec3<T>& d = ray.narrow.direction;
    const Departing<T> from = depart(scene.geometry(), nearest, ray, leaving);
    const Vec3<T> local = light_of(scene, material, from, -d, counts, observer);
    if (is_last) return local;
    const WideRay<T> mirrored(from.origin, reflected_direction(d, from.side));
    ++counts.spawned;
    const Nearest<T> next = closest_hit(scene, mirrored, from.departed, Acceleration::bvh, nullptr, observer);
    return local + bounce(scene, mirrored, next, leaving, true, counts, observer);
}

template <class T, class Observer>
Vec3<T> sum_of_bounces(const Snapshot& scene, const std::vector<WideRay<T>>& rays, const Leaving& leaving,
                       Bounces& counts, Observer observer) {
    Vec3<T> radiance;
    for (const WideRay<T>& ray : rays)
        radiance = radiance + bounce(scene, ray, closest_hit(scene, ray), leaving, false, counts, observer);
    return radiance;
}

}  // namespace

template <class T>
Bounces trace_bounces(const Snapshot& scene, std::span<const Vec3d> origins, std::span<const Vec3d> directions,
                      const Leaving& leaving) {
    require_directions<T>("trace_bounces", directions);
    std::vector<WideRay<T>> rays;
    rays.reserve(origins.size());
    for (std::size_t i = 0; i < origins.size(); ++i) {
        Vec3<T> direction(directions[i]);
        make_unit(direction);
        rays.emplace_back(Vec3<T>(origins[i]), direction);
    }
    Bounces counts;
    const std::clock_t begin = std::clock();
    const Vec3<T> radiance = leaving.counts ? sum_of_bounces(scene, rays, leaving, counts, Counted{&counts.visits})
                                            : sum_of_bounces(scene, rays, leaving, counts, Unseen{});
    counts.seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
    counts.radiance = double(radiance.x + radiance.y + radiance.z);
    return counts;
}

template Bounces trace_bounces<float>(const Snapshot&, std::span<const Vec3d>, std::span<const Vec3d>, const Leaving&);
template Bounces trace_bounces<double>(const Snapshot&, std::span<const Vec3d>, std::span<const Vec3d>, const Leaving&);

}  // namespace raybound
