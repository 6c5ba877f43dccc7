#include "raybound/certify/face_cells.h"

#include "raybound/certify/entries.h"
#include "raybound/certify/roots.h"

namespace raybound {

Division division(const Chart& chart, const ChartRectangle& rectangle) {
    const double u = chart.length_u(rectangle), v = chart.length_v(rectangle);
    return {u >= 0.7 * v, v >= 0.7 * u};
}

ChartRectangle part(const ChartRectangle& whole, const Division& division, int index) {
    ChartRectangle r = whole;
    int v_index = index;
    if (division.along_u) {
        r.half_u *= 0.5;
        r.center_u += index % 2 == 1 ? r.half_u : -r.half_u;
        v_index = index / 2;
    }
    if (division.along_v) {
        r.half_v *= 0.5;
        r.center_v += v_index % 2 == 1 ? r.half_v : -r.half_v;
    }
    return r;
}

namespace {

int part_of(const ChartRectangle& whole, const Division& division, const Vec3d& point) {
    const int u = division.along_u && point.x > whole.center_u ? 1 : 0;
    const int v = division.along_v && point.y > whole.center_v ? 1 : 0;
    return division.along_u ? u + 2 * v : v;
}

// The list of a bundle, of some primitives: those that may block; or one that does.
class ListMaker {
  public:
    ListMaker(const Bundle& bundle, const Geometry& geometry, std::uint32_t departed)
        : bundle_(bundle), geometry_(geometry), departed_(departed) {}

    void ask(std::uint32_t primitive) {
        if (primitive == departed_ || verdict_ == CellVerdict::blocked) return;
        const Verdict answer = hits(bundle_, geometry_, geometry_.primitives[primitive]).verdict;
        if (answer == Verdict::no) return;
        if (answer == Verdict::yes) {
            verdict_ = CellVerdict::blocked;
            list_.clear();
        } else {
            verdict_ = CellVerdict::list;
        }
        list_.push_back(primitive);
    }

    bool is_settled() const { return verdict_ == CellVerdict::blocked; }
    CellVerdict verdict() const { return verdict_; }
    std::span<const std::uint32_t> list() const { return list_; }

  private:
    const Bundle& bundle_;
    const Geometry& geometry_;
    std::uint32_t departed_;
    CellVerdict verdict_ = CellVerdict::lit;
    std::vector<std::uint32_t> list_;
};

void count(CellCounts& counts, CellVerdict verdict) {
    ++counts.made;
    if (verdict == CellVerdict::lit) ++counts.lit;
    if (verdict == CellVerdict::blocked) ++counts.blocked;
    if (verdict == CellVerdict::list) ++counts.listed;
}

}  // namespace

std::uint32_t FaceCells::verdict(Cells& cells, const Snapshot& scene, const Bundle& bundle, std::uint32_t departed,
                                 std::uint32_t word, std::uint32_t parent, CellCounts& counts) {
    ListMaker maker(bundle, scene.geometry(), departed);
    if (parent != 0 && !entries::is_too_long(parent)) {
        for (const std::uint32_t primitive : entries::primitives(cells.arena_, parent)) maker.ask(primitive);
    } else {
        const auto test = [&](const auto& plane, Pack<float>& near) { return bundle.may_meet(plane, near); };
        const auto until = [&] { return maker.is_settled() ? -1.0f : infinity<float>; };
        scene.accelerator().bvh().visit(test, until, [&](std::uint32_t leaf, float) {
            scene.accelerator().visit_primitives(leaf, [&](std::uint32_t primitive) { maker.ask(primitive); });
        });
    }
    std::uint32_t entry = entries::store(cells.arena_, maker.verdict(), maker.list());
    if (entry == 0) {
        ++counts.refused;
        return 0;
    }
    std::uint32_t expected = 0;
    if (!cells.arena_.word(word).compare_exchange_strong(expected, entry, std::memory_order_acq_rel)) {
        entries::release(cells.arena_, entry);  // another thread was faster, with the same verdict
        return expected;
    }
    count(counts, maker.verdict());
    return entry;
}

FaceCells::FaceCells(Cells& cells, const Snapshot& scene, const FaceKey& key, const CellPolicy& policy,
                     CellCounts& counts)
    : cells_(cells),
      scene_(scene),
      key_(key),
      policy_(policy),
      counts_(counts),
      chart_(Chart::make(scene.geometry(), key.leaf, key.face, key.piece)) {
    if (!chart_) return;
    const std::uint32_t roots = cells.roots_of(scene, key.primitive);
    if (roots == Arena::none) return;
    root_ = cells.make_cells(roots + root_number(key), 1);
}

CellAnswer FaceCells::ask(std::size_t light, const Vec3d& point, double footprint) {
    CellAnswer answer;
    if (root_ == Arena::none || !(footprint > 0)) {
        answer.why = root_ == Arena::none ? NoCell::memory : NoCell::cost;
        return answer;
    }
    const std::uint32_t slot = Cells::cell_words_without_lights + cells_.slot_of_light_[light];
    ChartRectangle rectangle = chart_->whole();
    std::uint32_t cell = root_, parent = 0;
    bool first = true;  // of the cells that have lists
    for (;;) {
        const double u = chart_->length_u(rectangle), v = chart_->length_v(rectangle);
        const double length = maximum(u, v);
        const bool smallest = 0.5 * length < policy_.smallest_cell * footprint;
        cells_.touch(cell);
        if (length <= policy_.first_cells * footprint) {
            // (Whether the verdict is there already must not matter: which thread asks first is chance.)
            if (first && u * v < policy_.least_rays * square(footprint)) {
                answer.why = NoCell::cost;
                return answer;
            }
            first = false;
            std::uint32_t entry = cells_.arena_.word(cell + slot).load(std::memory_order_acquire);
            // A list is drawn from the parent's if all of the cell lies in the parent's patch: so it holds by itself.
            const ChartCell here = chart_->cell(rectangle);
            if (parent != 0 && !is_within(here, answer.cell)) parent = 0;
            answer.cell = here;
            if (entry == 0) {
                const Bundle bundle = light_bundle(chart_->patch(here), *scene_.lights()[light].light);
                entry = verdict(cells_, scene_, bundle, key_.departed, cell + slot, parent, counts_);
            }
            if (entry == 0) {
                answer.why = NoCell::memory;
                return answer;
            }
            const auto list = entries::primitives(cells_.arena_, entry);
            const bool too_long = entries::is_too_long(entry) || list.size() > policy_.longest_list;
            const bool settled = entries::verdict(entry) != CellVerdict::list;
            if (settled || smallest || (!too_long && list.size() <= policy_.short_list)) {
                answer.candidates = list;
                answer.verdict = !settled && too_long ? CellVerdict::none : entries::verdict(entry);
                answer.why = NoCell::crowded;
                return answer;
            }
            parent = entry;
        } else if (smallest) {
            answer.why = NoCell::cost;
            return answer;
        }
        const Division ways = division(*chart_, rectangle);
        const std::uint32_t children = cells_.make_cells(cell, ways.ways());
        if (children == Arena::none) {
            answer.why = NoCell::memory;
            return answer;
        }
        const int index = part_of(rectangle, ways, point);
        cell = children + std::uint32_t(index) * cells_.cell_words();
        rectangle = part(rectangle, ways, index);
    }
}

}  // namespace raybound
