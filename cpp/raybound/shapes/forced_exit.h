// Ways out of solids that no crossing of a ray's line shows.
#pragma once

#include "raybound/shapes/intersect.h"

namespace raybound {

// A crossing that has to be ahead of the origin.
inline Crossing<double> ahead(Crossing<double> crossing) {
    if (!(crossing.t > 0 && crossing.t < infinity<double>)) crossing.t = 0;
    return crossing;
}

// Where a ray leaves a convex leaf, or a quadric, that it is inside of.
Crossing<double> exit_crossing(const Geometry& geometry, std::uint32_t leaf, std::int32_t face_offset,
                               const Ray<double>& ray);

// Where a ray leaves a closed primitive that it is inside of, up to `margin`, though its line may miss it.
Crossing<double> forced_exit(const Geometry& geometry, const Primitive& primitive, const Ray<double>& ray,
                             double margin);

}  // namespace raybound
