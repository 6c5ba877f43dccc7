// The side of a solid as a state of the ray: which crossing comes next for a ray that is known to be inside of a solid,
// or outside of it, whatever the side of its rounded origin.
//
// The kernels decide by the origin. Where they agree with the state, their answer stands, bit for bit. Where they do
// not, the origin has been rounded across a boundary close by. Then all that the whole line has inside of the solid is
// looked at, and the ray goes on from where it must be. So along any chain of rays the crossings of a closed solid
// alternate: entry, exit, entry.
#pragma once

#include <vector>

#include "raybound/shapes/depth.h"
#include "raybound/shapes/intersect.h"

namespace raybound {

// What a ray that leaves a surface knows. An eye ray knows only what its origin lies in.
struct Departure {
    static constexpr std::uint32_t none = 0xffffffffu;

    std::uint32_t within = none;  // the closed primitive that it is inside of
    std::uint32_t left = none;    // the primitive on whose surface it begins, and on whose outside it is
    std::uint32_t leaf = none;    // the face that it begins on
    std::int32_t face = 0;
    bool for_good = false;  // what it has left it cannot meet again, and so is not asked about
    bool at_once = false;   // it has left where it came in, by rounding: it does not come in there again

    std::uint32_t gone() const { return for_good ? left : none; }
};

// The crossing by which a ray leaves a closed primitive that it is inside of: there always is one, with t >= 0.
template <class T, class Observer = Unseen>
Crossing<Wide<T>> crossing_from_inside(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray,
                                       const Departure& from, const Asking<T>& asking = {}, Observer observer = {});

// The first crossing of a closed primitive that a ray is not inside of. `left`: it begins on it. Of another it may have
// started well inside after all, where solids overlap: then that is the way out of it.
template <class T, class Observer = Unseen>
Crossing<Wide<T>> crossing_from_outside(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray,
                                        const Departure& from, bool left, const Asking<T>& asking = {},
                                        Observer observer = {});

// What a whole line has inside of a closed primitive, in order.
struct Stretch {
    Crossing<double> in, out;
};
std::vector<Stretch> stretches_of(const Geometry& geometry, const Primitive& primitive, const Ray<double>& ray);

// The faces of a mesh that a ray crosses ahead of its origin, in order.
std::vector<Crossing<double>> mesh_crossings_ahead(const Geometry& geometry, std::uint32_t leaf,
                                                   const Ray<double>& ray);

}  // namespace raybound
