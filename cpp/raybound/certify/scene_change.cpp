#include "raybound/certify/scene_change.h"

namespace raybound {

SceneChange::SceneChange(const std::vector<ObjectRecord>& before, const std::vector<Box>& bounds, const Snapshot& now) {
    const auto& objects = now.objects();
    new_index.reserve(before.size());
    std::size_t i = 0, j = 0;
    while (i < before.size() || j < objects.size()) {
        const bool same = i < before.size() && j < objects.size() && before[i].id == objects[j].id;
        const bool gone = !same && (j == objects.size() || (i < before.size() && before[i].id < objects[j].id));
        if (same && objects[j].is_placed_as(before[i])) {
            new_index.push_back(std::uint32_t(j));
            if (i != j) renumbered = true;
            ++i, ++j;
            continue;
        }
        if (same || gone) {
            regions.push_back(bounds[i]);
            new_index.push_back(none);
            renumbered = renumbered || gone;
            ++i;
        }
        if (!gone) {
            arrived.push_back(std::uint32_t(j));
            ++j;
        }
    }
    for (const std::uint32_t primitive : arrived) regions.push_back(now.geometry().primitives[primitive].bounds);
}

bool casts_same_shadows(const Light& a, const Light& b) {
    if ((a.kind == LightKind::directional) != (b.kind == LightKind::directional)) return false;
    return a.kind == LightKind::directional ? a.direction == b.direction : a.position == b.position;
}

}  // namespace raybound
