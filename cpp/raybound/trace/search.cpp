#include "raybound/trace/search.h"

#include <tuple>

namespace raybound {

namespace {

template <class T>
std::tuple<T, std::uint32_t, std::int32_t> rank(const Nearest<T>& hit, const Geometry& geometry) {
    return {hit.t, geometry.primitives[hit.primitive].object, hit.crossing.face_offset + hit.crossing.face};
}

// Takes the primitive's crossing if it comes first. A crossing cannot lie before the entry into the primitive's box:
// the clamp makes that true of rounded numbers too, so that a traversal ordered by entries misses nothing.
template <class T>
void consider(const Geometry& geometry, std::uint32_t index, const WideRay<T>& ray, T entry, Nearest<T>& best) {
    const Crossing<Wide<T>> crossing = first_crossing(geometry, geometry.primitives[index], ray);
    if (!crossing.hit) return;
    const Nearest<T> found{crossing, maximum(T(crossing.t), entry), index, true};
    if (!(found.t < infinity<T>)) return;
    if (!best.hit || rank(found, geometry) < rank(best, geometry)) best = found;
}

// The brute-force loop over everything whose box is crossed: what the BVH must agree with.
template <class T, class Visit>
void visit_all(const Snapshot& scene, const Ray<T>& ray, T t_max, const Visit& visit) {
    const auto& primitives = scene.geometry().primitives;
    for (std::uint32_t i = 0; i < primitives.size(); ++i) {
        T entry;
        if (crosses(primitives[i].bounds, ray, t_max, &entry) && visit(i, entry, t_max)) return;
    }
}

template <class T, class Visit>
void visit_crossed(const Snapshot& scene, const Ray<T>& ray, T t_max, Acceleration acceleration, const Visit& visit) {
    if (acceleration == Acceleration::bvh)
        scene.bvh().traverse(ray, t_max, visit);
    else
        visit_all(scene, ray, t_max, visit);
}

}  // namespace

template <class T>
Nearest<T> closest_hit(const Snapshot& scene, const Ray<T>& ray, Acceleration acceleration) {
    const Geometry& geometry = scene.geometry();
    const WideRay<T> wide(ray);
    Nearest<T> best;
    visit_crossed(scene, ray, infinity<T>, acceleration, [&](std::uint32_t index, T entry, T& t_max) {
        consider(geometry, index, wide, entry, best);
        t_max = best.t;
        return false;
    });
    return best;
}

template <class T>
bool is_blocked(const Snapshot& scene, const Ray<T>& ray, std::int32_t* blocker, Acceleration acceleration) {
    const Geometry& geometry = scene.geometry();
    const WideRay<T> wide(ray);
    bool blocked = false;
    const T reach = ray.has_target ? ray.t_max * T(1 + 0x1p-10) : infinity<T>;
    visit_crossed(scene, ray, reach, acceleration, [&](std::uint32_t index, T, T&) {
        const Primitive& primitive = geometry.primitives[index];
        blocked = blocks(geometry, primitive, wide);
        if (blocked && blocker) *blocker = scene.objects()[primitive.object].id;
        return blocked;
    });
    return blocked;
}

template Nearest<float> closest_hit(const Snapshot&, const Ray<float>&, Acceleration);
template Nearest<double> closest_hit(const Snapshot&, const Ray<double>&, Acceleration);
template bool is_blocked(const Snapshot&, const Ray<float>&, std::int32_t*, Acceleration);
template bool is_blocked(const Snapshot&, const Ray<double>&, std::int32_t*, Acceleration);

}  // namespace raybound
