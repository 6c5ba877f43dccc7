#include "raybound/certify/batch_search.h"

#include <algorithm>
#include <optional>

#include "raybound/geometry/lanes.h"

namespace raybound {

namespace {

// Rays this far apart in direction have little in common.
constexpr double widest = 0.25;  // TUNED
constexpr int fewest = 3;        // rays that a bundle pays for
// TUNED: primitives that a bundle asks; if there are more, its parts ask fewer each.
constexpr int most_asked = 32, most_asked_for_shadows = 16;

Boxd box_of(const Bounds<FloatPack>& packs) {
    Boxd box;
    for (int lane = 0; lane < pack_width; ++lane) {
        box.extend(Vec3d(lane_of(packs.lower, lane)));
        box.extend(Vec3d(lane_of(packs.upper, lane)));
    }
    return box;
}

// Packs [begin, end) of a batch in one walk. False if it was given up: there are too many primitives for so many rays.
// What has been found until then is right as far as it goes.
bool search_bundle(const Snapshot& scene, const RayBatch& rays, const RayBundle& bundle, int begin, int end,
                   BatchHits& hits, SearchCounts& counts) {
    const Geometry& geometry = scene.geometry();
    std::array<std::optional<RayPack>, batch_packs> packs;
    float until = infinity<float>;
    int asked = 0;
    const auto ask = [&](std::uint32_t primitive) {
        float near;
        const Primitive& p = geometry.primitives[primitive];
        if (asked > most_asked || !bundle.may_meet(p.bounds, until, near)) return;
        if (p.is_csg && raybound::hits(bundle, geometry, p) == Verdict::no) return;  // (others are tested as fast)
        if (++asked > most_asked) return;
        for (int k = begin; k < end; ++k) {
            const std::uint32_t lanes = lanes_of_pack(rays.all(), k) & ~departed_lanes(rays.departed, k, primitive);
            if (lanes == 0) continue;
            auto& pack = packs[std::size_t(k)];
            if (!pack) pack.emplace(rays.pack(k));
            consider(geometry, primitive, *pack, lanes, hits[std::size_t(k)]);
            counts.tests += std::uint64_t(std::popcount(lanes));
        }
        until = farthest(std::span(hits).subspan(std::size_t(begin), std::size_t(end - begin))) * SweptBox::widening;
    };
    ++counts.searches;
    scene.accelerator().bvh().visit(
        [&](const auto& plane, Pack<float>& near) { return bundle.may_meet(plane, until, near); },
        [&] { return asked > most_asked ? -1.0f : until; },
        [&](std::uint32_t leaf, float) { scene.accelerator().visit_primitives(leaf, ask); });
    return asked <= most_asked;
}

void search_ray(const Snapshot& scene, const RayBatch& rays, int index, BatchHits& hits, SearchCounts& counts) {
    const WideRay<float> ray(rays.origin[index], rays.direction[index]);
    const Nearest<float> nearest = closest_hit<float>(scene, ray, Departure{rays.departed[index]});
    ++counts.searches;
    if (!nearest.hit) return;
    NearestPack& pack = hits[std::size_t(index / pack_width)];
    const int lane = index % pack_width;
    pack.hit |= 1u << lane;
    pack.entering = (pack.entering & ~(1u << lane)) | std::uint32_t(nearest.crossing.entering) << lane;
    pack.t.v[lane] = nearest.t;
    pack.crossing_t.v[lane] = nearest.crossing.t;
    pack.primitive[lane] = nearest.primitive;
    pack.leaf[lane] = nearest.crossing.leaf;
    pack.face[lane] = nearest.crossing.face;
    pack.face_offset[lane] = nearest.crossing.face_offset;
}

// Packs [begin, end), together if they are alike, else one by one, at last ray by ray.
RaySet search_packs(const Snapshot& scene, const RayBatch& rays, int begin, int end, BatchHits& hits, BatchMode& mode,
                    SearchCounts& counts) {
    const int first = begin * pack_width, last = std::min(end * pack_width, rays.count);
    const bool worth = last - first >= fewest && (end - begin > 1 ? mode.batches : mode.packs);
    if (worth) {
        const Boxd directions = range(rays.direction, begin, end);
        if (max_component(directions.extent()) <= widest) {
            const RayBundle bundle(range(rays.origin, begin, end), directions);
            if (search_bundle(scene, rays, bundle, begin, end, hits, counts)) return 0;
            (end - begin > 1 ? mode.batches : mode.packs) = false;
        }
    }
    RaySet alone = 0;
    if (end - begin > 1) {
        for (int k = begin; k < end; ++k) alone |= search_packs(scene, rays, k, k + 1, hits, mode, counts);
        return alone;
    }
    for (int i = first; i < last; ++i) {
        search_ray(scene, rays, i, hits, counts);
        alone |= RaySet(1) << i;
    }
    return alone;
}

bool is_blocked_alone(const Snapshot& scene, const ShadowOrigins& from, const Light& light, int index,
                      std::uint32_t& last) {
    const WideRay<float> ray = ray_to_light(from.origin[index], light);
    return is_blocked<float>(scene, ray, Departure{from.departed[index]}, nullptr, Acceleration::bvh, &last);
}

// Rays to a light in one walk of the BVH, which ends when all are blocked.
class ShadowBundle {
  public:
    ShadowBundle(const Snapshot& scene, const ShadowOrigins& from, const Light& light, RaySet rays)
        : scene_(scene),
          from_(from),
          light_(light),
          open_(rays),
          bundle_(light_bundle(patch_around(from, rays), light)) {}

