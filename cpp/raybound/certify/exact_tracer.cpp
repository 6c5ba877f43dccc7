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
        levels_.back()->depth = depth;
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
    eye_mode_.packs = true;  // what is hard for one block is not for its whole tile
    changes_ = kept.changes;
    written_.clear();
    writes_ = cells_.blocks().is_open();
    trace(rays, 1, &RayCounts::eye, kept.words, out);
}

void ExactTracer::trace(const RayBatch& rays, int depth, std::uint64_t RayCounts::* kind, const std::uint64_t* kept,
                        BatchRadiance& out) {
    if (settings_.cancelled && settings_.cancelled->load(std::memory_order_relaxed)) return;
    Level& level = level_at(depth);
    for (Level::LightValue& light : level.lights) light.forget();
    ++batch_;
    level.kept = kept && recall(rays, kept, level) ? kept : nullptr;
    if (!level.kept) search(rays, kind, level);
    for (int i = 0; i < rays.count; ++i) out.searched[i] = level.found.alone >> i & 1 ? Searched::eye : Searched::no;
    std::fill_n(out.object, rays.count, -1);
    find_outside(level);
    for (Face& face : level.faces) meet_face(rays, level, face);

    level.visit_materials([&](const Material& material, RaySet hits) { weigh_lights(level, material, hits); });
    if (level.kept) recall_lights(level);
    for (std::size_t light = 0; light < level.lights.size(); ++light) settle_shadows(level, light, out);
    write(level);

    add_lights(level, rays.packs());
    for (const Face& face : level.faces)
        for (RaySet rest = face.rays; rest != 0;) out.object[take_first(rest)] = face.object;
    if (depth < settings_.max_depth) add_secondary(level, out);
    for (int k = 0; k < rays.packs(); ++k) {
        const PackMask<float> hit = lanes_of<float>(lanes_of_pack(level.hit, k));
        store(select(hit, level.t.pack(k), infinity<FloatPack>), out.t.value + k * pack_width);
        out.radiance.set_pack(k, select(hit, level.sum.pack(k), Vec3<FloatPack>(scene_.background())));
    }
}

// What surfaces send toward the viewer by themselves.
void ExactTracer::add_lights(Level& level, int packs) const {
    for (int k = 0; k < packs; ++k) {
        if (lanes_of_pack(level.hit, k) == 0) continue;
        Vec3<FloatPack> sum = saturate(Vec3<FloatPack>(scene_.ambient()) * level.diffuse.pack(k));
        for (const Level::LightValue& light : level.lights)
            if (const std::uint32_t lanes = lanes_of_pack(light.rays, k); lanes != 0)
                sum = select(lanes_of<float>(lanes), saturate(sum + light.value.pack(k)), sum);
        level.sum.set_pack(k, sum);
    }
}

void ExactTracer::search(const RayBatch& rays, std::uint64_t RayCounts::* kind, Level& level) {
    SearchCounts counts;
    BatchMode one_off;
    closest_hits(scene_, rays, level.hits, level.depth == 1 ? eye_mode_ : one_off, counts, level.found);
    counts_.rays.*kind += counts.searches;
    counts_.tests += counts.tests;
    find_faces(rays, level);
}

void ExactTracer::find_faces(const RayBatch& rays, Level& level) {
    level.faces.clear();
    level.hit = 0;
    for (int k = 0; k < rays.packs(); ++k) level.hit |= set_of_pack(level.hits[std::size_t(k)].hit, k);
    level.hit &= rays.all();
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
    const Primitive& primitive = geometry.primitives[face.primitive];
    face.outer = is_left_for_good(geometry, primitive, face.entering) ? face.primitive : Departure::none;
}

Departures ExactTracer::departures_of(const Level& level, const Face& face, int ray) const {
    Nearest<float> nearest;
    nearest.crossing.leaf = face.leaf;
    nearest.crossing.face = face.face;
    nearest.crossing.entering = face.entering;
    nearest.crossing.t = level.hits[std::size_t(ray / pack_width)].crossing_t[ray % pack_width];
    nearest.primitive = face.primitive;
    nearest.within = level.found.within[ray];
    nearest.touching = level.found.touching >> ray & 1;
    return departures(scene_.geometry(), nearest);
}

// The index of refraction around the rays' hits.
void ExactTracer::find_outside(Level& level) const {
    std::fill_n(level.outside_ior.value, batch_size, 1.0f);
    for (RaySet rest = level.found.touching; rest != 0;) {
        const int i = take_first(rest);
        Nearest<float> nearest;
        nearest.within = level.found.within[i];
        nearest.touching = true;
        level.outside_ior[i] = outside_ior(scene_, nearest);
    }
}

void ExactTracer::meet_face(const RayBatch& rays, Level& level, Face& face) {
    const Order order(face.rays);
    level.entering &= ~face.rays;
    std::array<UV<FloatPack>, batch_packs> uv;
    for (int k = 0; k < order.packs(); ++k)
        uv[std::size_t(k)] = meet_pack(rays, level, face, order.pack(k), order.lanes(k));
    const Material& material = *face.material;
    const bool around = goes_around(scene_.geometry().leaves[face.leaf], face.face);
    for (int k = 0; k < order.packs(); ++k)
        scatter(
            material.texture ? material.texture->lookup(uv[std::size_t(k)], around) : Vec3<FloatPack>(material.diffuse),
            order.pack(k), order.lanes(k), level.diffuse);
}

// Where the rays meet the face; returns its (u,v) there.
UV<FloatPack> ExactTracer::meet_pack(const RayBatch& rays, Level& level, const Face& face, const std::uint8_t* index,
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
    if (material.transmit != Vec3f{}) scatter(hit.point_error, index, count, level.point_error);
    for (int lane = 0; lane < count; ++lane) {
        const int i = index[lane];
        level.outside.states.set(i, departures_of(level, face, i).outer);
    }
    if (material.texture)
        material.texture->prefetch(hit.uv, goes_around(scene_.geometry().leaves[face.leaf], face.face));
    return hit.uv;
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

}  // namespace raybound
