// Questions about rays, many at once and on many threads: what they hit, whether segments are blocked, how one shape
// answers. `watch` is called while they are computed and may throw to cancel them.
#pragma once

#include <span>

#include "raybound/frame/camera.h"
#include "raybound/frame/hit_record.h"
#include "raybound/frame/offsets.h"
#include "raybound/frame/work_queue.h"

namespace raybound {

// The closest hits. t is in units of each direction's length. Throws std::invalid_argument for a direction that is too
// short (user_rays.h).
std::vector<HitRecord> intersect_rays(const Snapshot& scene, const RayOrigins& origins,
                                      std::span<const Vec3f> directions, const Watch& watch);

// Every crossing along each ray, in order: those of ray i are records[offsets[i]] to records[offsets[i + 1]]. All lie
// on the ray as it is given. Each closed solid's alternate, and the number is even unless the ray begins in it.
struct AllHits {
    std::vector<HitRecord> records;
    std::vector<std::int64_t> offsets;
};
AllHits intersect_all(const Snapshot& scene, const RayOrigins& origins, std::span<const Vec3f> directions,
                      const Watch& watch);

// The ids of the closed solids around each point, in order: those of point i are ids[offsets[i]] to ids[offsets[i +
// 1]].
struct Containing {
    std::vector<std::int32_t> object_ids;
    std::vector<std::int64_t> offsets;
};
Containing containing(const Snapshot& scene, std::span<const Vec3f> points, const Watch& watch);

// Is there anything certainly between origin and target? Points are taken as they are, nothing is offset.
std::vector<std::uint8_t> occluded(const Snapshot& scene, const RayOrigins& origins, std::span<const Vec3f> targets,
                                   const Watch& watch);

// Which points lie in a closed shape. Throws std::invalid_argument if it is open.
std::vector<std::uint8_t> shape_contains(const Shape& shape, std::span<const Vec3d> points, const Watch& watch);

// The searches alone, without points, bounds and shading, on some threads (0: as many as may be used), and the seconds
// they took: to measure them. t, in units of each direction's length, is the one that searches compare.
struct ClosestHits {
    std::vector<float> t;
    std::vector<std::int32_t> object_id, face_id;
    double seconds;
};
ClosestHits closest_hits(const Snapshot& scene, std::span<const Vec3f> origins, std::span<const Vec3f> directions,
                         int threads, const Watch& watch);

// The same for the rays of a camera, of which it is only counted how many hit.
struct PrimaryHits {
    std::uint64_t hits;
    double seconds;
};
PrimaryHits primary_hits(const Snapshot& scene, const Camera& camera, int threads, const Watch& watch);

struct ShapeHitRecord {
    bool hit;
    double t, t_error;
    double point[3], point_error[3], normal[3], uv[2];
    std::int32_t face_id;
    double next_origin[3];  // of a ray that leaves along the normal, or against it
};

// One shape alone, with the kernels of type T. `inward`: next_origin is on the side against the normal.
template <class T>
std::vector<ShapeHitRecord> intersect_shape(const Shape& shape, std::span<const Vec3d> origins,
                                            std::span<const Vec3d> directions, Offsets offsets, bool inward,
                                            const Watch& watch);

}  // namespace raybound
