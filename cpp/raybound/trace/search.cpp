#include "raybound/trace/search.h"

#ifdef RAYBOUND_COUNTED  // by search_counted.cpp
#define RAYBOUND_OBSERVER Counted
#else
#define RAYBOUND_OBSERVER Unseen
#endif

namespace raybound {

namespace {

// Takes the primitive's crossing if it comes first. A crossing cannot lie before the entry into the primitive's box:
// the clamp makes that true of rounded numbers too, so that a traversal ordered by entries misses nothing.
// (Not inlined, so that traversals stay small.)
template <class T, class Observer>
[[gnu::noinline]] void consider(const Geometry& geometry, std::uint32_t index, const WideRay<T>& ray, T entry,
                                bool filtered, bool brute_force, Nearest<T>& best, Observer observer) {
    observer.primitive();
    const Crossing<Wide<T>> crossing =
        first_crossing(geometry, geometry.primitives[index], ray, Asking<T>{filtered, brute_force, best.t}, observer);
    if (!crossing.hit) return;
    const auto ranked = [&](std::uint32_t primitive, const Crossing<Wide<T>>& c) {
        return rank(geometry, primitive, c.face_offset + c.face);
    };
    const T t = maximum(T(crossing.t), entry);
    if (!(t < infinity<T>) || t > best.t) return;
    if (best.hit && t == best.t && !(ranked(index, crossing) < ranked(best.primitive, best.crossing))) return;
    best.crossing = crossing;
    best.t = t;
    best.primitive = index;
    best.hit = true;
}

// The brute-force loop over everything whose box is crossed: what the BVH must agree with.
template <class T, class Visit>
bool visit_all(const Geometry& geometry, const Ray<T>& ray, const T& t_max, const Visit& visit) {
    const SlabRay<T> slabs(ray);
    for (std::uint32_t i = 0; i < geometry.primitives.size(); ++i) {
        T entry;
        if (crosses(geometry.primitives[i].bounds, slabs, t_max, &entry) && visit(i, entry, false)) return true;
    }
    return false;
}

}  // namespace

template <class T, class Observer>
Nearest<T> closest_hit(const Snapshot& scene, const WideRay<T>& ray, Departure departed, Acceleration acceleration,
                       const Bvh::Frontier* from, Observer observer) {
    const Geometry& geometry = scene.geometry();
    const bool brute_force = acceleration == Acceleration::brute_force;
    Nearest<T> best;
    const auto visit = [&](std::uint32_t index, T entry, bool filtered) {
        if (index != departed.primitive) consider(geometry, index, ray, entry, filtered, brute_force, best, observer);
        return false;
    };
    if (!brute_force)
        scene.accelerator().traverse(geometry, ray.narrow, best.t, observed(visit, observer), from);
    else
        visit_all(geometry, ray.narrow, best.t, visit);
    return best;
}

template <class T, class Observer>
bool is_blocked(const Snapshot& scene, const WideRay<T>& ray, Departure departed, std::int32_t* blocker,
                Acceleration acceleration, std::uint32_t* last, Observer observer) {
    const Geometry& geometry = scene.geometry();
    const bool brute_force = acceleration == Acceleration::brute_force;
    const T reach = ray.narrow.has_target ? ray.narrow.t_max * T(1 + 0x1p-10) : infinity<T>;
    const auto visit = [&](std::uint32_t index, T, bool filtered) {
        if (index == departed.primitive) return false;
        observer.primitive();
        const Primitive& primitive = geometry.primitives[index];
        if (!blocks(geometry, primitive, ray, Asking<T>{filtered, brute_force}, observer)) return false;
        if (blocker) *blocker = scene.objects()[primitive.object].id;
        if (last && *last != index) *last = index;  // (other threads may share the cache line)
        return true;
    };
    if (last && *last != Departure::none) {
        T entry;
        if (crosses(geometry.primitives[*last].bounds, SlabRay<T>(ray.narrow), reach, &entry) &&
            visit(*last, entry, false))
            return true;
    }
    if (!brute_force) return scene.accelerator().any(geometry, ray.narrow, reach, observed(visit, observer));
    return visit_all(geometry, ray.narrow, reach, visit);
}

template Nearest<float> closest_hit(const Snapshot&, const WideRay<float>&, Departure, Acceleration,
                                    const Bvh::Frontier*, RAYBOUND_OBSERVER);
template Nearest<double> closest_hit(const Snapshot&, const WideRay<double>&, Departure, Acceleration,
                                     const Bvh::Frontier*, RAYBOUND_OBSERVER);
template bool is_blocked(const Snapshot&, const WideRay<float>&, Departure, std::int32_t*, Acceleration, std::uint32_t*,
                         RAYBOUND_OBSERVER);
template bool is_blocked(const Snapshot&, const WideRay<double>&, Departure, std::int32_t*, Acceleration,
                         std::uint32_t*, RAYBOUND_OBSERVER);

}  // namespace raybound
