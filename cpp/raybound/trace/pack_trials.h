// Trials of the kernels for rays side by side: the same questions asked of packs of eight and ray by ray, whose answers
// must have the same bits.
#pragma once

#include <span>
#include <vector>

#include "raybound/scene/snapshot.h"

namespace raybound {

struct PackHit {
    std::int32_t hit, entering, face;
    std::uint32_t primitive, leaf;
    float t, t_error;
    float point[3], point_error[3], normal[3], uv[2];
    float outer[3], inner[3];  // origins of rays that leave on either side
    float diffuse[3];
    double crossing_t;
};

// The closest hits of rays, whose number is a multiple of 8, among all primitives.
std::vector<PackHit> trial_hits(const Snapshot& scene, std::span<const Vec3f> origins,
                                std::span<const Vec3f> directions, bool packed);

// Which primitives block: a row for each segment (`directions` false: `ends` are targets), a byte for each primitive.
std::vector<std::uint8_t> trial_blocked(const Snapshot& scene, std::span<const Vec3f> origins,
                                        std::span<const Vec3f> ends, bool directions, bool packed);

// What each light would add at hits, seen along `directions`: a row for each hit, and the rays sent on.
struct PackLight {
    float direction[3], irradiance[3], factor[3];
    std::uint32_t faces, shines, weighs;
};
struct PackSecondary {
    float reflect[3], transmit[3], reflected[3], refracted[3];
    std::int32_t total;
};
struct PackLocalLight {
    std::vector<PackLight> lights;
    std::vector<PackSecondary> rays;
};
PackLocalLight trial_light(const Snapshot& scene, std::uint32_t object, std::span<const Vec3f> points,
                           std::span<const Vec3f> normals, std::span<const Vec3f> directions, bool packed);

}  // namespace raybound
