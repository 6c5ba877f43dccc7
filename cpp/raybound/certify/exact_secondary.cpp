// The rays that a batch's surfaces send on, reflected ones and then refracted ones, each traced as a batch.
#include "raybound/certify/batch_order.h"
#include "raybound/certify/exact_level.h"

namespace raybound {

// The rays that surfaces of one material may send on.
void ExactTracer::spawn(Level& level, const Material& material, RaySet hits) {
    const Order order(hits);
    for (int k = 0; k < order.packs(); ++k) {
        const std::uint8_t* index = order.pack(k);
        const SecondaryRays<FloatPack> next =
            secondary_rays(material, -gather(level.view, index), gather(level.shading, index),
                           lanes_of<float>(gather(level.entering, index)), gather(level.outside_ior, index));
        scatter(next.reflect, index, order.lanes(k), level.reflected.weight_of_hit);
        scatter(next.reflected, index, order.lanes(k), level.reflected.direction_of_hit);
        if (material.transmit == Vec3f{}) continue;
        scatter(next.transmit, index, order.lanes(k), level.refracted.weight_of_hit);
        scatter(next.refracted, index, order.lanes(k), level.refracted.direction_of_hit);
    }
}

// Those that have a weight, face by face: colours change nothing in their order.
void ExactTracer::collect(Level& level, bool reflected) {
    Level::Spawned& next = reflected ? level.reflected : level.refracted;
    next.rays.count = 0;
    for (const Face& face : level.faces) {
        const Material& material = *face.material;
        if (material.transmit == Vec3f{} && (!reflected || material.reflect == Vec3f{})) continue;
        for (RaySet rest = face.rays; rest != 0;) {
            const int i = take_first(rest);
            const Vec3f weight = next.weight_of_hit[i];
            if (!(max_component(weight) > 0)) continue;
            next.parent[next.rays.count] = std::uint8_t(i);
            next.weight.set(next.rays.count, weight);
            const Vec3f origin = reflected ? level.outside.origin[i]
                                           : offset_origin(level.point[i], level.point_error[i], -level.side[i]);
            const Departures leaving = departures_of(level, face, i);
            const Departure& from = reflected ? leaving.outer : leaving.inner;
            next.rays.add(origin, make_ray(origin, next.direction_of_hit[i]).direction, level.way[i], from);
        }
    }
}

// local + reflect L(R) + transmit L(T), in this order.
void ExactTracer::add_secondary(Level& level, BatchRadiance& out) {
    level.visit_materials([&](const Material& material, RaySet hits) {
        if (material.reflect != Vec3f{} || material.transmit != Vec3f{}) spawn(level, material, hits);
    });
    for (const bool reflected : {true, false}) {
        Level::Spawned& next = reflected ? level.reflected : level.refracted;
        collect(level, reflected);
        if (next.rays.count == 0) continue;
        next.rays.pad();
        write_tree(level, reflected);
        trace(next.rays, level.depth + 1, reflected ? &RayCounts::reflected : &RayCounts::refracted,
              kept_tree(level, reflected), level.seen);
        for (int c = 0; c < next.rays.count; ++c) {
            const int i = next.parent[c];
            level.sum.set(i, saturate(level.sum[i] + next.weight[c] * level.seen.radiance[c]));
            const Searched why = level.seen.searched[c];
            const Searched way = reflected ? Searched::reflection : Searched::refraction;
            mark(out.searched[i], why == Searched::eye ? way : why);
        }
    }
}

}  // namespace raybound
