// Searches of a batch for what blocks its rays to a light.
#include <algorithm>
#include <optional>

#include "raybound/certify/batch_search.h"
#include "raybound/shapes/lanes.h"

namespace raybound {

namespace {

constexpr int most_asked_for_shadows =
    16;  // TUNED: primitives that a bundle asks; if there are more, its parts ask fewer

bool is_blocked_alone(const Snapshot& scene, const ShadowOrigins& from, const Light& light, int index,
                      std::uint32_t& last) {
    const WideRay<float> ray = ray_to_light(from.origin[index], light);
    return is_blocked<float>(scene, ray, from.states.from[index], nullptr, Acceleration::bvh, &last);
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
            lanes &= asking_lanes(from_.states, k, primitive);
            if (lanes == 0) continue;
            auto& pack = packs_[std::size_t(k)];
            if (!pack) pack.emplace(shadow_rays(from_, light_, k));
            counts.tests += std::uint64_t(std::popcount(lanes));
            open_ &= ~set_of_pack(blocked_lanes(scene_, from_, *pack, k, primitive, lanes), k);
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

Patch patch_around(const ShadowOrigins& from, RaySet rays) {
    const Vec3<FloatPack> first(from.origin[std::countr_zero(rays)]);
    Bounds<FloatPack> packs{first, first};
    for (int k = 0; k < batch_packs; ++k)
        if (const std::uint32_t lanes = lanes_of_pack(rays, k); lanes != 0)
            packs.extend(select(lanes_of<float>(lanes), from.origin.pack(k), first));
    return Patch::around(box_of(packs));
}

RaySet blocked_from_inside(const Snapshot& scene, const ShadowOrigins& from, const Light& light, RaySet rays) {
    const Geometry& geometry = scene.geometry();
    RaySet blocked = 0;
    for (int k = 0; k < batch_packs; ++k) {
        std::uint32_t lanes = lanes_of_pack(rays, k);
        if (lanes != 0) lanes &= lanes_within(from.states, k);
        if (lanes == 0) continue;
        const RayPack pack = shadow_rays(from, light, k);
        while (lanes != 0) {
            const int first = k * pack_width + std::countr_zero(lanes);
            const std::uint32_t primitive = from.states.within[first];
            const std::uint32_t same = lanes & lanes_with(from.states.within, k, primitive);
            lanes &= ~same;
            std::uint32_t found = 0;
            if (is_convex_solid(geometry, geometry.primitives[primitive]))
                found = lanes_blocked_from_inside(geometry, geometry.primitives[primitive].root, pack, same);
            else
                for_each_lane(same, [&](int lane) {
                    const int i = k * pack_width + lane;
                    found |= std::uint32_t(is_blocked_from_inside(scene, ray_to_light(from.origin[i], light),
                                                                  from.states.from[i]))
                             << lane;
                });
            blocked |= set_of_pack(found, k);
        }
    }
    return blocked;
}

std::uint32_t blocked_lanes(const Snapshot& scene, const ShadowOrigins& from, const RayPack& rays, int pack,
                            std::uint32_t primitive, std::uint32_t lanes) {
    const Geometry& geometry = scene.geometry();
    BlockedLanes found = blocked_lanes(geometry, primitive, rays, lanes);
    if (found.blocked == 0) return 0;
    std::uint32_t doubtful = found.blocked & (found.exits | lanes_with(from.states.left, pack, primitive));
    if (doubtful == 0 || !is_closed(geometry, geometry.primitives[primitive])) return found.blocked;
    for_each_lane(doubtful, [&](int lane) {
        const WideRay<float> ray(lane_of(rays.narrow, lane));
        if (!is_blocked_by(scene, ray, from.states.from[pack * pack_width + lane], primitive))
            found.blocked &= ~(1u << lane);
    });
    return found.blocked;
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
