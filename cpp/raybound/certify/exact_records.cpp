// How a block's ray trees are written down, and what of them still holds after edits. Rays are the same if they begin
// alike and their kind of surface sends them on alike; what they meet is the same if nothing in their way has changed.
#include <algorithm>

#include "raybound/certify/exact_level.h"

namespace raybound {

namespace {

// The first leaf of a primitive: the numbers of the others count from there, wherever they have come to stand.
std::uint32_t first_leaf(const Geometry& geometry, const Primitive& primitive) {
    if (!primitive.is_csg) return primitive.root;
    const CsgNode* node = &geometry.csg_nodes[primitive.root];
    while (node->kind != CsgKind::leaf) node = &geometry.csg_nodes[geometry.csg_children[node->first]];
    return node->first;
}

// The times of a batch's hits, one after the other.
struct Times {
    double t[batch_size];
    std::size_t count = 0;
};
Times times_of(const BatchHits& hits, RaySet hit) {
    Times times;
    while (hit != 0) {
        const int i = take_first(hit);
        times.t[times.count++] = hits[std::size_t(i / pack_width)].crossing_t.v[i % pack_width];
    }
    return times;
}

}  // namespace

// Fills in what the rays hit, if that is what they hit still.
bool ExactTracer::recall(const RayBatch& rays, const std::uint64_t* kept, Level& level) {
    record::Batch batch;
    const std::uint64_t* at = record::read(kept, &batch, 1);
    if (!changes_.empty()) {
        const RayBundle bundle(range(rays.origin, 0, rays.packs()), range(rays.direction, 0, rays.packs()));
        const float until = batch.until * SweptBox::widening;
        const auto may_meet = [&](const Box& box) {
            float near;
            return bundle.may_meet(box, until, near);
        };
        for (const SceneChange& change : changes_)
            if (SceneChange::any_met(change.arrivals(), may_meet)) return false;
    }
    level.faces.clear();
    level.same_ior = true;
    for (int k = 0; k < batch.faces; ++k) {
        record::Face from;
        at = record::read(at, &from, 1);
        Face face;
        if (!recall_face(from, face)) return false;
        level.same_ior = level.same_ior && from.ior == face.material->ior;
        level.add(face);
    }
    level.hit = batch.hit;
    level.found.alone = batch.alone;
    level.found.until = batch.until;
    for (RaySet rest = level.hit; rest != 0;) {
        const int i = take_first(rest);
        at = record::read(at, &level.hits[std::size_t(i / pack_width)].crossing_t.v[i % pack_width], 1);
    }
    level.kept_lights = at;
    level.kept_batch = batch;
    recall_states(rays, batch.special, level);
    return true;
}

// What rays are within is what they came with, but for special ones, which are asked again. (What they enter may have
// another index of refraction outside.)
void ExactTracer::recall_states(const RayBatch& rays, RaySet special, Level& level) const {
    BatchFindings& found = level.found;
    std::copy_n(rays.states.within, rays.packs() * pack_width, found.within);
    found.touching = found.special = 0;
    if (special != 0) level.same_ior = false;
    while (special != 0) search_alone(scene_, rays, take_first(special), level.hits, found);
}

// False if the primitive has gone.
bool ExactTracer::recall_face(const record::Face& from, Face& to) const {
    const Geometry& geometry = scene_.geometry();
    to.primitive = from.primitive;
    for (const SceneChange& change : changes_) {
        to.primitive = change.new_index[to.primitive];
        if (to.primitive == SceneChange::none) return false;
    }
    to.leaf = first_leaf(geometry, geometry.primitives[to.primitive]) + from.leaf;
    to.face = from.face;
    to.face_offset = from.face_offset;
    to.entering = from.entering != 0;
    to.rays = from.rays;
    complete(to);
    return true;
}

// What is known of lights that stand where they stood and whose shadows nothing has come into or left.
void ExactTracer::recall_lights(Level& level) {
    const std::uint64_t* at = level.kept_lights;
    const auto& places = cells_.blocks().light_places();
    for (int k = 0; k < level.kept_batch.lights; ++k) {
        record::Light light;
        at = record::read(at, &light, 1);
        const std::uint64_t* reasons = at;
        at += std::popcount(light.reasons);
        const auto place = std::ranges::find(places, light.place);
        if (place == places.end()) continue;
        const auto index = std::size_t(place - places.begin());
        if (!changes_.empty()) {
            const Bundle bundle = light_bundle(patch_around(level.outside, light.asked), *scene_.lights()[index].light);
            const auto may_meet = [&](const Box& box) { return bundle.may_meet(box); };
            if (std::ranges::any_of(changes_, [&](const SceneChange& change) {
                    return SceneChange::any_met(change.regions, may_meet);
                }))
                continue;
        }
        level.lights[index].asked = light.asked;
        level.lights[index].blocked = light.blocked;
        for (std::size_t why = 0; why < no_cell_reasons; ++why)
            if (light.reasons >> why & 1) reasons = record::read(reasons, &level.lights[index].without_cells[why], 1);
    }
}

// Writes down what is known of a batch; the trees that it sends on follow.
void ExactTracer::write(Level& level) {
    if (written_.size() > ImageBlocks::most_words) {
        written_.clear();
        writes_ = false;
    }
    if (!writes_) return;
    const Geometry& geometry = scene_.geometry();
    record::Batch batch{0,
                        0,
                        std::uint16_t(level.faces.size()),
                        0,
                        level.found.until,
                        level.hit,
                        level.found.alone,
                        level.found.special};
    for (const Level::LightValue& light : level.lights) batch.lights = std::uint16_t(batch.lights + (light.asked != 0));
    level.written = record::append(written_, &batch, 1);
    for (const Face& face : level.faces) {
        const std::uint32_t leaf = face.leaf - first_leaf(geometry, geometry.primitives[face.primitive]);
        const record::Face to{face.primitive,     leaf,     face.face, face.face_offset, face.entering ? 1u : 0u,
                              face.material->ior, face.rays};
        record::append(written_, &to, 1);
    }
    const Times times = times_of(level.hits, level.hit);
    record::append(written_, times.t, times.count);
    for (std::size_t i = 0; i < level.lights.size(); ++i) {
        const Level::LightValue& light = level.lights[i];
        if (light.asked == 0) continue;
        record::Light to{cells_.blocks().light_places()[i], 0, light.asked, light.blocked};
        for (std::size_t why = 0; why < no_cell_reasons; ++why)
            to.reasons |= (light.without_cells[why] != 0 ? 1u : 0u) << why;
        record::append(written_, &to, 1);
        for (const RaySet set : light.without_cells)
            if (set != 0) record::append(written_, &set, 1);
    }
}

// The next tree belongs to rays of this batch.
void ExactTracer::write_tree(Level& level, bool reflected) {
    if (!writes_) return;
    const Level::Spawned& next = reflected ? level.reflected : level.refracted;
    record::Parents parents{std::uint64_t(next.rays.count), {}};
    std::copy_n(next.parent, next.rays.count, parents.parent);
    const auto offset = std::uint32_t(record::append(written_, &parents, 1) - level.written);
    record::Batch batch;
    record::read(written_.data() + level.written, &batch, 1);
    (reflected ? batch.reflected : batch.refracted) = offset;
    std::memcpy(written_.data() + level.written, &batch, sizeof batch);
}

// What is kept of the rays sent on, if they are the same.
const std::uint64_t* ExactTracer::kept_tree(const Level& level, bool reflected) const {
    if (!level.kept || (!reflected && !level.same_ior)) return nullptr;
    const std::uint32_t offset = reflected ? level.kept_batch.reflected : level.kept_batch.refracted;
    if (offset == 0) return nullptr;
    record::Parents parents;
    const std::uint64_t* tree = record::read(level.kept + offset, &parents, 1);
    const Level::Spawned& next = reflected ? level.reflected : level.refracted;
    const bool same = parents.count == std::uint64_t(next.rays.count) &&
                      std::memcmp(parents.parent, next.parent, std::size_t(next.rays.count)) == 0;
    return same ? tree : nullptr;
}

}  // namespace raybound
