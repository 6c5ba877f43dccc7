// How cells follow their scene: what stays, what is asked again, what is dropped.
#include <algorithm>
#include <functional>

#include "raybound/certify/entries.h"
#include "raybound/certify/face_cells.h"
#include "raybound/certify/roots.h"

namespace raybound {

void Cells::follow_lights(const Snapshot& scene) {
    const auto& lights = scene.lights();
    if (slots_.empty()) slots_.assign(lights.size() + 1, {});  // one to spare
    std::vector<bool> stale(slots_.size(), false);
    for (std::size_t s = 0; s < slots_.size(); ++s) {
        const auto at = std::ranges::find(lights, slots_[s].id, &LightRecord::id);
        if (slots_[s].id >= 0 && (at == lights.end() || !casts_same_shadows(*at->light, *slots_[s].light))) {
            stale[s] = true;
            if (at == lights.end()) slots_[s] = {};
        }
    }
    slot_of_light_.clear();
    for (const LightRecord& light : lights) {
        auto slot = std::ranges::find(slots_, light.id, &Slot::id);
        if (slot == slots_.end()) slot = std::ranges::find(slots_, -1, &Slot::id);
        *slot = {light.id, light.light};
        slot_of_light_.push_back(std::uint32_t(slot - slots_.begin()));
    }
    if (std::ranges::none_of(stale, std::identity{})) return;
    for (std::size_t i = 0; i < roots_.size(); ++i) {
        if (roots_[i] == Arena::none) continue;
        const std::uint32_t count = std::uint32_t(content_->objects[i].shape->face_count()) * roots_of_face;
        for (std::uint32_t k = 0; k < count; ++k)
            if (const std::uint32_t root = *arena_.at(roots_[i] + k); root != Arena::none) forget(root, stale);
    }
}

void Cells::forget(std::uint32_t first, const std::vector<bool>& stale) {
    const std::uint32_t ways = *arena_.at(first + 1) >> ways_shift;
    for (std::uint32_t i = 0; i < ways; ++i) {
        const std::uint32_t cell = first + i * cell_words();
        for (std::uint32_t s = 0; s < stale.size(); ++s)
            if (stale[s]) release_entry(cell + cell_words_without_lights + s);
        if (const std::uint32_t children = *arena_.at(cell); children != Arena::none) forget(children, stale);
    }
}

// Lights first, while the lists are still those of the primitives of before: what has become of a light's verdicts must
// be known before objects are looked at. False if too much has changed.
bool Cells::follow(const Snapshot& scene) {
    const bool grown = scene.objects().size() > most_primitives_ || scene.lights().size() > slots_.size();
    if (grown || arena_.limit() == 0) return false;
    follow_lights(scene);
    return follow_objects(scene);
}

// False if too much has changed: then it is cheaper to begin anew.
bool Cells::follow_objects(const Snapshot& scene) {
    const auto &before = content_->objects, &now = scene.objects();
    SceneChange change(before, bounds_, scene);
    if (change.is_empty()) return true;
    constexpr std::size_t most = 64;
    if (change.regions.size() > most) return false;

    // Trees of objects that are gone or have moved are of no use.
    std::vector<std::uint32_t> roots;
    roots.reserve(most_primitives_);
    roots.assign(now.size(), Arena::none);
    for (std::size_t k = 0; k < before.size(); ++k) {
        if (roots_[k] == Arena::none) continue;
        if (change.new_index[k] != SceneChange::none)
            roots[change.new_index[k]] = roots_[k];
        else
            release_tree(roots_[k], std::uint32_t(before[k].shape->face_count()) * roots_of_face);
    }
    roots_ = std::move(roots);
    visit_roots(scene, [&](const FaceKey& key, std::uint32_t root) {
        const auto chart = Chart::make(scene.geometry(), key.leaf, key.face, key.piece);
        const std::vector<bool> all(scene.lights().size(), true);
        update_cell(scene, *chart, chart->whole(), *arena_.at(root), change, all);
    });
    blocks_.follow(std::move(change));
    return true;
}

void Cells::update_cell(const Snapshot& scene, const Chart& chart, const ChartRectangle& rectangle, std::uint32_t cell,
                        const SceneChange& change, std::vector<bool> touched) {
    const ChartCell here = chart.cell(rectangle);
    const Patch patch = chart.patch(here);
    bool any = change.renumbered;
    for (std::size_t light = 0; light < touched.size(); ++light) {
        if (!touched[light] && !change.renumbered) continue;
        const Bundle bundle = light_bundle(patch, *scene.lights()[light].light);
        touched[light] = touched[light] &&
                         SceneChange::any_met(change.regions, [&](const Box& box) { return bundle.may_meet(box); });
        any = any || touched[light];
        const std::uint32_t word = cell + cell_words_without_lights + slot_of_light_[light];
        if (touched[light] || change.renumbered) update_entry(scene, bundle, word, change, touched[light]);
    }
    const std::uint32_t first = *arena_.at(cell);
    if (first == Arena::none) return;
    const Division ways = division(chart, rectangle);
    const std::vector<bool> all(touched.size(), true);
    for (int i = 0; i < ways.ways(); ++i) {
        const ChartRectangle child = part(rectangle, ways, i);
        const bool within = is_within(chart.cell(child), here);  // else it may be touched by more, as may its children
        if (any || !chart.is_flat())
            update_cell(scene, chart, child, first + std::uint32_t(i) * cell_words(), change, within ? touched : all);
    }
}

// A verdict after an edit: what was not touched stays, what has left is taken out, what has arrived is asked.
void Cells::update_entry(const Snapshot& scene, const Bundle& bundle, std::uint32_t word, const SceneChange& change,
                         bool touched) {
    const std::uint32_t entry = *arena_.at(word);
    if (entry == 0 || entries::is_too_long(entry)) return;
    CellVerdict verdict = entries::verdict(entry);
    std::vector<std::uint32_t> list;
    for (const std::uint32_t primitive : entries::primitives(arena_, entry))
        if (const std::uint32_t now = change.new_index[primitive]; now != SceneChange::none) list.push_back(now);
    if (verdict == CellVerdict::blocked && list.empty()) return release_entry(word);
    for (const std::uint32_t primitive : change.arrived) {
        if (!touched || verdict == CellVerdict::blocked) break;
        const Verdict answer = hits(bundle, scene.geometry(), scene.geometry().primitives[primitive]).verdict;
        if (answer == Verdict::no) continue;
        if (answer == Verdict::yes) {
            verdict = CellVerdict::blocked;
            list.clear();
        }
        list.push_back(primitive);
    }
    if (verdict != CellVerdict::blocked) verdict = list.empty() ? CellVerdict::lit : CellVerdict::list;
    release_entry(word);
    *arena_.at(word) = entries::store(arena_, verdict, list);
}

}  // namespace raybound
