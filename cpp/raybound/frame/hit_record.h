// Hits as scripts have them, and the rays that begin at them.
#pragma once

#include <span>
#include <string>

#include "raybound/trace/search.h"

namespace raybound {

// One answer. What the errors bound is said at SurfacePoint. A miss has t infinite, ids -1 and zeros. `direction` is
// the ray's, with a largest component in [1, 2). At a solid it goes against the normal if the ray is entering, else
// along it. `within_id`: the closed solid that the ray was inside of on its way, or -1; `touching`: it leaves that
// solid where it enters this one.
struct HitRecord {
    bool hit;
    float t, t_error;
    float point[3], point_error[3], normal[3], uv[2];
    std::int32_t object_id, face_id;
    bool entering;
    std::int32_t within_id;
    bool touching;
    float direction[3];
    std::uint32_t seal;  // of all other fields: a record that a script has changed is refused
};

// A miss, with all bytes defined, padding too: equal answers are equal byte for byte.
HitRecord missed_record();

// t is in units of the length of a direction that is `scale` times as long as the ray's.
HitRecord hit_record(const Snapshot& scene, const Nearest<float>& nearest, const WideRay<float>& ray, float scale);

// Where a ray begins, and what it knows. One that begins at a miss begins nowhere.
struct RayStart {
    Vec3f origin;
    Departure from;
    bool begins = true;
};

// Where rays begin: at points of space, or at hits. The data must outlive it.
class RayOrigins {
  public:
    RayOrigins(const Snapshot& scene, std::span<const Vec3f> points) : scene_(scene), points_(points) {}

    // Throws std::invalid_argument, in the name of `who`, for records that are not hits of this scene.
    RayOrigins(const Snapshot& scene, std::span<const HitRecord> hits, const std::string& who);

    std::size_t size() const { return points_.size() + hits_.size(); }

    // The start of a ray toward a target or along a direction. Those from hits leave the surface on that side.
    RayStart toward(std::size_t index, const Vec3f& target) const;
    RayStart along(std::size_t index, const Vec3f& direction) const;

  private:
    RayStart leave(const HitRecord& hit, const Vec3d& direction) const;

    const Snapshot& scene_;
    std::span<const Vec3f> points_;
    std::span<const HitRecord> hits_;
};

}  // namespace raybound
