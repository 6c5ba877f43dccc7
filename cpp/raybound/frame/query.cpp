#include "raybound/frame/query.h"

#include <algorithm>
#include <cstring>

#include "raybound/frame/answers.h"
#include "raybound/frame/stopwatch.h"
#include "raybound/frame/user_rays.h"

namespace raybound {

namespace {

template <class T, class S>
void store(const Vec3<T>& v, S (&out)[3]) {
    for (int i = 0; i < 3; ++i) out[i] = S(v[i]);
}

// Records whose bytes are all defined, padding too: equal answers are equal byte for byte.
template <class Record>
std::vector<Record> blank_records(std::size_t count) {
    static_assert(std::is_trivially_copyable_v<Record>);
    std::vector<Record> records(count);
    if (count) std::memset(static_cast<void*>(records.data()), 0, count * sizeof(Record));
    return records;
}

std::int32_t object_id(const Snapshot& scene, const Nearest<float>& nearest) {
    return scene.objects()[scene.geometry().primitives[nearest.primitive].object].id;
}

template <class T>
std::int32_t face_id(const Crossing<T>& crossing) {
    return crossing.face_offset + crossing.face;
}

template <class T>
void fill_record(ShapeHitRecord& record, const Geometry& geometry, const Crossing<Wide<T>>& crossing, const Ray<T>& ray,
                 T scale, Offsets offsets, bool inward) {
    const SurfacePoint<T> at = surface_point<T>(geometry, crossing, widen(ray), {true, true});
    record.hit = true;
    record.t = double(at.t) / double(scale);
    record.t_error = next_float_up(double(at.t_error) / double(scale));
    const bool bounded = offsets == Offsets::bounded;
    const PlainPoint<T> plain = bounded ? PlainPoint<T>{at.point, at.normal} : estimate_point(geometry, crossing, ray);
    const Vec3<T> side = inward ? -plain.normal : plain.normal;
    store(plain.point, record.point);
    store(at.point_error, record.point_error);
    store(at.shading, record.normal);
    record.uv[0] = double(at.uv.u);
    record.uv[1] = double(at.uv.v);
    record.face_id = face_id(crossing);
    store(bounded ? offset_origin(plain.point, at.point_error, side) : epsilon_origin(plain.point, side, offsets),
          record.next_origin);
}

}  // namespace

std::vector<HitRecord> intersect_rays(const Snapshot& scene, const RayOrigins& origins,
                                      std::span<const Vec3f> directions, const Watch& watch) {
    require_directions<float>("Scene.intersect", directions);
    std::vector<HitRecord> records(origins.size(), missed_record());
    answer_all(origins.size(), watch, [&](std::size_t i) {
        float scale;
        const RayStart start = origins.along(i, directions[i]);
        const WideRay<float> ray(user_ray(start.origin, directions[i], scale));
        if (!start.begins) return;
        const Nearest<float> nearest = closest_hit(scene, ray, start.from);
        if (nearest.hit) records[i] = hit_record(scene, nearest, ray, scale);
    });
    return records;
}

std::vector<std::uint8_t> occluded(const Snapshot& scene, const RayOrigins& origins, std::span<const Vec3f> targets,
                                   const Watch& watch) {
    std::vector<std::uint8_t> blocked(origins.size());
    answer_all(origins.size(), watch, [&](std::size_t i) {
        const RayStart start = origins.toward(i, targets[i]);
        if (!start.begins || start.origin == targets[i]) return;
        blocked[i] = is_blocked(scene, WideRay<float>::segment(start.origin, targets[i]), start.from, nullptr);
    });
    return blocked;
}

Containing containing(const Snapshot& scene, std::span<const Vec3f> points, const Watch& watch) {
    std::vector<std::vector<std::int32_t>> found(points.size());
    answer_all(points.size(), watch, [&](std::size_t i) {
        visit_containing(scene, points[i], [&](std::uint32_t primitive) {
            found[i].push_back(scene.objects()[scene.geometry().primitives[primitive].object].id);
        });
        std::ranges::sort(found[i]);
    });
    Containing all;
    all.offsets = append_all(found, all.object_ids);
    return all;
}

std::vector<std::uint8_t> shape_contains(const Shape& shape, std::span<const Vec3d> points, const Watch& watch) {
    Geometry geometry;
    add_primitive(geometry, 0, shape, {});
    const Primitive& primitive = geometry.primitives.front();
    if (!is_closed(geometry, primitive))
        throw std::invalid_argument(
            "contains: the shape must be closed, a disk, polygon or mesh with a border is open");
    std::vector<std::uint8_t> inside(points.size());
    answer_all(points.size(), watch, [&](std::size_t i) { inside[i] = contains(geometry, primitive, points[i]); });
    return inside;
}

ClosestHits closest_hits(const Snapshot& scene, std::span<const Vec3f> origins, std::span<const Vec3f> directions,
                         int threads, const Watch& watch) {
    require_directions<float>("closest_hits", directions);
    const std::size_t count = origins.size();
    ClosestHits hits{std::vector<float>(count, infinity<float>), std::vector<std::int32_t>(count, -1),
                     std::vector<std::int32_t>(count, -1), 0};
    const auto search = [&](std::size_t i) {
        float scale;
        const Nearest<float> nearest = closest_hit(scene, WideRay<float>(user_ray(origins[i], directions[i], scale)));
        if (!nearest.hit) return;
        hits.t[i] = nearest.t / scale;
        hits.object_id[i] = object_id(scene, nearest);
        hits.face_id[i] = face_id(nearest.crossing);
    };
    const Stopwatch stopwatch;
    answer_all(count, watch, search, threads);
    hits.seconds = stopwatch.seconds();
    return hits;
}

PrimaryHits primary_hits(const Snapshot& scene, const Camera& camera, int threads, const Watch& watch) {
    std::atomic<std::uint64_t> hits = 0;
    std::atomic<bool> cancelled = false;
    const Departure eye = departure_at(scene, camera.eye());
    const auto search_row = [&](int y, int) {
        std::uint64_t found = 0;
        for (int x = 0; x < camera.width(); ++x)
            found += closest_hit(scene, WideRay<float>(camera.eye(), camera.direction<float>(x, y)), eye).hit;
        hits += found;
    };
    const Stopwatch stopwatch;
    run_work(camera.height(), threads, cancelled, search_row, watch);
    return {hits, stopwatch.seconds()};
}

template <class T>
std::vector<ShapeHitRecord> intersect_shape(const Shape& shape, std::span<const Vec3d> origins,
                                            std::span<const Vec3d> directions, Offsets offsets, bool inward,
                                            const Watch& watch) {
    require_directions<T>("intersect", directions);
    Geometry geometry;
    add_primitive(geometry, 0, shape, {});
    const Primitive& primitive = geometry.primitives.front();
    auto records = blank_records<ShapeHitRecord>(origins.size());
    answer_all(origins.size(), watch, [&](std::size_t i) {
        records[i].t = infinity<double>;
        records[i].face_id = -1;
        T scale, entry;
        const Ray<T> ray = user_ray(Vec3<T>(origins[i]), Vec3<T>(directions[i]), scale);
        if (!crosses(primitive.bounds, SlabRay<T>(ray), infinity<T>, &entry)) return;
        const Crossing<Wide<T>> crossing = first_crossing(geometry, primitive, WideRay<T>(ray));
        if (crossing.hit && T(crossing.t) < infinity<T>)
            fill_record(records[i], geometry, crossing, ray, scale, offsets, inward);
    });
    return records;
}

template std::vector<ShapeHitRecord> intersect_shape<float>(const Shape&, std::span<const Vec3d>,
                                                            std::span<const Vec3d>, Offsets, bool, const Watch&);
template std::vector<ShapeHitRecord> intersect_shape<double>(const Shape&, std::span<const Vec3d>,
                                                             std::span<const Vec3d>, Offsets, bool, const Watch&);

}  // namespace raybound
