#include <algorithm>
#include <cstring>

#include "raybound/certify/batch_order.h"
#include "raybound/certify/exact_level.h"

namespace raybound {

namespace {

using Ints = PackVector<std::int32_t>;
template <class S>
std::uint32_t equal_lanes(const S (&values)[pack_width], S value) {
    Ints all;
    std::memcpy(&all, values, sizeof all);
    return bits(PackMask<float>{all == std::int32_t(value)});
}

// The lanes of a pack that hit the face.
template <class Face>
std::uint32_t same_face(const NearestPack& hits, const Face& face) {
    return equal_lanes(hits.primitive, face.primitive) & equal_lanes(hits.leaf, face.leaf) &
           equal_lanes(hits.face, face.face) & equal_lanes(hits.face_offset, face.face_offset) &
           (face.entering ? hits.entering : ~hits.entering);
}

}  // namespace

ExactTracer::ExactTracer(const Snapshot& scene, Cells& cells, const ExactSettings& settings)
    : scene_(scene), cells_(cells), settings_(settings), last_blockers_(scene.lights().size(), Departure::none) {}
ExactTracer::ExactTracer(ExactTracer&&) noexcept = default;
ExactTracer::~ExactTracer() = default;

ExactTracer::Level& ExactTracer::level_at(int depth) {
    if (levels_.size() < std::size_t(depth)) {
        levels_.push_back(std::make_unique<Level>());
        levels_.back()->lights.resize(scene_.lights().size());
    }
    return *levels_[std::size_t(depth) - 1];
}

void ExactTracer::begin_tile() {
    ++tile_;
    eye_mode_ = {};
    std::ranges::fill(last_blockers_, Departure::none);
}

void ExactTracer::trace_eye(const RayBatch& rays, const ImageBlocks::Kept& kept, BatchRadiance& out) {
    changes_ = kept.changes;
    written_.clear();
    trace(rays, 1, &RayCounts::eye, kept.words, out);
}

void ExactTracer::trace(const RayBatch& rays, int depth, std::uint64_t RayCounts::* kind, const std::uint64_t* kept,
                        BatchRadiance& out) {
    if (settings_.cancelled && settings_.cancelled->load(std::memory_order_relaxed)) return;
    Level& level = level_at(depth);
    for (Level::LightValue& light : level.lights) light.forget();
    ++batch_;
    level.kept = kept && recall(rays, kept, level) ? kept : nullptr;
    if (!level.kept) search(rays, depth, kind, level);
    for (int i = 0; i < rays.count; ++i) out.searched[i] = level.alone >> i & 1 ? Searched::eye : Searched::no;
    for (RaySet missed = rays.all() & ~level.hit; missed != 0;) {
        const int i = take_first(missed);
        out.t[i] = infinity<float>;
        out.object[i] = -1;
        out.radiance.set(i, scene_.background());
    }
    for (Face& face : level.faces) meet_face(rays, level, face);

    level.visit_materials([&](const Material& material, RaySet hits) { weigh_lights(level, material, hits); });
    if (level.kept) recall_lights(level);
    for (std::size_t light = 0; light < level.lights.size(); ++light) settle_shadows(level, light, out);
    write(level);
    if (level.hit == 0) return;

    for (int k = 0; k < rays.packs(); ++k) {
        Vec3<FloatPack> sum = saturate(Vec3<FloatPack>(scene_.ambient()) * level.diffuse.pack(k));
        for (const Level::LightValue& light : level.lights)
            if (const std::uint32_t lanes = lanes_of_pack(light.rays, k); lanes != 0)
                sum = select(lanes_of<float>(lanes), saturate(sum + light.value.pack(k)), sum);
        level.sum.set_pack(k, sum);
    }
    for (RaySet rest = level.hit; rest != 0;) {
        const int i = take_first(rest);
        out.t[i] = level.t[i];
        out.object[i] = level.faces[level.face_of[i]].object;
    }
    if (depth < settings_.max_depth) add_secondary(level, depth, out);
    for (RaySet rest = level.hit; rest != 0;) {
        const int i = take_first(rest);
        out.radiance.set(i, level.sum[i]);
    }
}

void ExactTracer::search(const RayBatch& rays, int depth, std::uint64_t RayCounts::* kind, Level& level) {
    SearchCounts counts;
    BatchMode one_off;
    level.alone = closest_hits(scene_, rays, level.hits, depth == 1 ? eye_mode_ : one_off, counts);
    counts_.rays.*kind += counts.searches;
    counts_.tests += counts.tests;
    find_faces(rays, level);
}

void ExactTracer::find_faces(const RayBatch& rays, Level& level) {
    level.faces.clear();
    level.hit = 0;
    for (int k = 0; k < rays.packs(); ++k) level.hit |= set_of_pack(level.hits[std::size_t(k)].hit, k);
    level.hit &= rays.all();
    level.until = farthest(std::span(level.hits).first(std::size_t(rays.packs())));
    for (RaySet open = level.hit; open != 0;) {
        const int first = std::countr_zero(open);
        const NearestPack& pack = level.hits[std::size_t(first / pack_width)];
        const int at = first % pack_width;
        Face face;
        face.primitive = pack.primitive[at];
        face.leaf = pack.leaf[at];
        face.face = pack.face[at];
        face.face_offset = pack.face_offset[at];
        face.entering = pack.entering >> at & 1;
        for (int k = first / pack_width; k < rays.packs(); ++k)
            face.rays |= set_of_pack(lanes_of_pack(open, k) & same_face(level.hits[std::size_t(k)], face), k);
        open &= ~face.rays;
        complete(face);
        level.add(face);
    }
}

// What the scene says of a face.
void ExactTracer::complete(Face& face) const {
    const Geometry& geometry = scene_.geometry();
    const ObjectRecord& object = scene_.objects()[geometry.primitives[face.primitive].object];
    face.object = object.id;
    face.material = object.material.get();
    face.outer = departure(geometry, face.primitive, face.entering).primitive;
    face.inner = departure(geometry, face.primitive, !face.entering).primitive;
}

void ExactTracer::meet_face(const RayBatch& rays, Level& level, Face& face) {
    const Order order(face.rays);
    level.entering &= ~face.rays;
    for (int k = 0; k < order.packs(); ++k) meet_pack(rays, level, face, order.pack(k), order.lanes(k));
}

void ExactTracer::meet_pack(const RayBatch& rays, Level& level, const Face& face, const std::uint8_t* index,
                            int count) {
    const Material& material = *face.material;
    const RayPack ray(gather(rays.origin, index), gather(rays.direction, index));
    FaceCrossings crossings{face.leaf, face.face, {}, face.entering ? 0xffu : 0u};
    if (is_pack(index))
        crossings.t = level.hits[std::size_t(index[0] / pack_width)].crossing_t;
    else
        for (int lane = 0; lane < pack_width; ++lane)
            crossings.t.v[lane] =
                level.hits[std::size_t(index[lane] / pack_width)].crossing_t.v[index[lane] % pack_width];
    const SurfacePoint<FloatPack> hit =
        surface_points(scene_.geometry(), crossings, ray.wide, {.t_error = false, .uv = material.texture != nullptr});
    const Vec3<FloatPack> side = select(hit.entering, hit.normal, -hit.normal);
    level.entering |= scatter(bits(hit.entering), index, count);
    scatter(hit.t, index, count, level.t);
    scatter(gather(rays.travelled, index) + hit.t, index, count, level.way);
    scatter(hit.point, index, count, level.point);
    scatter(hit.normal, index, count, level.normal);
    scatter(side, index, count, level.side);
    scatter(select(hit.entering, hit.shading, -hit.shading), index, count, level.shading);
    scatter(-ray.narrow.direction, index, count, level.view);
    scatter(offset_origin(hit.point, hit.point_error, side), index, count, level.outside.origin);
    scatter(material.texture ? material.texture->lookup(hit.uv) : Vec3<FloatPack>(material.diffuse), index, count,
            level.diffuse);
    if (material.transmit != Vec3f{}) scatter(hit.point_error, index, count, level.point_error);
    for (int lane = 0; lane < count; ++lane) level.outside.departed[index[lane]] = face.outer;
}

void ExactTracer::weigh_lights(Level& level, const Material& material, RaySet rays) {
    const Order order(rays);
    for (int k = 0; k < order.packs(); ++k) {
        const std::uint8_t* index = order.pack(k);
        const LitPoint<FloatPack> at{gather(level.point, index), gather(level.shading, index),
                                     gather(level.view, index), gather(level.diffuse, index)};
        const FloatPack n_dot_v = dot(at.normal, at.view);
        for (std::size_t i = 0; i < level.lights.size(); ++i) {
            const LightTerm<FloatPack> term = light_term(*scene_.lights()[i].light, material, at, n_dot_v);
            const std::uint32_t weighs = bits(term.weighs);
            if (weighs == 0) continue;  // behind, or out of reach
            level.lights[i].rays |= scatter(weighs, index, order.lanes(k));
            scatter(term.irradiance * term.factor, index, order.lanes(k), level.lights[i].value);
        }
    }
}

// The rays that surfaces of one material may send on.
void ExactTracer::spawn(Level& level, const Material& material, RaySet hits) {
    const Order order(hits);
    for (int k = 0; k < order.packs(); ++k) {
        const std::uint8_t* index = order.pack(k);
        const SecondaryRays<FloatPack> next =
            secondary_rays(material, -gather(level.view, index), gather(level.shading, index),
                           lanes_of<float>(gather(level.entering, index)));
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
            next.rays.add(origin, make_ray(origin, next.direction_of_hit[i]).direction, level.way[i],
                          reflected ? face.outer : face.inner);
        }
    }
}

// local + reflect L(R) + transmit L(T), in this order.
void ExactTracer::add_secondary(Level& level, int depth, BatchRadiance& out) {
    level.visit_materials([&](const Material& material, RaySet hits) {
        if (material.reflect != Vec3f{} || material.transmit != Vec3f{}) spawn(level, material, hits);
    });
    for (const bool reflected : {true, false}) {
        Level::Spawned& next = reflected ? level.reflected : level.refracted;
        collect(level, reflected);
        if (next.rays.count == 0) continue;
        next.rays.pad();
        write_tree(level, reflected);
        trace(next.rays, depth + 1, reflected ? &RayCounts::reflected : &RayCounts::refracted,
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
