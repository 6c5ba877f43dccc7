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

    void set(int lane, std::uint32_t of, const Crossing<double>& crossing, float rounded_t) {
        t.v[lane] = rounded_t;
        crossing_t.v[lane] = crossing.t;
        primitive[lane] = of;
        leaf[lane] = crossing.leaf;
        face[lane] = crossing.face;
        face_offset[lane] = crossing.face_offset;
        hit |= 1u << lane;
        entering = (entering & ~(1u << lane)) | std::uint32_t(crossing.entering) << lane;
    }
};

// Takes the primitive's crossings where they come first: its box, its kernel and the tie rule, for `lanes`.
// From `doubtful_from` on a lane's crossings are not taken, as they may be where the ray leaves the solid that it is
// within: returned is which lanes have such ones.
std::uint32_t consider(const Geometry& geometry, std::uint32_t primitive, const RayPack& rays, std::uint32_t lanes,
                       const FloatPack& doubtful_from, NearestPack& best);

// Takes a crossing of one lane in the same way, which enters the primitive's box at `entry`. True if it is doubtful.
bool consider_one(const Geometry& geometry, std::uint32_t primitive, int lane, const Crossing<double>& crossing,
                  float entry, float doubtful_from, NearestPack& best);

// Where rays leave a convex leaf that they are inside of, as crossing_from_inside.
struct LeavingPack {
    DoublePack t;
    PackIndex<double> face;
};
LeavingPack leave_convex(const Geometry& geometry, std::uint32_t leaf, const RayPack& rays);

// Which of `lanes` the primitive certainly blocks (its box is asked first). `exits`: those of them that it blocks by a
// crossing that is no entry.
struct BlockedLanes {
    std::uint32_t blocked = 0, exits = 0;
};
BlockedLanes blocked_lanes(const Geometry& geometry, std::uint32_t primitive, const RayPack& rays, std::uint32_t lanes);

// Which of `lanes` leave a convex leaf that they are inside of certainly before their targets.
std::uint32_t lanes_blocked_from_inside(const Geometry& geometry, std::uint32_t leaf, const RayPack& rays,
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
