// Eight rays side by side at one primitive: lane by lane the same bits as one ray at a time.
//
// Lanes are asked for as a set of bits, the first lane's lowest; the others' numbers mean nothing, but are finite (they
// repeat a lane that is asked for), so that no kernel has to know about them.
#pragma once

#include "raybound/numbers/pack.h"
#include "raybound/shapes/intersect.h"

namespace raybound {

using FloatPack = Pack<float>;
using DoublePack = Pack<double>;
using RayPack = WideRay<FloatPack>;

// The closest crossing of each lane so far: the lexicographic minimum of (t, object, face), as Nearest<float>.
struct NearestPack {
    FloatPack t{infinity<float>};  // rounded and clamped to the entry into the primitive's box
    DoublePack crossing_t;
    alignas(32) std::uint32_t primitive[pack_width];
    alignas(32) std::uint32_t leaf[pack_width];
    alignas(32) std::int32_t face[pack_width];
    alignas(32) std::int32_t face_offset[pack_width];
    std::uint32_t hit = 0, entering = 0;  // sets of lanes
};

// Takes the primitive's crossings where they come first: its box, its kernel and the tie rule, for `lanes`.
void consider(const Geometry& geometry, std::uint32_t primitive, const RayPack& rays, std::uint32_t lanes,
              NearestPack& best);

// Which of `lanes` the primitive certainly blocks (its box is asked first).
std::uint32_t blocked_lanes(const Geometry& geometry, std::uint32_t primitive, const RayPack& rays,
                            std::uint32_t lanes);

// The points of crossings of one face of one leaf; `entering` is a set of lanes. All lanes of `crossing_t` hold a
// crossing of that face.
struct FaceCrossings {
    std::uint32_t leaf;
    std::int32_t face;
    DoublePack t;
    std::uint32_t entering;
};
SurfacePoint<FloatPack> surface_points(const Geometry& geometry, const FaceCrossings& crossings,
                                       const Ray<DoublePack>& rays, Wanted wanted);

}  // namespace raybound
