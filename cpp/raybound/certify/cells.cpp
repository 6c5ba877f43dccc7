#include "raybound/certify/cells.h"

#include <algorithm>

#include "raybound/certify/entries.h"
#include "raybound/certify/roots.h"

namespace raybound {

std::uint32_t Cells::make_cells(std::uint32_t word, int ways) {
    const auto link = arena_.word(word);
    std::uint32_t cells = link.load(std::memory_order_acquire);
    if (cells != Arena::none) return cells;
    const std::uint32_t words = std::uint32_t(ways) * cell_words();
    const std::uint32_t made = arena_.allocate(words);
    if (made == Arena::none) return Arena::none;
    for (int i = 0; i < ways; ++i)
        *arena_.at(made + std::uint32_t(i) * cell_words() + 1) = std::uint32_t(ways) << ways_shift;
    if (!link.compare_exchange_strong(cells, made, std::memory_order_acq_rel)) {
        arena_.release(made, words);
        return cells;
    }
    cells_.fetch_add(std::size_t(ways), std::memory_order_relaxed);
    return made;
}

std::uint32_t Cells::root_count(const Snapshot& scene, std::uint32_t primitive) const {
    const ObjectRecord& object = scene.objects()[scene.geometry().primitives[primitive].object];
    return std::uint32_t(object.shape->face_count()) * roots_of_face;
}

std::uint32_t Cells::roots_of(const Snapshot& scene, std::uint32_t primitive) {
    if (arena_.limit() == 0) return Arena::none;
    std::atomic_ref link(roots_[primitive]);
    std::uint32_t roots = link.load(std::memory_order_acquire);
    if (roots != Arena::none) return roots;
    const std::uint32_t count = root_count(scene, primitive), made = arena_.allocate(count);
    if (made == Arena::none) return Arena::none;
    if (!link.compare_exchange_strong(roots, made, std::memory_order_acq_rel)) {
        arena_.release(made, count);
        return roots;
    }
    return made;
}

void Cells::clear() {
    arena_.reset(0);
    blocks_.reset(0);
    roots_ = std::vector<std::uint32_t>();
    bounds_ = std::vector<Box>();
    tables_ = 0;
    slots_.clear();
    slot_of_light_.clear();
    content_ = nullptr;
    cells_ = 0;
}

// (Anybody may ask at any time.)
std::size_t Cells::bytes() const { return arena_.bytes() + tables_.load(std::memory_order_relaxed) + blocks_.bytes(); }

// Tables of primitives count as memory, too: what is too little for them is enough for no cells.
void Cells::begin_anew(const Snapshot& scene) {
    clear();
    const std::size_t primitives = scene.geometry().primitives.size();
    most_primitives_ = primitives + primitives / 4 + 64;  // with room for objects that are added
    const std::size_t tables = most_primitives_ * (sizeof(std::uint32_t) + sizeof(Box));
    if (tables > memory_) return;
    tables_ = tables;
    const std::size_t rest = memory_ - tables, blocks = keeps_blocks_ ? rest / 2 : 0;
    arena_.reset(rest - blocks);
    blocks_.reset(blocks);
    bounds_.reserve(most_primitives_);
    roots_.reserve(most_primitives_);
    roots_.assign(primitives, Arena::none);
    follow_lights(scene);
}

void Cells::begin_frame(const Snapshot& scene) {
    if (content_ != scene.content()) {
        if (!content_ || !follow(scene)) begin_anew(scene);
        content_ = scene.content();
        blocks_.follow_lights(scene.lights());
        if (arena_.limit() > 0) {
            bounds_.clear();
            for (const Primitive& primitive : scene.geometry().primitives) bounds_.push_back(primitive.bounds);
        }
    }
    make_room(scene);
}

void Cells::release_entry(std::uint32_t word) {
    std::uint32_t& entry = *arena_.at(word);
    entries::release(arena_, entry);
    entry = 0;
}

void Cells::release_cells(std::uint32_t first) {
    const std::uint32_t ways = *arena_.at(first + 1) >> ways_shift;
    for (std::uint32_t i = 0; i < ways; ++i) {
        const std::uint32_t cell = first + i * cell_words();
        if (const std::uint32_t children = *arena_.at(cell); children != Arena::none) release_cells(children);
        for (std::uint32_t s = 0; s < slots_.size(); ++s) release_entry(cell + cell_words_without_lights + s);
    }
    arena_.release(first, ways * cell_words());
    cells_ -= ways;
}

void Cells::release_tree(std::uint32_t roots, std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i)
        if (const std::uint32_t root = *arena_.at(roots + i); root != Arena::none) release_cells(root);
    arena_.release(roots, count);
}

// The clock's second chance: what was not used since the hand came by is freed. True if the cells at `word` were.
bool Cells::sweep(std::uint32_t word) {
    const std::uint32_t first = *arena_.at(word);
    if (first == Arena::none) return true;
    const std::uint32_t ways = *arena_.at(first + 1) >> ways_shift;
    bool idle = true;
    for (std::uint32_t i = 0; i < ways; ++i) {
        const std::uint32_t cell = first + i * cell_words();
        const bool children_gone = sweep(cell);
        std::uint32_t& used = *arena_.at(cell + 1);
        idle = idle && children_gone && (used & 1) == 0;
        used &= ~1u;
    }
    if (!idle) return false;
    release_cells(first);
    *arena_.at(word) = Arena::none;
    return true;
}

// Once most of the memory is taken, each frame begins with a turn of the clock; a second one if that was not enough.
void Cells::make_room(const Snapshot& scene) {
    const std::size_t most = arena_.limit() - arena_.limit() / 4;
    for (int turn = 0; turn < 2 && (arena_.used() > most || arena_.has_refused()); ++turn) {
        if (turn == 1 && arena_.used() <= most) break;
        for (std::uint32_t primitive = 0; primitive < roots_.size(); ++primitive) {
            if (roots_[primitive] == Arena::none) continue;
            bool idle = true;
            const std::uint32_t count = root_count(scene, primitive);
            for (std::uint32_t i = 0; i < count; ++i) idle = sweep(roots_[primitive] + i) && idle;
            if (!idle) continue;
            arena_.release(roots_[primitive], count);
            roots_[primitive] = Arena::none;
        }
    }
    arena_.accept();
}

}  // namespace raybound
