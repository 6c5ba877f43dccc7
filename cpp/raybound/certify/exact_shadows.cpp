// Which rays of a batch see a light: from the lists of surface cells, else by searches.
#include "raybound/certify/exact_level.h"

namespace raybound {

namespace {

// TUNED: rays of one batch on one face, from which on it is worth having cells. Those of curved faces are small and
// know little; rays that mirrors and glass have sent seldom come by the same place again, but for flat mirrors, which
// fill whole batches.
constexpr int flat_cells_pay = 16, other_cells_pay = 48;

constexpr std::size_t piece_slots = 64;  // TUNED: more are hardly ever seen in one tile

std::size_t slot_of(const FaceKey& key) {
    const std::uint32_t face = std::uint32_t(key.face_offset + key.face) * Chart::pieces + std::uint32_t(key.piece);
    return ((key.primitive * 2 + (key.outward ? 1 : 0)) * 0x9e3779b1u + face * 0x85ebca6bu) >> 26;
}

Searched reason(NoCell why) {
    if (why == NoCell::unsupported) return Searched::unsupported;
    return why == NoCell::crowded ? Searched::shadow : Searched::cost;
}

}  // namespace

// Leaves in the light's `rays` those that see it.
void ExactTracer::settle_shadows(Level& level, std::size_t light, BatchRadiance& out) {
    Level::LightValue& value = level.lights[light];
    const RaySet weigh = value.rays, all = weigh & ~value.asked;
    value.rays &= ~(value.asked & value.blocked);
    if (all != 0) {
        search_shadows(level, light, all);
        value.asked |= all;
        value.blocked = (value.blocked & ~all) | (all & ~value.rays);
    }
    for (std::size_t why = 0; why < no_cell_reasons; ++why)
        for (RaySet each = value.without_cells[why] & weigh; each != 0;)
            mark(out.searched[take_first(each)], reason(NoCell(why)));
}

// From the lists of cells; what they do not know is searched for. The solid that a ray is within comes first.
void ExactTracer::search_shadows(Level& level, std::size_t light, RaySet all) {
    const RaySet inside = blocked_from_inside(scene_, level.outside, *scene_.lights()[light].light, all);
    level.lights[light].rays &= ~inside;
    all &= ~inside;
    RaySet rest = 0;
    for (Face& face : level.faces) {
        const RaySet open = all & face.rays;
        if (open == 0) continue;
        const bool flat = is_flat_face(scene_.geometry().leaves[face.leaf], face.face);
        const int cells_pay = flat && level.depth == 1 ? flat_cells_pay : other_cells_pay;
        if (std::popcount(face.rays) >= cells_pay) {
            rest |= ask_cells(level, face, light, open);
            continue;
        }
        rest |= open;
        const bool charted = Chart::is_known(scene_.geometry(), scene_.geometry().leaves[face.leaf]);
        const NoCell why = charted ? NoCell::cost : NoCell::unsupported;
        level.lights[light].without_cells[std::size_t(why)] |= open;
    }
    if (rest == 0) return;
    const int first = std::countr_zero(rest);
    const double footprint = double(level.way[first]) * settings_.pixel_angle;
    SearchCounts counts;
    level.lights[light].rays &= ~blocked_rays(scene_, level.outside, *scene_.lights()[light].light, rest,
                                              float(minimum(32 * footprint, 0x1p100)), last_blockers_[light], counts);
    counts_.rays.shadow += counts.searches;
    counts_.tests += counts.tests;
}

ExactTracer::Piece& ExactTracer::piece_at(const Level& level, const Face& face, int index) {
    const Geometry& geometry = scene_.geometry();
    const Vec3d normal(level.normal[index]);
    const int number =
        Chart::piece_for(geometry, face.leaf, face.face, geometry.leaves[face.leaf].is_complement ? -normal : normal);
    const Leaf& leaf = geometry.leaves[face.leaf];
    const bool outward = is_sheet(leaf) || face.entering != leaf.is_complement;
    const FaceKey key{face.primitive, face.leaf, face.face, face.face_offset, number, outward, face.outer};
    if (pieces_.empty()) pieces_.resize(piece_slots);
    std::optional<Piece>& slot = pieces_[slot_of(key)];
    if (!slot || slot->tile != tile_ || slot->cells.key() != key) {
        slot.emplace(FaceCells(cells_, scene_, key, settings_.policy, counts_.cells), tile_);
        slot->answers.resize(scene_.lights().size());
    }
    if (slot->batch != batch_) slot->packs = 0;
    slot->batch = batch_;
    for (int k = 0; k < batch_packs && slot->cells.is_supported(); ++k) {
        if (lanes_of_pack(face.rays, k) == 0 || (slot->packs >> k & 1) != 0) continue;
        slot->points[std::size_t(k)] = slot->cells.chart().coordinates(Vec3<DoublePack>(level.outside.origin.pack(k)));
        slot->packs |= 1u << k;
    }
    return *slot;
}

// The last answer, as long as it is about the same cell.
const CellAnswer& ExactTracer::ask(const Level& level, Piece& piece, std::size_t light, int index) {
    CellAnswer& answer = piece.answers[light];
    const Vec3d point = piece.point(index);
    if (answer.verdict != CellVerdict::none && contains(answer.cell, point)) return answer;
    answer = {};
    if (!piece.cells.is_supported()) return answer;
    answer = piece.cells.ask(light, point, double(level.way[index]) * settings_.pixel_angle);
    if (answer.verdict != CellVerdict::none && !contains(answer.cell, point)) answer.verdict = CellVerdict::none;
    return answer;
}

// Settles what the face's cells know; returns the rays that have to be searched for.
RaySet ExactTracer::ask_cells(Level& level, const Face& face, std::size_t light, RaySet open) {
    RaySet rest = 0;
    while (open != 0) {
        const int first = std::countr_zero(open);
        Piece& piece = piece_at(level, face, first);
        const CellAnswer& answer = ask(level, piece, light, first);
        if (answer.verdict != CellVerdict::none) {
            RaySet inside = 0;
            for (int k = first / pack_width; k < batch_packs; ++k)
                if (const std::uint32_t lanes = lanes_of_pack(open, k); lanes != 0)
                    inside |= set_of_pack(lanes & bits(contains(answer.cell, piece.points[std::size_t(k)])), k);
            test_candidates(level, light, inside, answer);
            open &= ~inside;
            continue;
        }
        // Nothing is known here; where that is not for a list's length it is true of the others, too.
        const RaySet unknown = answer.why == NoCell::crowded ? open & -open : open;
        level.lights[light].without_cells[std::size_t(answer.why)] |= unknown;
        rest |= unknown;
        open &= ~unknown;
    }
    return rest;
}

void ExactTracer::test_candidates(Level& level, std::size_t light, RaySet rays, const CellAnswer& answer) {
    RaySet& lit = level.lights[light].rays;
    if (answer.verdict == CellVerdict::blocked) lit &= ~rays;
    if (answer.verdict != CellVerdict::list) return;
    for (int k = 0; k < batch_packs; ++k) {
        std::uint32_t lanes = lanes_of_pack(rays, k);
        if (lanes == 0) continue;
        const RayPack pack = shadow_rays(level.outside, *scene_.lights()[light].light, k);
        for (const std::uint32_t primitive : answer.candidates) {
            counts_.tests += std::uint64_t(std::popcount(lanes));
            const std::uint32_t asking = lanes & asking_lanes(level.outside.states, k, primitive);
            if (asking == 0) continue;
            const std::uint32_t blocked = blocked_lanes(scene_, level.outside, pack, k, primitive, asking);
            lit &= ~set_of_pack(blocked, k);
            lanes &= ~blocked;
            if (lanes == 0) break;
        }
    }
}

}  // namespace raybound
