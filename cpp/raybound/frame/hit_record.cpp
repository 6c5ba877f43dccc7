#include "raybound/frame/hit_record.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "raybound/shapes/closest.h"
#include "raybound/shapes/hit_point.h"

namespace raybound {

namespace {

template <class T>
void store(const Vec3<T>& v, float (&out)[3]) {
    for (int i = 0; i < 3; ++i) out[i] = float(v[i]);
}
Vec3f load(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

// FNV-1a over the bytes of all fields but the seal. (Copies need not keep the padding.)
std::uint32_t seal_of(const HitRecord& r) {
    std::uint32_t hash = 0x811c9dc5u;
    const auto add = [&hash](const auto& field) {
        unsigned char bytes[sizeof field];
        std::memcpy(bytes, &field, sizeof field);
        for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x01000193u;
    };
    add(std::uint8_t(r.hit)), add(r.t), add(r.t_error), add(r.point), add(r.point_error), add(r.normal), add(r.uv);
    add(r.object_id), add(r.face_id), add(std::uint8_t(r.entering)), add(r.within_id), add(std::uint8_t(r.touching));
    add(r.direction);
    return hash;
}

// The object's place among the scene's, which is its primitive's too.
std::uint32_t index_of(const Snapshot& scene, std::int32_t id) {
    const auto& objects = scene.objects();
    const auto found = std::ranges::lower_bound(objects, id, {}, &ObjectRecord::id);
    if (found == objects.end() || found->id != id) return Departure::none;
    return std::uint32_t(found - objects.begin());
}

std::int32_t id_of(const Snapshot& scene, std::uint32_t primitive) {
    if (primitive == Departure::none) return -1;
    return scene.objects()[scene.geometry().primitives[primitive].object].id;
}

// t in units of the direction as it was given. Where that is beyond float (origins beyond 2^60), t is the largest float
// and nothing bounds its error.
void store_t(HitRecord& record, const SurfacePoint<float>& at, float scale) {
    record.t = minimum(at.t / scale, std::numeric_limits<float>::max());
    record.t_error = at.t / scale > record.t ? infinity<float>
                     : scale == 1            ? at.t_error
                                             : next_float_up(at.t_error / scale);
}

// A solid's normal, on the side where the ray must see it: where it is all but across the ray, rounding may have turned
// it over.
Vec3d seen_normal(const Vec3d& normal, const Vec3d& direction, bool entering) {
    const double along = dot(normal, direction), sign = entering ? -1 : 1;
    if (along * sign > 0) return normal;
    const double squared = dot(direction, direction), least = 0x1p-20 * sqrt(squared);
    return normalize(normal + direction * ((sign * least - along) / squared));
}

// A face that a record names.
struct RecordedFace {
    std::uint32_t leaf;
    std::int32_t face;
    Vec3d normal;  // outward
    Surface<double> surface;
};

RecordedFace face_of(const Geometry& geometry, std::uint32_t primitive, const HitRecord& record) {
    const LeafFace at = leaf_of_face(geometry, geometry.primitives[primitive], record.face_id);
    const Leaf& leaf = geometry.leaves[at.leaf];
    const Vec3d p(load(record.point));
    RecordedFace found{at.leaf, record.face_id - at.face_offset, {}, {}};
    found.surface = leaf_surface(geometry, leaf, found.face, p, Vec3d{0, 0, 1});
    const Vec3d normal = unit_normal(geometry, leaf, found.surface, Vec3d{0, 0, 1});
    found.normal = leaf.is_complement ? -normal : normal;
    return found;
}

class Refusal {
  public:
    Refusal(const std::string& who, std::size_t index)
        : head_(who + ": origins must be hits of this scene as intersect returned them, record " +
                std::to_string(index) + " ") {}
    [[noreturn]] void because(const std::string& why) const { throw std::invalid_argument(head_ + why); }

  private:
    std::string head_;
};

void check(const Snapshot& scene, const HitRecord& record, const Refusal& refusal) {
    if (seal_of(record) != record.seal) refusal.because("has been changed");
    if (!record.hit) return;
    const std::uint32_t index = index_of(scene, record.object_id);
    if (index == Departure::none)
        refusal.because("has object_id " + std::to_string(record.object_id) + ", which is none of its objects");
    const int faces = scene.objects()[index].shape->face_count();
    const std::string face =
        "face " + std::to_string(record.face_id) + " of object " + std::to_string(record.object_id);
    if (record.face_id < 0 || record.face_id >= faces)
        refusal.because("names " + face + ", which has " + std::to_string(faces));
    const Geometry& geometry = scene.geometry();
    const double allowed = 4 * length(Vec3d(load(record.point_error))) +
                           0x1p-20 * max_component(absolute(Vec3d(load(record.point)))) +
                           0x1p-30 * max_component(Vec3d(geometry.primitives[index].bounds.extent()));
    const RecordedFace at = face_of(geometry, index, record);
    const double slope = length(at.surface.gradient), form = abs(at.surface.form.value) - at.surface.form.band;
    const double bend = largest_curvature<double>(geometry, geometry.leaves[at.leaf], at.face);
    if (!(form <= (slope + bend * allowed) * allowed)) refusal.because("lies " + format(form / slope) + " off " + face);
}

}  // namespace

HitRecord missed_record() {
    HitRecord record;
    std::memset(static_cast<void*>(&record), 0, sizeof record);
    record.t = infinity<float>;
    record.object_id = record.face_id = record.within_id = -1;
    record.seal = seal_of(record);
    return record;
}

HitRecord hit_record(const Snapshot& scene, const Nearest<float>& nearest, const WideRay<float>& ray, float scale) {
    const Geometry& geometry = scene.geometry();
    const SurfacePoint<float> at = surface_point<float>(geometry, nearest.crossing, ray.wide, {true, true});
    const Vec3f& direction = ray.narrow.direction;
    const bool turned_by_ray = at.shading == at.normal && is_closed(geometry, geometry.primitives[nearest.primitive]);
    HitRecord record = missed_record();
    record.hit = true;
    store_t(record, at, scale);
    store(at.point, record.point);
    store(at.point_error, record.point_error);
    store(turned_by_ray ? seen_normal(Vec3d(at.normal), Vec3d(direction), at.entering) : Vec3d(at.shading),
          record.normal);
    store(direction, record.direction);
    record.uv[0] = at.uv.u;
    record.uv[1] = at.uv.v;
    record.object_id = id_of(scene, nearest.primitive);
    record.face_id = nearest.crossing.face_offset + nearest.crossing.face;
    record.entering = at.entering;
    record.within_id = id_of(scene, nearest.within);
    record.touching = nearest.touching;
    record.seal = seal_of(record);
    return record;
}

RayOrigins::RayOrigins(const Snapshot& scene, std::span<const HitRecord> hits, const std::string& who)
    : scene_(scene), hits_(hits) {
    for (std::size_t i = 0; i < hits.size(); ++i) check(scene, hits[i], {who, i});
}

RayStart RayOrigins::toward(std::size_t index, const Vec3f& target) const {
    if (hits_.empty()) return along(index, target);
    return leave(hits_[index], Vec3d(target) - Vec3d(load(hits_[index].point)));
}

RayStart RayOrigins::along(std::size_t index, const Vec3f& direction) const {
    if (hits_.empty()) return {points_[index], departure_at(scene_, points_[index])};
    return leave(hits_[index], Vec3d(direction));
}

RayStart RayOrigins::leave(const HitRecord& hit, const Vec3d& direction) const {
    if (!hit.hit) return {{}, {}, false};
    const Geometry& geometry = scene_.geometry();
    Nearest<float> nearest;
    nearest.primitive = index_of(scene_, hit.object_id);
    const RecordedFace face = face_of(geometry, nearest.primitive, hit);
    nearest.crossing.leaf = face.leaf;
    nearest.crossing.face = face.face;
    nearest.crossing.entering = hit.entering;
    nearest.crossing.t = hit.t;
    nearest.within = hit.within_id < 0 ? Departure::none : index_of(scene_, hit.within_id);
    nearest.touching = hit.touching && nearest.within != Departure::none;
    const bool closed = is_closed(geometry, geometry.primitives[nearest.primitive]);
    const Vec3d normal = closed ? seen_normal(face.normal, Vec3d(load(hit.direction)), hit.entering) : face.normal;
    const bool outward = dot(direction, normal) >= 0;
    const Vec3f side(outward ? normal : -normal);
    const Departures leaving = departures(geometry, nearest);
    return {offset_origin(load(hit.point), load(hit.point_error), side),
            outward == hit.entering ? leaving.outer : leaving.inner};
}

}  // namespace raybound
