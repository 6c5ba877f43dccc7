// Searches of the scene: the closest hit, and whether anything blocks a segment.
#pragma once

#include "raybound/scene/snapshot.h"

namespace raybound {

// The closest crossing: the lexicographic minimum of (t, object, face).
template <class T>
struct Nearest {
    Crossing<Wide<T>> crossing{};
    T t = infinity<T>;  // the crossing's, rounded
    std::uint32_t primitive = 0;
    bool hit = false;
};

// The primitive that a ray has left for good, and so is not asked about, if there is one.
struct Departure {
    static constexpr std::uint32_t none = 0xffffffffu;
    std::uint32_t primitive = none;
};
inline Departure departure(const Geometry& geometry, std::uint32_t primitive, bool outward) {
    return {is_left_for_good(geometry, geometry.primitives[primitive], outward) ? primitive : Departure::none};
}

// The ray to a light from where it leaves a surface: it ends at the light itself.
template <class T>
inline WideRay<T> ray_to_light(const Vec3<T>& origin, const Light& light) {
    if (light.kind == LightKind::directional) return WideRay<T>(origin, -Vec3<T>(light.direction));
    return WideRay<T>::segment(origin, Vec3<T>(light.position));
}

enum class Acceleration { bvh, brute_force };

// `from`: where the search may begin, for a ray of a bundle that it was found for. `observer` is told what the search
// visits (a primitive is an object, or eight triangles of a mesh).
template <class T, class Observer = Unseen>
Nearest<T> closest_hit(const Snapshot& scene, const WideRay<T>& ray, Departure departed = {},
                       Acceleration acceleration = Acceleration::bvh, const Bvh::Frontier* from = nullptr,
                       Observer observer = {});

// Something opaque lies certainly between the ray's origin and its end; `blocker` (may be null) is told which object.
// `last` (may be null) is a primitive to ask first, and is told which one has blocked: rays to one light from points
// side by side are mostly blocked by the same.
template <class T, class Observer = Unseen>
bool is_blocked(const Snapshot& scene, const WideRay<T>& ray, Departure departed, std::int32_t* blocker,
                Acceleration acceleration = Acceleration::bvh, std::uint32_t* last = nullptr, Observer observer = {});

}  // namespace raybound
