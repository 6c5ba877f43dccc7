#include "raybound/trace/search.h"

#ifdef RAYBOUND_COUNTED  // by search_counted.cpp
#define RAYBOUND_OBSERVER Counted
#else
#define RAYBOUND_OBSERVER Unseen
#endif

namespace raybound {

namespace {

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

// One search for the closest hit.
template <class T, class Observer>
class Search {
  public:
    Search(const Snapshot& scene, const WideRay<T>& ray, const Departure& from, Acceleration acceleration,
           Observer observer)
        : scene_(scene),
          geometry_(scene.geometry()),
          ray_(ray),
          from_(from),
          brute_force_(acceleration == Acceleration::brute_force),
          gone_(from.gone()),
          observer_(observer) {}

    Nearest<T> run(const Bvh::Frontier* frontier) {
        for (;;) {
            look(frontier);
            if (!best_.hit || best_.crossing.entering || best_.primitive == from_.within) break;
            if (!is_closed(geometry_, geometry_.primitives[best_.primitive]) || !look_closer(best_.primitive)) break;
        }
        best_.within = from_.within;
        return best_;
    }

  private:
    // What is beyond the way out of the solid that the ray is within is of no interest, but for what touches it there.
    [[gnu::noinline]] void look(const Bvh::Frontier* frontier) {
        best_ = exit_ = {};
        doubtful_from_ = infinity<T>;
        if (from_.within != Departure::none) leave();
        const auto visit = [&](std::uint32_t index, T entry, bool filtered) {
            if (index != from_.within && index != gone_) consider(index, entry, filtered);
            return false;
        };
        if (!brute_force_)
            scene_.accelerator().traverse(geometry_, ray_.narrow, best_.t, observed(visit, observer_), frontier);
        else
            visit_all(geometry_, ray_.narrow, best_.t, visit);
        if (!best_.hit) best_ = exit_;
    }

    void leave() {
        const Asking<T> asking{false, brute_force_, infinity<T>};
        observer_.primitive();
        exit_.crossing =
            crossing_from_inside(geometry_, geometry_.primitives[from_.within], ray_, from_, asking, observer_);
        exit_.t = T(exit_.crossing.t);
        exit_.primitive = from_.within;
        exit_.hit = exit_.t < infinity<T>;
        if (!exit_.hit) return;
        const T doubt = exit_.t * T(0x1p-16) + norm1(ray_.narrow.origin) * T(0x1p-40);
        best_.t = exit_.t + doubt;
        doubtful_from_ = exit_.t - doubt;
    }

    // A crossing whose kind contradicts what the ray knows. False if it has been looked at already: solids overlap.
    // Then the ray is inside of this one, too, if it is not known to be inside of another.
    bool look_closer(std::uint32_t primitive) {
        if (!is_careful(primitive)) {
            if (careful_count_ == most_careful) return false;
            careful_[careful_count_++] = primitive;
            return true;
        }
        if (from_.within != Departure::none) return false;
        from_.within = primitive;
        return true;
    }
    bool is_careful(std::uint32_t primitive) const {
        for (int i = 0; i < careful_count_; ++i)
            if (careful_[i] == primitive) return true;
        return false;
    }

    Crossing<Wide<T>> crossing_of(std::uint32_t index, bool filtered) const {
        const Primitive& primitive = geometry_.primitives[index];
        const Asking<T> asking{filtered, brute_force_, best_.t};
        const bool left = index == from_.left && is_closed(geometry_, primitive);
        if (left || (careful_count_ != 0 && is_careful(index)))
            return crossing_from_outside(geometry_, primitive, ray_, from_, left, asking, observer_);
        return first_crossing(geometry_, primitive, ray_, asking, observer_);
    }

    Rank rank_of(std::uint32_t primitive, const Crossing<Wide<T>>& c) const {
        return rank(geometry_, primitive, c.face_offset + c.face);
    }

    // Takes the primitive's crossing if it comes first. A crossing cannot lie before the entry into the primitive's
    // box: the clamp makes that true of rounded numbers too, so that a traversal ordered by entries misses nothing.
    void consider(std::uint32_t index, T entry, bool filtered) {
        observer_.primitive();
        const Crossing<Wide<T>> crossing = crossing_of(index, filtered);
        if (!crossing.hit) return;
        const T t = maximum(T(crossing.t), entry);
        if (!(t < infinity<T>) || t > best_.t) return;
        bool touching = false;
        if (t >= doubtful_from_ && !is_before_exit(index, crossing, t, touching)) return;
        if (best_.hit && t == best_.t && !(rank_of(index, crossing) < rank_of(best_.primitive, best_.crossing))) return;
        best_.crossing = crossing;
        best_.t = t;
        best_.primitive = index;
        best_.hit = true;
        best_.touching = touching;
    }

    // About where the ray leaves the solid that it is within: what it enters there comes first; what it leaves, too, is
    // the same solid again.
    bool is_before_exit(std::uint32_t index, const Crossing<Wide<T>>& crossing, T t, bool& touching) const {
        if (is_closed(geometry_, geometry_.primitives[index]) &&
            (t == exit_.t || coincide(geometry_, crossing, exit_.crossing, ray_.wide))) {
            touching = crossing.entering;
            return touching;
        }
        if (t == exit_.t) return rank_of(index, crossing) < rank_of(exit_.primitive, exit_.crossing);
        return t < exit_.t;
    }

    static constexpr int most_careful = 4;

