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

// What one cell knows of a light, asked of the scene now if nobody has asked before.
std::uint32_t FaceCells::entry_of(std::size_t light, std::uint32_t cell, const ChartRectangle& here,
                                  std::uint32_t parent, const ChartRectangle& above) {
    const std::uint32_t word = cell + Cells::cell_words_without_lights + cells_.slot_of_light_[light];
    const std::uint32_t entry = cells_.arena_.word(word).load(std::memory_order_acquire);
    if (entry != 0) return entry;
    // A list is drawn from the parent's if all of the cell lies in the parent's patch: so it holds by itself.
    const ChartCell area = chart_->cell(here);
    if (parent != 0 && !is_within(area, chart_->cell(above))) parent = 0;
    const Bundle bundle = light_bundle(chart_->patch(area), *scene_.lights()[light].light);
    return verdict(cells_, scene_, bundle, key_.departed, word, parent, counts_);
}

CellAnswer FaceCells::ask(std::size_t light, const Vec3d& point, double footprint) {
    const auto no = [](NoCell why) {
        CellAnswer answer;
        answer.why = why;
        return answer;
    };
    if (root_ == Arena::none) return no(NoCell::memory);
    if (!(footprint > 0)) return no(NoCell::cost);
    ChartRectangle rectangle = chart_->whole(), above = rectangle;
    std::uint32_t cell = root_, parent = 0;
    bool first = true;  // of the cells that have lists
    for (;;) {
        const double u = chart_->length_u(rectangle), v = chart_->length_v(rectangle);
        const double length = maximum(u, v);
        const bool smallest = 0.5 * length < policy_.smallest_cell * footprint;
        cells_.touch(cell);
        if (length <= policy_.first_cells * footprint) {
            // (Whether the verdict is there already must not matter: which thread asks first is chance.)
            if (first && u * v < policy_.least_rays * square(footprint)) return no(NoCell::cost);
            first = false;
            const std::uint32_t entry = entry_of(light, cell, rectangle, parent, above);
            if (entry == 0) return no(NoCell::memory);
            const auto list = entries::primitives(cells_.arena_, entry);
            const bool too_long = entries::is_too_long(entry) || list.size() > policy_.longest_list;
            const bool settled = entries::verdict(entry) != CellVerdict::list;
            if (settled || smallest || (!too_long && list.size() <= policy_.short_list)) {
                if (!settled && too_long) return no(NoCell::crowded);
                return {entries::verdict(entry), NoCell::crowded, list, chart_->cell(rectangle)};
            }
            parent = entry;
            above = rectangle;
        } else if (smallest) {
            return no(NoCell::cost);
        }
        const Division ways = division(*chart_, rectangle);
        const std::uint32_t children = cells_.make_cells(cell, ways.ways());
        if (children == Arena::none) return no(NoCell::memory);
        const int index = part_of(rectangle, ways, point);
        cell = children + std::uint32_t(index) * cells_.cell_words();
        rectangle = part(rectangle, ways, index);
    }
}

}  // namespace raybound
