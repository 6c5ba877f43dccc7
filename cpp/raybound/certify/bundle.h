// Bundles of shadow rays: from every point of a patch to one light; and what all of them, or none of them, meet.
#pragma once

#include "raybound/geometry/shaft.h"
#include "raybound/numbers/verdict.h"
#include "raybound/scene/material.h"
#include "raybound/shapes/support.h"

namespace raybound {

class Bundle {
  public:
    // All segments from the patch to a point; all rays from it in one direction (of about unit length).
    static Bundle toward_point(const Patch& origins, const Vec3f& target) { return {origins, Vec3d(target), false}; }
    static Bundle along(const Patch& origins, const Vec3f& direction) { return {origins, Vec3d(direction), true}; }

    const Patch& origins() const { return origins_; }
    bool is_directional() const { return directional_; }
    const Vec3d& target() const { return target_; }  // or the direction
    Boxd bounds() const;                             // of the segments; of the origins alone if directional

    // Cheap tests: false only if no ray of the bundle crosses the box as the tracer sees it (derivation D40).
    bool may_meet(const Box& box) const { return swept_.meets(box) || overlaps(box); }
    template <class Planes>
    std::uint32_t may_meet(const Planes& plane, Pack<float>& near) const {
        return swept_.meets(plane, infinity<float>, near) | overlapped(plane);
    }

    double largest_distance() const { return most_; }  // from origins to the target

  private:
    Bundle(const Patch& origins, const Vec3d& target, bool directional);

    // Beside the light: the tracer asks about boxes up to 2^-10 of the way beyond it.
    bool overlaps(const Box& box) const;
    template <class Planes>
    std::uint32_t overlapped(const Planes& plane) const;

    Patch origins_;
    Vec3d target_;
    bool directional_;
    double most_ = 0;
    Box beside_light_;
    SweptBox swept_;
};

template <class Planes>
std::uint32_t Bundle::overlapped(const Planes& plane) const {
    if (directional_) return 0;
    using P = Pack<float>;
    auto inside = (P(beside_light_.lower.x) <= plane(3)) & (plane(0) <= P(beside_light_.upper.x));
    inside = inside & (P(beside_light_.lower.y) <= plane(4)) & (plane(1) <= P(beside_light_.upper.y));
    inside = inside & (P(beside_light_.lower.z) <= plane(5)) & (plane(2) <= P(beside_light_.upper.z));
    return bits(inside);
}

// The rays to a light.
Bundle light_bundle(const Patch& origins, const Light& light);

// Rays from anywhere in a box in any direction of a box: what a batch of rays passes through.
class RayBundle {
  public:
    RayBundle(const Boxd& origins, const Boxd& directions)
        : origins_(origins),
          directions_(directions),
          swept_(origins, directions.lower, directions.upper, infinity<double>) {}

    const Boxd& origins() const { return origins_; }
    const Boxd& directions() const { return directions_; }

    // False only if no ray crosses the box before `until`, as the tracer sees it; `near` is no later than any crossing
    // but for SweptBox's widening.
    bool may_meet(const Box& box, float until, float& near) const { return swept_.meets(box, until, near); }
    template <class Planes>
    std::uint32_t may_meet(const Planes& plane, float until, Pack<float>& near) const {
        return swept_.meets(plane, until, near);
    }

  private:
    Boxd origins_, directions_;
    SweptBox swept_;
};

// Does any ray hit the primitive? (no, or unknown: whether all do is found by tracing them.)
Verdict hits(const RayBundle& bundle, const Geometry& geometry, const Primitive& primitive);

// Does the primitive block the rays: none of them, all of them, or may it block some? Never a wrong no or yes about
// what the float tracer decides for any float origin in the patch (derivations D41, D42). For yes, the distances from
// the origins at which it does.
struct BundleHits {
    Verdict verdict = Verdict::unknown;
    double nearest = 0, farthest = infinity<double>;
};
BundleHits hits(const Bundle& bundle, const Geometry& geometry, const Primitive& primitive);

}  // namespace raybound