    const Snapshot& scene_;
    const Geometry& geometry_;
    const WideRay<T>& ray_;
    Departure from_;
    bool brute_force_;
    std::uint32_t gone_;
    Nearest<T> best_, exit_;
    T doubtful_from_ = infinity<T>;  // from here on a crossing may be where the ray leaves
    std::uint32_t careful_[most_careful];
    int careful_count_ = 0;
    [[no_unique_address]] Observer observer_;
};

// Is there anything between the ray's origin and its end?
template <class T, class Observer>
class BlockerSearch {
  public:
    BlockerSearch(const Snapshot& scene, const WideRay<T>& ray, const Departure& from, Acceleration acceleration,
                  Observer observer)
        : geometry_(scene.geometry()),
          ray_(ray),
          from_(from),
          brute_force_(acceleration == Acceleration::brute_force),
          gone_(from.gone()),
          observer_(observer) {}

    bool is_within_blocked() const {
        if (from_.within == Departure::none) return false;
        const Primitive& primitive = geometry_.primitives[from_.within];
        observer_.primitive();
        return is_before_end(geometry_,
                             crossing_from_inside(geometry_, primitive, ray_, from_, asking(false), observer_), ray_);
    }

    bool is_blocked_by(std::uint32_t index, bool filtered) const {
        if (index == from_.within || index == gone_) return false;
        observer_.primitive();
        const Primitive& primitive = geometry_.primitives[index];
        const bool left = index == from_.left;
        Blocking how;
        if (!blocks(geometry_, primitive, ray_, asking(filtered), &how, observer_)) return false;
        if (how.entering && !left) return true;
        if (!is_closed(geometry_, primitive) || !(left || may_begin_in(primitive))) return true;
        return is_before_end(
            geometry_, crossing_from_outside(geometry_, primitive, ray_, from_, left, asking(filtered), observer_),
            ray_);
    }

  private:
    Asking<T> asking(bool filtered) const { return {filtered, brute_force_, infinity<T>}; }

    bool may_begin_in(const Primitive& primitive) const {
        for (int i = 0; i < 3; ++i)
            if (!(T(primitive.bounds.lower[i]) <= ray_.narrow.origin[i] &&
                  ray_.narrow.origin[i] <= T(primitive.bounds.upper[i])))
                return false;
        return true;
    }

    const Geometry& geometry_;
    const WideRay<T>& ray_;
    const Departure& from_;
    bool brute_force_;
    std::uint32_t gone_;
    [[no_unique_address]] Observer observer_;
};

template <class T, class Observer>
Nearest<T> closest_hit(const Snapshot& scene, const WideRay<T>& ray, const Departure& departed,
                       Acceleration acceleration, const Bvh::Frontier* from, Observer observer) {
    return Search<T, Observer>(scene, ray, departed, acceleration, observer).run(from);
}

template <class T, class Observer>
bool is_blocked(const Snapshot& scene, const WideRay<T>& ray, const Departure& departed, std::int32_t* blocker,
                Acceleration acceleration, std::uint32_t* last, Observer observer) {
    const Geometry& geometry = scene.geometry();
    const T reach = ray.narrow.has_target ? ray.narrow.t_max * T(1 + 0x1p-10) : infinity<T>;
    const BlockerSearch<T, Observer> search(scene, ray, departed, acceleration, observer);
    if (search.is_within_blocked()) {
        if (blocker) *blocker = scene.objects()[geometry.primitives[departed.within].object].id;
        return true;
    }
    const auto visit = [&](std::uint32_t index, T, bool filtered) {
        if (!search.is_blocked_by(index, filtered)) return false;
        if (blocker) *blocker = scene.objects()[geometry.primitives[index].object].id;
        if (last && *last != index) *last = index;  // (other threads may share the cache line)
        return true;
    };
    if (last && *last != Departure::none) {
        T entry;
        if (crosses(geometry.primitives[*last].bounds, SlabRay<T>(ray.narrow), reach, &entry) &&
            visit(*last, entry, false))
            return true;
    }
    if (acceleration != Acceleration::brute_force)
        return scene.accelerator().any(geometry, ray.narrow, reach, observed(visit, observer));
    return visit_all(geometry, ray.narrow, reach, visit);
}

template Nearest<float> closest_hit(const Snapshot&, const WideRay<float>&, const Departure&, Acceleration,
                                    const Bvh::Frontier*, RAYBOUND_OBSERVER);
template Nearest<double> closest_hit(const Snapshot&, const WideRay<double>&, const Departure&, Acceleration,
                                     const Bvh::Frontier*, RAYBOUND_OBSERVER);
template bool is_blocked(const Snapshot&, const WideRay<float>&, const Departure&, std::int32_t*, Acceleration,
                         std::uint32_t*, RAYBOUND_OBSERVER);
template bool is_blocked(const Snapshot&, const WideRay<double>&, const Departure&, std::int32_t*, Acceleration,
                         std::uint32_t*, RAYBOUND_OBSERVER);

#ifndef RAYBOUND_COUNTED
bool is_blocked_by(const Snapshot& scene, const WideRay<float>& ray, const Departure& departed,
                   std::uint32_t primitive) {
    return BlockerSearch<float, Unseen>(scene, ray, departed, Acceleration::bvh, {}).is_blocked_by(primitive, false);
}
bool is_blocked_from_inside(const Snapshot& scene, const WideRay<float>& ray, const Departure& departed) {
    return BlockerSearch<float, Unseen>(scene, ray, departed, Acceleration::bvh, {}).is_within_blocked();
}
#endif

}  // namespace raybound
