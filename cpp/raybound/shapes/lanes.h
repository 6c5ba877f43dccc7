// Single lanes of rays and hit points side by side: taken out, and put back.
#pragma once

#include "raybound/geometry/lanes.h"
#include "raybound/shapes/intersect.h"

namespace raybound {

template <class T>
inline Ray<T> lane_of(const Ray<Pack<T>>& rays, int lane) {
    return {lane_of(rays.origin, lane), lane_of(rays.direction, lane), rays.t_max[lane], lane_of(rays.target, lane),
            rays.has_target};
}

template <class T>
inline void set_lane(SurfacePoint<Pack<T>>& hits, int lane, const SurfacePoint<T>& hit) {
    set_lane(hits.t, lane, hit.t);
    set_lane(hits.t_error, lane, hit.t_error);
    set_lane(hits.point, lane, hit.point);
    set_lane(hits.point_error, lane, hit.point_error);
    set_lane(hits.normal, lane, hit.normal);
    set_lane(hits.shading, lane, hit.shading);
    set_lane(hits.uv.u, lane, hit.uv.u);
    set_lane(hits.uv.v, lane, hit.uv.v);
    set_lane(hits.entering, lane, hit.entering);
}

}  // namespace raybound
