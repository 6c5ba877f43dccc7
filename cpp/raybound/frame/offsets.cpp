#include "raybound/frame/offsets.h"

#include <stdexcept>

#include "raybound/frame/stopwatch.h"
#include "raybound/trace/shading.h"

namespace raybound {

namespace {

// The mirrored ray.
template <class T>
WideRay<T> bounced(const Geometry& geometry, const Nearest<T>& nearest, const WideRay<T>& ray, Offsets offsets) {
    const Vec3<T>& d = ray.narrow.direction;
    if (offsets == Offsets::bounded) {
        const SurfacePoint<T> hit = surface_point<T>(geometry, nearest.crossing, ray.wide, {});
        const Vec3<T> side = hit.entering ? hit.normal : -hit.normal;
        return {offset_origin(hit.point, hit.point_error, side), reflected_direction(d, side)};
    }
    const PlainPoint<T> hit = estimate_point<T>(geometry, nearest.crossing, ray.narrow);
    const Vec3<T> side = dot(d, hit.normal) > T(0) ? -hit.normal : hit.normal;
    return {epsilon_origin(hit.point, side, offsets), reflected_direction(d, side)};
}

}  // namespace

template <class T>
Bounces trace_bounces(const Snapshot& scene, std::span<const Vec3d> origins, std::span<const Vec3d> directions,
                      Offsets offsets) {
    std::vector<WideRay<T>> rays;
    rays.reserve(origins.size());
    for (std::size_t i = 0; i < origins.size(); ++i) {
        Vec3<T> direction(directions[i]);
        if (!unit_direction(direction)) throw std::invalid_argument("trace_bounces: directions must not be zero");
        rays.emplace_back(Vec3<T>(origins[i]), direction);
    }
    Bounces counts;
    const Stopwatch stopwatch;
    for (const WideRay<T>& ray : rays) {
        const Nearest<T> nearest = closest_hit(scene, ray);
        if (!nearest.hit) continue;
        ++counts.hits;
        counts.bounced_hits += closest_hit(scene, bounced(scene.geometry(), nearest, ray, offsets)).hit;
    }
    counts.seconds = stopwatch.seconds();
    return counts;
}

template Bounces trace_bounces<float>(const Snapshot&, std::span<const Vec3d>, std::span<const Vec3d>, Offsets);
template Bounces trace_bounces<double>(const Snapshot&, std::span<const Vec3d>, std::span<const Vec3d>, Offsets);

}  // namespace raybound
