// Cells as pictures and explanations show them.
#include "raybound/certify/entries.h"
#include "raybound/certify/face_cells.h"
#include "raybound/certify/roots.h"

namespace raybound {

namespace {

bool holds(const Patch& patch, const Vec3d& point) {
    const Mat3<double> to_patch = inverse(from_columns(patch.axis[0], patch.axis[1], patch.axis[2]));
    return max_component(absolute(to_patch * (point - patch.center))) <= 1;
}

}  // namespace

std::vector<Cells::View> Cells::views(const Snapshot& scene, std::int32_t object) const {
    std::vector<View> found;
    if (content_ != scene.content()) return found;
    visit_roots(scene, [&](const FaceKey& key, std::uint32_t root) {
        if (scene.objects()[scene.geometry().primitives[key.primitive].object].id != object) return;
        const auto chart = Chart::make(scene.geometry(), key.leaf, key.face, key.piece);
        add_views(key, *chart, chart->whole(), *arena_.at(root), 0, object, found);
    });
    return found;
}

void Cells::add_views(const FaceKey& key, const Chart& chart, const ChartRectangle& rectangle, std::uint32_t cell,
                      int depth, std::int32_t object, std::vector<View>& found) const {
    const std::uint32_t children = *arena_.at(cell);
    View view{object,    key.face_offset + key.face,         key.piece, depth, key.outward, children == Arena::none,
              rectangle, chart.patch(chart.cell(rectangle)), {}};
    for (const std::uint32_t slot : slot_of_light_) {
        const std::uint32_t entry = *arena_.at(cell + cell_words_without_lights + slot);
        const auto list = std::int32_t(entries::primitives(arena_, entry).size());
        const CellVerdict verdict = entries::verdict(entry);
        const bool unknown = verdict == CellVerdict::none || entries::is_too_long(entry);
        view.candidates.push_back(unknown ? -2 : verdict == CellVerdict::blocked ? -1 : list);
    }
    found.push_back(std::move(view));
    if (children == Arena::none) return;
    const Division ways = division(chart, rectangle);
    for (int i = 0; i < ways.ways(); ++i)
        add_views(key, chart, part(rectangle, ways, i), children + std::uint32_t(i) * cell_words(), depth + 1, object,
                  found);
}

std::optional<Cells::View> Cells::view_at(const Snapshot& scene, std::int32_t object, std::int32_t face,
                                          const Vec3d& point) const {
    std::optional<View> deepest;
    for (View& view : views(scene, object)) {
        if (view.face != face || !holds(view.patch, point)) continue;
        if (!deepest || view.depth > deepest->depth) deepest = std::move(view);
    }
    return deepest;
}

}  // namespace raybound
