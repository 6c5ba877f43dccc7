// Searches of the scene: the closest hit, and whether anything blocks a segment.
#pragma once

#include <functional>

#include "raybound/scene/snapshot.h"
#include "raybound/shapes/inside.h"

namespace raybound {

// The closest crossing: the lexicographic minimum of (t, object, face). Where a ray leaves the solid that it is within
// and enters another at the same t, that is the entry, and the two are `touching`.
template <class T>
struct Nearest {
    Crossing<Wide<T>> crossing{};
    T t = infinity<T>;  // the crossing's, rounded
    std::uint32_t primitive = 0;
    std::uint32_t within = Departure::none;  // the closed primitive that the ray is inside of on its way
    bool hit = false;
    bool touching = false;
};

// What rays know that leave a hit on the viewer's side, and on the other.
struct Departures {
    Departure outer, inner;
};
template <class T>
Departures departures(const Geometry& geometry, const Nearest<T>& nearest);

// What a ray knows that begins anywhere in space: the closed solid around its origin, if it is in one, and only one.
Departure departure_at(const Snapshot& scene, const Vec3f& origin);

// Calls visit(primitive) for the closed primitives that hold a point, in any order.
void visit_containing(const Snapshot& scene, const Vec3f& point, const std::function<void(std::uint32_t)>& visit);

// The index of refraction of what surrounds a hit: of the solid that the ray leaves where it enters this one, else 1.
template <class T>
T outside_ior(const Snapshot& scene, const Nearest<T>& nearest);

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
Nearest<T> closest_hit(const Snapshot& scene, const WideRay<T>& ray, const Departure& departed = {},
                       Acceleration acceleration = Acceleration::bvh, const Bvh::Frontier* from = nullptr,
                       Observer observer = {});

// Does one primitive block the ray, as a search for blockers would find?
bool is_blocked_by(const Snapshot& scene, const WideRay<float>& ray, const Departure& departed,
                   std::uint32_t primitive);
// Does the solid that the ray is within?
bool is_blocked_from_inside(const Snapshot& scene, const WideRay<float>& ray, const Departure& departed);

// Something opaque lies certainly between the ray's origin and its end; `blocker` (may be null) is told which object.
// `last` (may be null) is a primitive to ask first, and is told which one has blocked: rays to one light from points
// side by side are mostly blocked by the same.
template <class T, class Observer = Unseen>
bool is_blocked(const Snapshot& scene, const WideRay<T>& ray, const Departure& departed, std::int32_t* blocker,
                Acceleration acceleration = Acceleration::bvh, std::uint32_t* last = nullptr, Observer observer = {});

}  // namespace raybound
