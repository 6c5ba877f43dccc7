#include "raybound/trace/pack_trials.h"

#include "raybound/shapes/intersect_pack.h"
#include "raybound/shapes/lanes.h"
#include "raybound/trace/local_light.h"
#include "raybound/trace/search.h"

namespace raybound {

namespace {

constexpr std::uint32_t all_lanes = (1u << pack_width) - 1;

Vec3<FloatPack> load(std::span<const Vec3f> v, std::size_t first) {
    return side_by_side<float>([&](int lane) { return v[first + std::size_t(lane)]; });
}

void store(float (&to)[3], const Vec3f& from) {
    for (int i = 0; i < 3; ++i) to[i] = from[i];
}

const Material& material_of(const Snapshot& scene, std::uint32_t primitive) {
    return *scene.objects()[scene.geometry().primitives[primitive].object].material;
}

constexpr Wanted everything{.t_error = true, .uv = true};

void fill(PackHit& record, const SurfacePoint<float>& at) {
    record.t = at.t, record.t_error = at.t_error;
    record.entering = at.entering;
    store(record.point, at.point);
    store(record.point_error, at.point_error);
    store(record.normal, at.shading);
    record.uv[0] = at.uv.u, record.uv[1] = at.uv.v;
    store(record.outer, offset_origin(at.point, at.point_error, at.normal));
    store(record.inner, offset_origin(at.point, at.point_error, -at.normal));
}

// The first crossing by the kernels for one ray, which know nothing of where it comes from.
PackHit single_hit(const Snapshot& scene, const WideRay<float>& ray) {
    const Geometry& geometry = scene.geometry();
    NearestPack nearest{};  // its first lane
    for (std::uint32_t i = 0; i < geometry.primitives.size(); ++i) {
        float entry;
        if (!crosses(geometry.primitives[i].bounds, SlabRay<float>(ray.narrow), nearest.t[0], &entry)) continue;
        const Crossing<double> crossing =
            first_crossing(geometry, geometry.primitives[i], ray, Asking<float>{.t_max = nearest.t[0]});
        consider_one(geometry, i, 0, crossing, entry, infinity<float>, nearest);
    }
    PackHit record{};
    record.t = nearest.t[0];
    if (nearest.hit == 0) return record;
    const Crossing<double> crossing{
        nearest.crossing_t[0], nearest.leaf[0], nearest.face[0], nearest.face_offset[0], true, nearest.entering != 0};
    record.hit = true;
    record.face = crossing.face;
    record.primitive = nearest.primitive[0], record.leaf = crossing.leaf;
    record.crossing_t = crossing.t;
    const auto at = surface_point<float>(geometry, crossing, ray.wide, everything);
    fill(record, at);
    const Material& material = material_of(scene, nearest.primitive[0]);
    const bool around = goes_around(geometry.leaves[crossing.leaf], crossing.face);
    if (material.texture) store(record.diffuse, material.texture->lookup(at.uv, around));
    return record;
}

// The hits of one face, in lanes of their own or, where no ray meets it, of one that does.
void pack_points(const Snapshot& scene, const RayPack& rays, const NearestPack& nearest, std::uint32_t same,
                 PackHit* records) {
    const int first = std::countr_zero(same);
    FaceCrossings crossings{nearest.leaf[first], nearest.face[first], nearest.crossing_t, nearest.entering};
    Ray<DoublePack> wide = rays.wide;
    for_each_lane(all_lanes & ~same, [&](int lane) {
        set_lane(crossings.t, lane, nearest.crossing_t[first]);
        set_lane(wide.origin, lane, lane_of(rays.wide.origin, first));
        set_lane(wide.direction, lane, lane_of(rays.wide.direction, first));
    });
    const SurfacePoint<FloatPack> at = surface_points(scene.geometry(), crossings, wide, everything);
    const Vec3<FloatPack> outer = offset_origin(at.point, at.point_error, at.normal);
    const Vec3<FloatPack> inner = offset_origin(at.point, at.point_error, -at.normal);
    const Material& material = material_of(scene, nearest.primitive[first]);
    const bool around = goes_around(scene.geometry().leaves[crossings.leaf], crossings.face);
    const Vec3<FloatPack> diffuse = material.texture ? material.texture->lookup(at.uv, around) : Vec3<FloatPack>{};
    for_each_lane(same, [&](int lane) {
        PackHit& record = records[lane];
        SurfacePoint<float> one{};
        one.t = at.t[lane], one.t_error = at.t_error[lane];
        one.point = lane_of(at.point, lane), one.point_error = lane_of(at.point_error, lane);
        one.normal = lane_of(at.normal, lane), one.shading = lane_of(at.shading, lane);
        one.uv = {at.uv.u[lane], at.uv.v[lane]};
        one.entering = (bits(at.entering) >> lane & 1) != 0;
        fill(record, one);
        store(record.outer, lane_of(outer, lane));
        store(record.inner, lane_of(inner, lane));
        store(record.diffuse, lane_of(diffuse, lane));
    });
}

void pack_hits(const Snapshot& scene, const RayPack& rays, PackHit* records) {
    NearestPack nearest{};
    for (std::uint32_t i = 0; i < scene.geometry().primitives.size(); ++i)
        consider(scene.geometry(), i, rays, all_lanes, infinity<FloatPack>, nearest);
    for (int lane = 0; lane < pack_width; ++lane) records[lane].t = nearest.t[lane];
    for (std::uint32_t rest = nearest.hit; rest != 0;) {
        const int first = std::countr_zero(rest);
        std::uint32_t same = 0;
        for_each_lane(rest, [&](int lane) {
            if (nearest.primitive[lane] == nearest.primitive[first] && nearest.leaf[lane] == nearest.leaf[first] &&
                nearest.face[lane] == nearest.face[first])
                same |= 1u << lane;
        });
        rest &= ~same;
        pack_points(scene, rays, nearest, same, records);
        for_each_lane(same, [&](int lane) {
            PackHit& record = records[lane];
            record.hit = true;
            record.face = nearest.face[lane];
            record.primitive = nearest.primitive[lane], record.leaf = nearest.leaf[lane];
            record.crossing_t = nearest.crossing_t[lane];
        });
    }
}

bool is_blocked_by(const Geometry& geometry, const Primitive& primitive, const WideRay<float>& ray) {
    const float reach = ray.narrow.has_target ? ray.narrow.t_max * (1 + 0x1p-10f) : infinity<float>;
    float entry;
    return crosses(primitive.bounds, SlabRay<float>(ray.narrow), reach, &entry) && blocks(geometry, primitive, ray);
}

template <class Ray, class V>
Ray make(const V& origin, const V& end, bool direction) {
    return direction ? Ray(origin, end) : Ray::segment(origin, end);
}

PackSecondary secondary_record(const SecondaryRays<float>& rays) {
    PackSecondary record{};
    store(record.reflect, rays.reflect);
    store(record.transmit, rays.transmit);
    if (max_component(rays.reflect) > 0) store(record.reflected, rays.reflected);
    if (max_component(rays.transmit) > 0) store(record.refracted, rays.refracted);
    record.total = rays.total;
    return record;
}

PackLight light_record(const LightTerm<float>& term) {
    PackLight record{};
    store(record.direction, term.direction);
    if (term.faces) store(record.irradiance, term.irradiance);
    if (term.faces && term.shines) store(record.factor, term.factor);
    record.faces = term.faces, record.shines = term.faces && term.shines, record.weighs = term.weighs;
    return record;
}

bool is_set(const PackMask<float>& mask, int lane) { return (bits(mask) >> lane & 1) != 0; }

// The index of refraction around every fourth pair of rays is that of glass.
float outside_of(std::size_t ray) { return ray % pack_width < 2 ? 1.5f : 1.0f; }

void pack_light(const Snapshot& scene, const Material& material, const LitPoint<FloatPack>& at,
                const Vec3<FloatPack>& direction, const PackMask<float>& entering, PackLight* lights,
                PackSecondary* rays) {
    const FloatPack n_dot_v = dot(at.normal, at.view);
    const std::size_t count = scene.lights().size();
    for (std::size_t i = 0; i < count; ++i) {
        const LightTerm<FloatPack> term = light_term(*scene.lights()[i].light, material, at, n_dot_v);
        for (int lane = 0; lane < pack_width; ++lane)
            lights[std::size_t(lane) * count + i] =
                light_record({lane_of(term.direction, lane), lane_of(term.irradiance, lane), lane_of(term.factor, lane),
                              is_set(term.faces, lane), is_set(term.shines, lane), is_set(term.weighs, lane)});
    }
    FloatPack outside;
    for (int lane = 0; lane < pack_width; ++lane) set_lane(outside, lane, outside_of(std::size_t(lane)));
    const SecondaryRays<FloatPack> next = secondary_rays(material, direction, at.normal, entering, outside);
    for (int lane = 0; lane < pack_width; ++lane)
        rays[lane] =
            secondary_record({lane_of(next.reflect, lane), lane_of(next.transmit, lane), lane_of(next.reflected, lane),
                              lane_of(next.refracted, lane), is_set(next.total, lane)});
}

}  // namespace

std::vector<PackHit> trial_hits(const Snapshot& scene, std::span<const Vec3f> origins,
                                std::span<const Vec3f> directions, bool packed) {
    std::vector<PackHit> records(origins.size());
    for (std::size_t i = 0; i + pack_width <= origins.size(); i += pack_width)
        if (packed)
            pack_hits(scene, RayPack(load(origins, i), load(directions, i)), &records[i]);
        else
            for (std::size_t k = i; k < i + pack_width; ++k)
                records[k] = single_hit(scene, WideRay<float>(origins[k], directions[k]));
    return records;
}

std::vector<std::uint8_t> trial_blocked(const Snapshot& scene, std::span<const Vec3f> origins,
                                        std::span<const Vec3f> ends, bool directions, bool packed) {
    const Geometry& geometry = scene.geometry();
    const std::size_t count = geometry.primitives.size();
    std::vector<std::uint8_t> blocked(origins.size() * count);
    for (std::size_t i = 0; i + pack_width <= origins.size(); i += pack_width) {
        const auto rays = make<RayPack>(load(origins, i), load(ends, i), directions);
        for (std::size_t p = 0; p < count; ++p) {
            const std::uint32_t lanes = blocked_lanes(geometry, std::uint32_t(p), rays, all_lanes).blocked;
            for (std::size_t k = 0; k < pack_width; ++k)
                blocked[(i + k) * count + p] =
                    packed ? lanes >> k & 1
                           : is_blocked_by(geometry, geometry.primitives[p],
                                           make<WideRay<float>>(origins[i + k], ends[i + k], directions));
        }
    }
    return blocked;
}

// Every other ray comes from outside.
PackLocalLight trial_light(const Snapshot& scene, std::uint32_t object, std::span<const Vec3f> points,
                           std::span<const Vec3f> normals, std::span<const Vec3f> directions, bool packed) {
    const Material& material = *scene.objects()[object].material;
    const std::size_t count = scene.lights().size();
    PackLocalLight result{std::vector<PackLight>(points.size() * count), std::vector<PackSecondary>(points.size())};
    for (std::size_t i = 0; i + pack_width <= points.size(); i += pack_width) {
        if (packed) {
            const Vec3<FloatPack> direction = load(directions, i);
            const LitPoint<FloatPack> at{load(points, i), load(normals, i), -direction,
                                         Vec3<FloatPack>(material.diffuse)};
            pack_light(scene, material, at, direction, lanes_of<float>(0x55), result.lights.data() + i * count,
                       &result.rays[i]);
            continue;
        }
        for (std::size_t k = i; k < i + pack_width; ++k) {
            const LitPoint<float> at{points[k], normals[k], -directions[k], material.diffuse};
            const float n_dot_v = dot(at.normal, at.view);
            for (std::size_t j = 0; j < count; ++j)
                result.lights[k * count + j] =
                    light_record(light_term(*scene.lights()[j].light, material, at, n_dot_v));
            result.rays[k] =
                secondary_record(secondary_rays<float>(material, directions[k], normals[k], k % 2 == 0, outside_of(k)));
        }
    }
    return result;
}

}  // namespace raybound
