#include "raybound/frame/offsets.h"

#include <stdexcept>

#include "raybound/frame/stopwatch.h"
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
    const auto left = [&](bool outward) {
        return leaving.skips ? departure(geometry, nearest.primitive, outward) : Departure{};
    };
    if (leaving.offsets == Offsets::bounded) {
        const SurfacePoint<T> hit = surface_point<T>(geometry, nearest.crossing, ray.wide, {});
        const Vec3<T> side = hit.entering ? hit.normal : -hit.normal;
        return {offset_origin(hit.point, hit.point_error, side), side, left(hit.entering)};
    }
    const PlainPoint<T> hit = estimate_point<T>(geometry, nearest.crossing, ray.narrow);
    const bool outward = !(dot(ray.narrow.direction, hit.normal) > T(0));
    const Vec3<T> side = outward ? hit.normal : -hit.normal;
    return {epsilon_origin(hit.point, side, leaving.offsets), side, left(outward)};
}

template <class T>
void ask_lights(const Snapshot& scene, const Departing<T>& from, Bounces& counts) {
    for (const LightRecord& entry : scene.lights()) {
        const Light& light = *entry.light;
        const bool far = light.kind == LightKind::directional;
        const Vec3<T> toward = far ? -Vec3<T>(light.direction) : Vec3<T>(light.position) - from.origin;
        if (!(dot(from.side, toward) > T(0))) continue;
        const WideRay<T> ray =
            far ? WideRay<T>(from.origin, toward) : WideRay<T>::segment(from.origin, Vec3<T>(light.position));
        ++counts.rays;
        counts.blocked += is_blocked(scene, ray, from.departed, nullptr);
    }
}

template <class T>
void bounce(const Snapshot& scene, const WideRay<T>& ray, Departure departed, const Leaving& leaving, int depth,
            Bounces& counts) {
    ++counts.rays;
    const Nearest<T> nearest = closest_hit(scene, ray, departed);
    if (!nearest.hit) return;
    ++counts.hits;
    const Departing<T> from = depart(scene.geometry(), nearest, ray, leaving);
    ask_lights(scene, from, counts);
    if (depth > 1)
        bounce<T>(scene, {from.origin, reflected_direction(ray.narrow.direction, from.side)}, from.departed, leaving,
                  depth - 1, counts);
}

}  // namespace

template <class T>
Bounces trace_bounces(const Snapshot& scene, std::span<const Vec3d> origins, std::span<const Vec3d> directions,
                      const Leaving& leaving) {
    std::vector<WideRay<T>> rays;
    rays.reserve(origins.size());
    for (std::size_t i = 0; i < origins.size(); ++i) {
        Vec3<T> direction(directions[i]);
        if (!unit_direction(direction)) throw std::invalid_argument("trace_bounces: directions must not be zero");
        rays.emplace_back(Vec3<T>(origins[i]), direction);
    }
    Bounces counts;
    const Stopwatch stopwatch;
    for (const WideRay<T>& ray : rays) bounce(scene, ray, {}, leaving, 2, counts);
    counts.seconds = stopwatch.seconds();
    return counts;
}

template Bounces trace_bounces<float>(const Snapshot&, std::span<const Vec3d>, std::span<const Vec3d>, const Leaving&);
template Bounces trace_bounces<double>(const Snapshot&, std::span<const Vec3d>, std::span<const Vec3d>, const Leaving&);

}  // namespace raybound
