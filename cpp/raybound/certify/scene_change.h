// What an edit changes for rays: which primitives have gone, come or moved, and what has stayed under which number.
#pragma once

#include <span>
#include <vector>

#include "raybound/scene/snapshot.h"

namespace raybound {

struct SceneChange {
    std::vector<std::uint32_t> new_index;  // of primitives by their index before; none: gone, or moved
    std::vector<Box> regions;              // of those that have changed, before; then of those that arrived
    std::vector<std::uint32_t> arrived;    // primitives, by their new index: added or moved
    bool renumbered = false;

    static constexpr std::uint32_t none = 0xffffffffu;

    // `before`: the objects and the bounds of their primitives.
    SceneChange(const std::vector<ObjectRecord>& before, const std::vector<Box>& bounds, const Snapshot& now);

    std::span<const Box> arrivals() const { return std::span(regions).last(arrived.size()); }
    bool is_empty() const { return regions.empty() && !renumbered; }
    std::size_t bytes() const {
        return (new_index.capacity() + arrived.capacity()) * sizeof(std::uint32_t) + regions.capacity() * sizeof(Box);
    }

    // May something that has changed be met, or have been? `may_meet` tells of a box.
    template <class MayMeet>
    static bool any_met([[maybe_unused]] std::span<const Box> boxes, [[maybe_unused]] const MayMeet& may_meet) {
#ifdef RAYBOUND_SABOTAGE_INVALIDATION
        return false;  // the sabotage build: what has changed is not asked about
#else
        for (const Box& box : boxes)
            if (may_meet(box)) return true;
        return false;
#endif
    }
};

// Lights are one to their shadows if they are in one place, or shine in one direction.
bool casts_same_shadows(const Light& a, const Light& b);

}  // namespace raybound
