// The closed forms of the seeds for the hits of one shape, many rays at once: what our bounds are measured beside.
#pragma once

#include <span>
#include <vector>

#include "raybound/shapes/shape.h"

namespace raybound {

// Not `known` for a miss, and for shapes without a closed form: those made of others, and all but spheres, cylinders,
// disks and meshes.
struct ClosedFormRecord {
    bool known;
    double point[3], point_error[3];
};

// Throws std::invalid_argument for a zero direction.
template <class T>
std::vector<ClosedFormRecord> closed_forms(const Shape& shape, std::span<const Vec3d> origins,
                                           std::span<const Vec3d> directions);

}  // namespace raybound
