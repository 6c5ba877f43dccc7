// How the origin of a spawned ray is moved off a surface: by the error bounds, or by an epsilon, to measure against.
#pragma once

#include <span>

#include "raybound/trace/search.h"

namespace raybound {

// By the bounds; by 1e-5; by 10 ulp of each coordinate (seeds/004).
enum class Offsets { bounded, epsilon, scaled_epsilon };

// p moved to the side of the unit vector `side` without knowledge of p's error.
template <class T>
inline Vec3<T> epsilon_origin(const Vec3<T>& p, const Vec3<T>& side, Offsets offsets) {
    if (offsets == Offsets::epsilon) return p + side * T(1e-5);
    const Vec3<T> step = absolute(p) * (T(2) * NumberTraits<T>::unit_roundoff * T(10));
    return p + side * step;
}

// One bounce of rays on this thread: the closest hits in a scene, the points there, the origins that a policy spawns
// from them, and the closest hits of the mirrored rays. The epsilon policies compute the plain point in T and no bound.
struct Bounces {
    std::uint64_t hits = 0, bounced_hits = 0;
    double seconds = 0;
};
template <class T>
Bounces trace_bounces(const Snapshot& scene, std::span<const Vec3d> origins, std::span<const Vec3d> directions,
                      Offsets offsets);

}  // namespace raybound