    // The rays found to be blocked; if it `gave_up`, others may be, too.
    RaySet search(std::uint32_t& last, SearchCounts& counts) {
        const RaySet all = open_;
        if (last != Departure::none) ask(last, counts);
        if (open_ == 0) return all;
        ++counts.searches;
        scene_.accelerator().bvh().visit(
            [&](const auto& plane, Pack<float>& near) { return bundle_.may_meet(plane, near); },
            [&] { return open_ != 0 && !gave_up() ? infinity<float> : -1.0f; },
            [&](std::uint32_t leaf, float) {
                scene_.accelerator().visit_primitives(leaf, [&](std::uint32_t primitive) {
                    if (open_ == 0 || gave_up()) return;
                    ask(primitive, counts);
                    if (open_ == 0) last = primitive;
                });
            });
        return all & ~open_;
    }
    bool gave_up() const { return asked_ > most_asked_for_shadows; }

  private:
    void ask(std::uint32_t primitive, SearchCounts& counts) {
        if (!bundle_.may_meet(scene_.geometry().primitives[primitive].bounds)) return;
        ++asked_;
        for (int k = 0; k < batch_packs; ++k) {
            std::uint32_t lanes = lanes_of_pack(open_, k);
            if (lanes == 0) continue;
            lanes &= ~departed_lanes(from_.departed, k, primitive);
            if (lanes == 0) continue;
            auto& pack = packs_[std::size_t(k)];
            if (!pack) pack.emplace(shadow_rays(from_, light_, k));
            counts.tests += std::uint64_t(std::popcount(lanes));
            open_ &= ~set_of_pack(blocked_lanes(scene_.geometry(), primitive, *pack, lanes), k);
        }
    }

    const Snapshot& scene_;
    const ShadowOrigins& from_;
    const Light& light_;
    RaySet open_;
    Bundle bundle_;
    int asked_ = 0;
    std::array<std::optional<RayPack>, batch_packs> packs_;
};

// Those of the rays that begin within reach of the first one.
RaySet neighbours(const ShadowOrigins& from, RaySet rays, float reach) {
    const Vec3<FloatPack> middle(from.origin[std::countr_zero(rays)]);
    RaySet near = 0;
    for (int k = 0; k < batch_packs; ++k)
        if (lanes_of_pack(rays, k) != 0)
            near |= set_of_pack(bits(max_component(absolute(from.origin.pack(k) - middle)) <= FloatPack(reach)), k);
    return near & rays;
}

}  // namespace

float farthest(std::span<const NearestPack> hits) {
    FloatPack most(0.0f);
    for (const NearestPack& pack : hits) most = maximum(most, pack.t);
    float result = 0;
    for (int lane = 0; lane < pack_width; ++lane) result = maximum(result, most[lane]);
    return result;
}

Patch patch_around(const ShadowOrigins& from, RaySet rays) {
    const Vec3<FloatPack> first(from.origin[std::countr_zero(rays)]);
    Bounds<FloatPack> packs{first, first};
    for (int k = 0; k < batch_packs; ++k)
        if (const std::uint32_t lanes = lanes_of_pack(rays, k); lanes != 0)
            packs.extend(select(lanes_of<float>(lanes), from.origin.pack(k), first));
    return Patch::around(box_of(packs));
}

Boxd range(const BatchVectors& values, int begin, int end) {
    Bounds<FloatPack> packs{values.pack(begin), values.pack(begin)};
    for (int k = begin + 1; k < end; ++k) packs.extend(values.pack(k));
    return box_of(packs);
}

RaySet closest_hits(const Snapshot& scene, const RayBatch& rays, BatchHits& hits, BatchMode& mode,
                    SearchCounts& counts) {
    for (int k = 0; k < rays.packs(); ++k) {
        hits[std::size_t(k)].t = FloatPack(infinity<float>);
        hits[std::size_t(k)].hit = hits[std::size_t(k)].entering = 0;
    }
    for (int k = rays.count; k < rays.packs() * pack_width; ++k)  // out of use: nothing is looked for
        hits[std::size_t(k / pack_width)].t.v[k % pack_width] = 0;
    return search_packs(scene, rays, 0, rays.packs(), hits, mode, counts);
}

RayPack shadow_rays(const ShadowOrigins& from, const Light& light, int pack) {
    return ray_to_light(from.origin.pack(pack), light);
}

RaySet blocked_rays(const Snapshot& scene, const ShadowOrigins& from, const Light& light, RaySet rays, float reach,
                    std::uint32_t& last, SearchCounts& counts) {
    RaySet blocked = 0;
    const auto together = [&](RaySet some) {  // returns those that are open still
        if (std::popcount(some) < fewest) return some;
        ShadowBundle bundle(scene, from, light, some);
        const RaySet found = bundle.search(last, counts);
        blocked |= found;
        return bundle.gave_up() ? some & ~found : RaySet(0);
    };
    while (rays != 0) {
        RaySet near = neighbours(from, rays, reach) | (rays & -rays);
        rays &= ~near;
        near = together(near);
        for (int k = 0; k < batch_packs; ++k) {
            const RaySet pack = near & set_of_pack(0xffu, k);
            RaySet each = pack == near ? pack : together(pack);
            while (each != 0) {
                const int index = take_first(each);
                ++counts.searches;
                if (is_blocked_alone(scene, from, light, index, last)) blocked |= RaySet(1) << index;
            }
        }
    }
    return blocked;
}

}  // namespace raybound
