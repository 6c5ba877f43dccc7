// The roots of cells' trees: one for each side of each piece of each face of a primitive, in a record of words.
#pragma once

#include "raybound/certify/cells.h"

namespace raybound {

inline constexpr std::uint32_t roots_of_face = 2 * Chart::pieces;

inline std::uint32_t root_number(const FaceKey& key) {
    const auto face = std::uint32_t(key.face_offset + key.face);
    return (face * Chart::pieces + std::uint32_t(key.piece)) * 2 + (key.outward ? 0 : 1);
}

// Of what face a root is, and what the rays of its cells have left, as the tracer sees it.
FaceKey key_of_root(const Geometry& geometry, std::uint32_t primitive, std::uint32_t root);

// Calls visit(key, word) for each root that has cells.
template <class Visit>
void Cells::visit_roots(const Snapshot& scene, const Visit& visit) const {
    for (std::uint32_t primitive = 0; primitive < roots_.size(); ++primitive) {
        if (roots_[primitive] == Arena::none) continue;
        const std::uint32_t count = root_count(scene, primitive);
        for (std::uint32_t i = 0; i < count; ++i)
            if (*arena_.at(roots_[primitive] + i) != Arena::none)
                visit(key_of_root(scene.geometry(), primitive, i), roots_[primitive] + i);
    }
}

}  // namespace raybound
