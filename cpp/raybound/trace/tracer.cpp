#include "raybound/trace/tracer.h"

#include "raybound/trace/local_light.h"

namespace raybound {

// A hit, ready for light and for the rays it sends on.
template <class T>
struct Tracer<T>::Shadable {
    const SurfacePoint<T>& hit;
    const Material& material;
    Vec3<T> side;    // the surface's own normal, turned toward the viewer
    Vec3<T> origin;  // of rays that leave on that side, outside the error box of the hit
    LitPoint<T> lit;
    Departures leaving;
    T outside_ior;
};

template <class T>
EyeSample<T> Tracer<T>::sample(const Vec3<T>& origin, const Vec3<T>& direction, const Departure& eye,
                               const Bvh::Frontier* from) {
    EyeSample<T> first{{}, infinity<T>, -1};
    ++counts_.eye;
    first.radiance = radiance(WideRay<T>(origin, direction), eye, 1, NoRecord{}, &first, from);
    return first;
}

template <class T>
RayTreeNode Tracer<T>::ray_tree(const Vec3<T>& origin, const Vec3<T>& direction, const Departure& eye) {
    RayTreeNode root;
    ++counts_.eye;
    radiance(WideRay<T>(origin, direction), eye, 1, RecordTree{&root}, nullptr);
    return root;
}

template <class T>
template <class Record>
Vec3<T> Tracer<T>::radiance(const WideRay<T>& ray, const Departure& departed, int depth, Record record,
                            EyeSample<T>* first, const Bvh::Frontier* from) {
    if (settings_.cancelled && settings_.cancelled->load(std::memory_order_relaxed)) return {};
    const Nearest<T> nearest = closest_hit(scene_, ray, departed, settings_.acceleration, from);
    Vec3<T> value(scene_.background());
    T t = infinity<T>;
    if (nearest.hit) value = shade(ray, nearest, depth, record, &t);
    const std::int32_t object =
        nearest.hit ? scene_.objects()[scene_.geometry().primitives[nearest.primitive].object].id : -1;
    if (first) first->t = t, first->object = object;
    if constexpr (Record::active) {
        record.node->origin = Vec3d(ray.narrow.origin);
        record.node->direction = Vec3d(ray.narrow.direction);
        record.node->hit = nearest.hit;
        record.node->t = double(t);
        record.node->object = object;
        record.node->radiance = Vec3d(value);
    }
    return value;
}

template <class T>
template <class Record>
Vec3<T> Tracer<T>::shade(const WideRay<T>& wide, const Nearest<T>& nearest, int depth, Record record, T* t) {
    const Geometry& geometry = scene_.geometry();
    const Ray<T>& ray = wide.narrow;
    const Material& material = *scene_.objects()[geometry.primitives[nearest.primitive].object].material;
    const SurfacePoint<T> hit =
        surface_point<T>(geometry, nearest.crossing, wide.wide, {.t_error = false, .uv = material.texture != nullptr});
    const Vec3<T> side = hit.entering ? hit.normal : -hit.normal;
    const bool around = goes_around(geometry.leaves[nearest.crossing.leaf], nearest.crossing.face);
    const Vec3<T> diffuse = material.texture ? material.texture->lookup(hit.uv, around) : Vec3<T>(material.diffuse);
    const Shadable at{hit,
                      material,
                      side,
                      offset_origin(hit.point, hit.point_error, side),
                      {hit.point, hit.entering ? hit.shading : -hit.shading, -ray.direction, diffuse},
                      departures(geometry, nearest),
                      outside_ior(scene_, nearest)};
    *t = hit.t;
    if constexpr (Record::active) {
        record.node->point = Vec3d(hit.point);
        record.node->normal = Vec3d(hit.shading);
        record.node->face = nearest.crossing.face_offset + nearest.crossing.face;
    }
    const Vec3<T> local = direct_light(at, record);
    return depth < settings_.max_depth ? add_secondary(local, ray, at, depth, record) : local;
}

template <class T>
template <class Record>
Vec3<T> Tracer<T>::direct_light(const Shadable& at, Record record) {
    const T n_dot_v = dot(at.lit.normal, at.lit.view);
    Vec3<T> sum = saturate(Vec3<T>(scene_.ambient()) * at.lit.diffuse);
    for (std::size_t i = 0; i < scene_.lights().size(); ++i) {
        const LightRecord& entry = scene_.lights()[i];
        const Light& light = *entry.light;
        const LightTerm<T> term = light_term(light, at.material, at.lit, n_dot_v);
        LightVerdict verdict = !term.faces ? LightVerdict::behind : LightVerdict::outside_cone;
        std::int32_t blocker = -1;
        if (Record::active ? term.faces && term.shines : term.weighs) {  // rays of weight zero are not traced
            const bool lit = is_lit(at, i, Record::active ? &blocker : nullptr);
            if (lit) sum = saturate(sum + term.irradiance * term.factor);
            verdict = lit ? LightVerdict::lit : LightVerdict::blocked;
        }
        if constexpr (Record::active) record.node->lights.push_back({entry.id, verdict, blocker});
    }
    return sum;
}

template <class T>
bool Tracer<T>::is_lit(const Shadable& at, std::size_t index, std::int32_t* blocker) {
    ++counts_.shadow;
    const WideRay<T> ray = ray_to_light(at.origin, *scene_.lights()[index].light);
    return !is_blocked(scene_, ray, at.leaving.outer, blocker, settings_.acceleration,
                       blocker ? nullptr : &last_blockers_[index]);
}

// local + reflect L(R) + transmit L(T), in this order.
template <class T>
template <class Record>
Vec3<T> Tracer<T>::add_secondary(const Vec3<T>& local, const Ray<T>& ray, const Shadable& at, int depth,
                                 Record record) {
    const SecondaryRays<T> rays =
        secondary_rays(at.material, ray.direction, at.lit.normal, at.hit.entering, at.outside_ior);
    if constexpr (Record::active) record.node->total_internal_reflection = rays.total;
    Vec3<T> sum = local;
    if (max_component(rays.reflect) > T(0)) {
        ++counts_.reflected;
        const WideRay<T> next(at.origin, rays.reflected);
        const Vec3<T> seen =
            radiance(next, at.leaving.outer, depth + 1, record.child(RayKind::reflected, rays.reflect), nullptr);
        sum = saturate(sum + rays.reflect * seen);
    }
    if (max_component(rays.transmit) > T(0)) {
        ++counts_.refracted;
        const WideRay<T> next(offset_origin(at.hit.point, at.hit.point_error, -at.side), rays.refracted);
        const Vec3<T> seen =
            radiance(next, at.leaving.inner, depth + 1, record.child(RayKind::refracted, rays.transmit), nullptr);
        sum = saturate(sum + rays.transmit * seen);
    }
    return sum;
}

template class Tracer<float>;
template class Tracer<double>;

}  // namespace raybound
