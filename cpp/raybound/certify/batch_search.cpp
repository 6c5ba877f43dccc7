#include "raybound/certify/batch_search.h"

#include <algorithm>
#include <optional>

#include "raybound/geometry/lanes.h"
#include "raybound/shapes/lanes.h"

namespace raybound {

namespace {

// Rays this far apart in direction have little in common.
constexpr double widest = 0.25;  // TUNED
// TUNED: primitives that a bundle asks; if there are more, its parts ask fewer each.
constexpr int most_asked = 32;

// The closest hits of a batch at work.
struct BatchSearch {
    const Snapshot& scene;
    const RayBatch& rays;
    BatchHits& hits;
    SearchCounts& counts;
    std::array<FloatPack, batch_packs> doubtful_from{};  // of rays that are within a solid: where they may leave it
    RaySet doubtful = 0;                                 // rays that have to be searched for alone

    bool search_bundle(const RayBundle& bundle, int begin, int end);
    void consider_leaving(const RayPack& pack, int k, std::uint32_t primitive, std::uint32_t lanes);
    RaySet search_packs(int begin, int end, BatchMode& mode);
};

// Rays at a closed primitive that is not convex, on whose surface they begin.
void BatchSearch::consider_leaving(const RayPack& pack, int k, std::uint32_t primitive, std::uint32_t lanes) {
    const Geometry& geometry = scene.geometry();
    const Primitive& p = geometry.primitives[primitive];
    for_each_lane(lanes, [&](int lane) {
        const int i = k * pack_width + lane;
        const WideRay<float> ray(lane_of(pack.narrow, lane));
        NearestPack& best = hits[std::size_t(k)];
        float entry;
        if (!crosses(p.bounds, SlabRay<float>(ray.narrow), best.t[lane], &entry)) return;
        const Asking<float> asking{.t_max = best.t[lane]};
        const Crossing<double> crossing = crossing_from_outside(geometry, p, ray, rays.states.from[i], true, asking);
        if (consider_one(geometry, primitive, lane, crossing, entry, doubtful_from[std::size_t(k)][lane], best))
            doubtful |= RaySet(1) << i;
    });
}

// Packs [begin, end) of a batch in one walk. False if it was given up: there are too many primitives for so many rays.
// What has been found until then is right as far as it goes.
bool BatchSearch::search_bundle(const RayBundle& bundle, int begin, int end) {
    const Geometry& geometry = scene.geometry();
    std::array<std::optional<RayPack>, batch_packs> packs;
    const auto until_now = [&] {
        return farthest(std::span(hits).subspan(std::size_t(begin), std::size_t(end - begin))) * SweptBox::widening;
    };
    float until = until_now();
    int asked = 0;
    const auto ask = [&](std::uint32_t primitive) {
        float near;
        const Primitive& p = geometry.primitives[primitive];
        if (asked > most_asked || !bundle.may_meet(p.bounds, until, near)) return;
        if (p.is_csg && raybound::hits(bundle, geometry, p) == Verdict::no) return;  // (others are tested as fast)
        if (++asked > most_asked) return;
        for (int k = begin; k < end; ++k) {
            std::uint32_t lanes = lanes_of_pack(rays.all(), k) & asking_lanes(rays.states, k, primitive);
            if (lanes == 0) continue;
            auto& pack = packs[std::size_t(k)];
            if (!pack) pack.emplace(rays.pack(k));
            counts.tests += std::uint64_t(std::popcount(lanes));
            const std::uint32_t left = lanes & lanes_with(rays.states.left, k, primitive);
            if (left != 0 && is_closed(geometry, p)) {
                consider_leaving(*pack, k, primitive, left);
                lanes &= ~left;
            }
            doubtful |= set_of_pack(
                consider(geometry, primitive, *pack, lanes, doubtful_from[std::size_t(k)], hits[std::size_t(k)]), k);
        }
        until = until_now();
    };
    ++counts.searches;
    scene.accelerator().bvh().visit(
        [&](const auto& plane, Pack<float>& near) { return bundle.may_meet(plane, until, near); },
        [&] { return asked > most_asked ? -1.0f : until; },
        [&](std::uint32_t leaf, float) { scene.accelerator().visit_primitives(leaf, ask); });
    return asked <= most_asked;
}

// Packs [begin, end), together if they are alike, else one by one, at last ray by ray; returns those that went alone.
RaySet BatchSearch::search_packs(int begin, int end, BatchMode& mode) {
    const int first = begin * pack_width, last = std::min(end * pack_width, rays.count);
    const bool worth = last - first >= fewest && (end - begin > 1 ? mode.batches : mode.packs);
    if (worth) {
        const Boxd directions = range(rays.direction, begin, end);
        if (max_component(directions.extent()) <= widest) {
            const RayBundle bundle(range(rays.origin, begin, end), directions);
            if (search_bundle(bundle, begin, end)) return 0;
            (end - begin > 1 ? mode.batches : mode.packs) = false;
        }
    }
    RaySet alone = 0;
    if (end - begin > 1) {
        for (int k = begin; k < end; ++k) alone |= search_packs(k, k + 1, mode);
        return alone;
    }
    for (int i = first; i < last; ++i) alone |= RaySet(1) << i;
    return alone;
}

// The ways out of the solids that rays are within.
void set_exit(NearestPack& pack, int lane, std::uint32_t primitive, const Crossing<double>& crossing) {
    pack.set(lane, primitive, crossing, float(crossing.t));
}

void find_exits(const Snapshot& scene, const RayBatch& rays, int k, std::uint32_t lanes, NearestPack& exits) {
    const Geometry& geometry = scene.geometry();
    const RayPack pack = rays.pack(k);
    while (lanes != 0) {
        const int first = k * pack_width + std::countr_zero(lanes);
        const std::uint32_t primitive = rays.states.within[first];
        const std::uint32_t same = lanes & lanes_with(rays.states.within, k, primitive);
        lanes &= ~same;
        const std::uint32_t root = geometry.primitives[primitive].root;
        if (is_convex_solid(geometry, geometry.primitives[primitive])) {
            const LeavingPack leaving = leave_convex(geometry, root, pack);
            for_each_lane(same, [&](int lane) {
                set_exit(exits, lane, primitive,
                         {leaving.t[lane], root, std::int32_t(leaving.face[lane]), 0, true, false});
            });
            continue;
        }
        for_each_lane(same, [&](int lane) {
            const WideRay<float> ray(lane_of(pack.narrow, lane));
            const Departure& from = rays.states.from[k * pack_width + lane];
            set_exit(exits, lane, primitive, crossing_from_inside(geometry, geometry.primitives[primitive], ray, from));
        });
    }
}

// Those of the rays that have hit an exit of a closed solid that they are not known to be inside of.
RaySet contradictions(const Snapshot& scene, const RayBatch& rays, const BatchHits& hits) {
    const Geometry& geometry = scene.geometry();
    RaySet found = 0;
    for (int k = 0; k < rays.packs(); ++k) {
        const NearestPack& pack = hits[std::size_t(k)];
        for_each_lane(pack.hit & ~pack.entering & lanes_of_pack(rays.all(), k), [&](int lane) {
            const int i = k * pack_width + lane;
            const std::uint32_t primitive = pack.primitive[lane];
            if (primitive != rays.states.within[i] && is_closed(geometry, geometry.primitives[primitive]))
                found |= RaySet(1) << i;
        });
    }
    return found;
}

}  // namespace

Boxd box_of(const Bounds<FloatPack>& packs) {
    Boxd box;
    for (int lane = 0; lane < pack_width; ++lane) {
        box.extend(Vec3d(lane_of(packs.lower, lane)));
        box.extend(Vec3d(lane_of(packs.upper, lane)));
    }
    return box;
}

float farthest(std::span<const NearestPack> hits) {
    FloatPack most(0.0f);
    for (const NearestPack& pack : hits) most = maximum(most, pack.t);
    float result = 0;
    for (int lane = 0; lane < pack_width; ++lane) result = maximum(result, most[lane]);
    return result;
}

Boxd range(const BatchVectors& values, int begin, int end) {
    Bounds<FloatPack> packs{values.pack(begin), values.pack(begin)};
    for (int k = begin + 1; k < end; ++k) packs.extend(values.pack(k));
    return box_of(packs);
}

void search_alone(const Snapshot& scene, const RayBatch& rays, int index, BatchHits& hits, BatchFindings& findings) {
    const WideRay<float> ray(rays.origin[index], rays.direction[index]);
    const Nearest<float> nearest = closest_hit<float>(scene, ray, rays.states.from[index]);
    NearestPack& pack = hits[std::size_t(index / pack_width)];
    const int lane = index % pack_width;
    const RaySet bit = RaySet(1) << index;
    pack.hit &= ~(1u << lane);
    findings.within[index] = nearest.within;
    if (nearest.touching) findings.touching |= bit;
    if (nearest.touching || nearest.within != rays.states.within[index]) findings.special |= bit;
    pack.t.v[lane] = nearest.t;
    if (!nearest.hit) return;
    pack.set(lane, nearest.primitive, nearest.crossing, nearest.t);
}

// What lies beyond the exit from the solid that a ray is within is of no interest. Rays for which the rules of packs do
// not do are searched for alone.
void closest_hits(const Snapshot& scene, const RayBatch& rays, BatchHits& hits, BatchMode& mode, SearchCounts& counts,
                  BatchFindings& findings) {
    findings.alone = findings.touching = findings.special = 0;
    std::copy_n(rays.states.within, rays.packs() * pack_width, findings.within);
    BatchSearch search{scene, rays, hits, counts};
    BatchHits exits;
    RaySet within = 0;
    for (int k = 0; k < rays.packs(); ++k) {
        NearestPack& pack = hits[std::size_t(k)];
        pack.t = search.doubtful_from[std::size_t(k)] = FloatPack(infinity<float>);
        pack.hit = pack.entering = 0;
        const std::uint32_t lanes = lanes_within(rays.states, k) & lanes_of_pack(rays.all(), k);
        if (lanes == 0) continue;
        within |= set_of_pack(lanes, k);
        find_exits(scene, rays, k, lanes, exits[std::size_t(k)]);
        const FloatPack& t = exits[std::size_t(k)].t;
        const FloatPack doubt = t * FloatPack(0x1p-15f) + norm1(rays.origin.pack(k)) * FloatPack(0x1p-39f);
        pack.t = select(lanes_of<float>(lanes), t + doubt, pack.t);
        search.doubtful_from[std::size_t(k)] = select(lanes_of<float>(lanes), t - doubt, infinity<FloatPack>);
    }
    for (int k = rays.count; k < rays.packs() * pack_width; ++k)  // out of use: nothing is looked for
        hits[std::size_t(k / pack_width)].t.v[k % pack_width] = 0;
    findings.alone = search.search_packs(0, rays.packs(), mode);
    counts.searches += std::uint64_t(std::popcount(findings.alone));
    findings.until = farthest(std::span(hits).first(std::size_t(rays.packs())));
    for (RaySet rest = within; rest != 0;) {
        const int i = take_first(rest);
        NearestPack& pack = hits[std::size_t(i / pack_width)];
        const NearestPack& exit = exits[std::size_t(i / pack_width)];
        const int lane = i % pack_width;
        if (pack.hit >> lane & 1) continue;
        set_exit(pack, lane, exit.primitive[lane],
                 {exit.crossing_t[lane], exit.leaf[lane], exit.face[lane], exit.face_offset[lane], true, false});
    }
    const RaySet again = (search.doubtful | contradictions(scene, rays, hits)) & ~findings.alone;
    counts.searches += std::uint64_t(std::popcount(again));
    findings.alone |= again;
    for (RaySet rest = findings.alone; rest != 0;) search_alone(scene, rays, take_first(rest), hits, findings);
    findings.until = maximum(findings.until, farthest(std::span(hits).first(std::size_t(rays.packs()))));
}

}  // namespace raybound
