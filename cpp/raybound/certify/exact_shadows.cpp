// Which rays of a batch see a light: from the lists of surface cells, else by searches.
#include "raybound/certify/exact_level.h"

namespace raybound {

namespace {

constexpr int cells_pay = 12;  // TUNED: rays of one batch on one face, from which on it is worth having cells

Searched reason(NoCell why) {
    if (why == NoCell::unsupported) return Searched::unsupported;
    return why == NoCell::crowded ? Searched::shadow : Searched::cost;
}

}  // namespace

// Leaves in the light's `rays` those that see it.
void ExactTracer::settle_shadows(Level& level, std::size_t light, BatchRadiance& out) {
    Level::LightValue& value = level.lights[light];
    const RaySet all = value.rays & ~value.asked;
    value.rays &= ~(value.asked & value.blocked);
    if (all == 0) return;
    search_shadows(level, light, all, out);
    value.asked |= all;
    value.blocked = (value.blocked & ~all) | (all & ~value.rays);
}

// From the lists of cells; what they do not know is searched for.
void ExactTracer::search_shadows(Level& level, std::size_t light, RaySet all, BatchRadiance& out) {
    RaySet rest = 0;
    for (Face& face : level.faces) {
        const RaySet open = all & face.rays;
        if (open == 0) continue;
        if (std::popcount(face.rays) >= cells_pay) {
            rest |= ask_cells(level, face, light, open, out);
            continue;
        }
        rest |= open;
        const bool charted = Chart::is_known(scene_.geometry(), scene_.geometry().leaves[face.leaf]);
        const Searched why = charted ? Searched::cost : Searched::unsupported;
        for (RaySet each = open; each != 0;) mark(out.searched[take_first(each)], why);
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

ExactTracer::Piece& ExactTracer::piece_at(Level& level, Face& face, int index) {
    const Geometry& geometry = scene_.geometry();
    const int number = Chart::piece_for(geometry, face.leaf, face.face, Vec3d(level.normal[index]));
    for (Piece& piece : level.pieces)
        if (piece.face == &face && piece.number == number) return piece;
    const bool outward = face.entering || is_sheet(geometry.leaves[face.leaf]);
    const FaceKey key{face.primitive, face.leaf, face.face, face.face_offset, number, outward, face.outer};
    const double footprint = double(level.way[index]) * settings_.pixel_angle;
    level.pieces.push_back(
        {&face, number, FaceCells(cells_, scene_, key, footprint, settings_.policy, counts_.cells), {}});
    Piece& piece = level.pieces.back();
    if (piece.cells.is_supported())
        for (int k = 0; k < batch_packs; ++k)
            if (lanes_of_pack(face.rays, k) != 0)
                piece.points[std::size_t(k)] =
                    piece.cells.chart().coordinates(Vec3<DoublePack>(level.outside.origin.pack(k)));
    return piece;
}

// Settles what the face's cells know; returns the rays that have to be searched for.
RaySet ExactTracer::ask_cells(Level& level, Face& face, std::size_t light, RaySet open, BatchRadiance& out) {
    RaySet rest = 0;
    while (open != 0) {
        const int first = std::countr_zero(open);
        Piece& piece = piece_at(level, face, first);
        CellAnswer answer;
        if (piece.cells.is_supported()) {
            const Vec3<DoublePack>& at = piece.points[std::size_t(first / pack_width)];
            const int lane = first % pack_width;
            const Vec3d point{at.x.v[lane], at.y.v[lane], at.z.v[lane]};
            answer = piece.cells.ask(light, point);
            if (answer.verdict != CellVerdict::none && contains(answer.cell, point)) {
                RaySet inside = 0;
                for (int k = first / pack_width; k < batch_packs; ++k)
                    if (const std::uint32_t lanes = lanes_of_pack(open, k); lanes != 0)
                        inside |= set_of_pack(lanes & bits(contains(answer.cell, piece.points[std::size_t(k)])), k);
                test_candidates(level, light, inside, answer);
                open &= ~inside;
                continue;
            }
        }
        // Nothing is known here; where that is not for a list's length it is true of the others, too.
        const RaySet unknown = answer.why == NoCell::crowded ? open & -open : open;
        for (RaySet each = unknown; each != 0;) mark(out.searched[take_first(each)], reason(answer.why));
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
            const std::uint32_t blocked = blocked_lanes(scene_.geometry(), primitive, pack, lanes);
            lit &= ~set_of_pack(blocked, k);
            lanes &= ~blocked;
            if (lanes == 0) break;
        }
    }
}

}  // namespace raybound
