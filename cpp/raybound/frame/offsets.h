// How the origin of a spawned ray is moved off a surface: by the error bounds, or by an epsilon, to measure against.
#pragma once

#include <span>

#include "raybound/trace/search.h"

namespace raybound {

// By the bounds; by 1e-5 along the normal; by the normal times Epsilon(p, 10) of each coordinate; by Epsilon(p, 10)
// itself, in the sense of the normal's component. (seeds/004, which moves each coordinate by all of it and asks for no
// normal. Times the normal the guarantee p + epsilon > p is lost: at 1e5 a coordinate stays where n is 0.03.)
enum class Offsets { bounded, epsilon, scaled_epsilon, whole_epsilon };

// The sign of each component: 1, -1, or 0 for zero.
template <class T>
inline Vec3<T> signs(const Vec3<T>& v) {
    const auto sign = [](T x) { return T((x > 0) - (x < 0)); };
    return {sign(v.x), sign(v.y), sign(v.z)};
}

// p moved to the side of the unit vector `side` without knowledge of p's error.
template <class T>
inline Vec3<T> epsilon_origin(const Vec3<T>& p, const Vec3<T>& side, Offsets offsets) {
    if (offsets == Offsets::epsilon) return p + side * T(1e-5);
    const Vec3<T> step{epsilon(p.x, T(10)), epsilon(p.y, T(10)), epsilon(p.z, T(10))};
    return p + (offsets == Offsets::whole_epsilon ? signs(side) : side) * step;
}

// What a policy costs, on this thread: the rays of a picture of mirrors without textures. Each ray's closest hit, the
// point there, the origin that the policy spawns, from it a shadow ray to each light that the surface faces, the light
// that comes from there, and, once, the mirrored ray. The epsilon policies compute the plain point in T and no bound.
// `skips`: rays do not ask what they have left for good, as in the tracer, which knows the side of its origins.
// `counts`: what the spawned rays visit is counted, which takes time.
struct Leaving {
    Offsets offsets = Offsets::bounded;
    bool skips = true;
    bool counts = false;
};
struct Bounces {
    std::uint64_t rays = 0, hits = 0, blocked = 0, spawned = 0;
    Visits visits;        // of spawned rays
    double radiance = 0;  // the sum over rays and channels
    double seconds = 0;   // of this process: what others do meanwhile does not count
};
template <class T>
Bounces trace_bounces(const Snapshot& scene, std::span<const Vec3d> origins, std::span<const Vec3d> directions,
                      const Leaving& leaving);

}  // namespace raybound
