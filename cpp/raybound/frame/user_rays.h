// The directions of rays as users give them.
#pragma once

#include <span>
#include <stdexcept>
#include <string>

#include "raybound/geometry/vector.h"
#include "raybound/shapes/shape.h"

namespace raybound {

// Origins and shapes with coordinates within 2^60 are at most 2^61 apart in each of them: along a direction of this
// length or more t is less than 2^61 2^64 sqrt(3), which fits in a float (D3).
inline constexpr double least_direction_length = 0x1p-64;

// Throws std::invalid_argument in the name of `who` for the first direction that is shorter, in the type T of the rays.
template <class T, class S>
void require_directions(const std::string& who, std::span<const Vec3<S>> directions) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const Vec3<T> direction(directions[i]);
        if (length(Vec3d(direction)) >= least_direction_length) continue;
        throw std::invalid_argument(who + ": directions must have a length of at least 2**-64 (5.4e-20), got " +
                                    format(Vec3f(direction)) + " at index " + std::to_string(i));
    }
}

}  // namespace raybound
