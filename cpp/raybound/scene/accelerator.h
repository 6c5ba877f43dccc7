// What rays search a scene with: a BVH over the primitives, whose leaves are packs of spheres, packs of triangles, or
// single primitives of other kinds.
#pragma once

#include <optional>

#include "raybound/geometry/bvh.h"
#include "raybound/shapes/geometry.h"
#include "raybound/shapes/packs.h"

namespace raybound {

// What filters and slabs need of a ray. Only the parts for kinds that the scene has are used, and so computed.
template <class T>
struct SearchRay {
    explicit SearchRay(const Ray<T>& ray) : slabs(ray), origin(ray.origin), direction(ray.direction) {}

    const TrianglePackRay<T>& triangles() {
        if (!triangles_) triangles_.emplace(origin, direction, T(0));
        return *triangles_;
    }

    SlabRay<T> slabs;
    const Vec3<T>&origin, &direction;

  private:
    std::optional<TrianglePackRay<T>> triangles_;
};

class Accelerator {
  public:
    Accelerator() = default;
    Accelerator(const Geometry& geometry, Lookout& lookout);

    const Bvh& bvh() const { return bvh_; }
    std::size_t bytes() const;

    // Have updates made the tree so bad that it should be built anew?
    bool is_degraded() const { return bvh_.cost() > 1.5f * built_cost_; }

    // Gives a primitive that stays of its kind its new place. False if that is not possible: then the accelerator must
    // be made anew, as it must when primitives come or go.
    bool update(const Geometry& geometry, std::uint32_t primitive);

    // Calls visit(primitive, entry, filtered) for the primitives whose own box the ray crosses within [0, t_max] and
    // which it may meet; visit may lower t_max. The search begins at `from`, if that is given. `filtered`: the filter
    // in T has been asked already.
    template <class T, class Visit>
    void traverse(const Geometry& geometry, const Ray<T>& ray, T& t_max, const Visit& visit,
                  const Bvh::Frontier* from) const;

    // The same in any order, until visit(primitive, entry, filtered) returns true.
    template <class T, class Visit>
    bool any(const Geometry& geometry, const Ray<T>& ray, T t_max, const Visit& visit) const;

    // Calls visit(primitive) for each primitive of a leaf of the BVH.
    template <class Visit>
    void visit_primitives(std::uint32_t leaf, const Visit& visit) const;

  private:
    enum class Kind : std::uint8_t { single, spheres, triangles };
    static constexpr std::uint32_t kind_shift = 29, index_mask = (1u << kind_shift) - 1;

    static Kind kind_of(const Geometry& geometry, std::uint32_t primitive);
    std::uint32_t make_leaf(const Geometry& geometry, std::span<const std::uint32_t> items);
    void fill_lane(const Geometry& geometry, std::uint32_t primitive, std::uint32_t leaf, std::uint32_t lane);

    template <class T, class Visit>
    bool visit_leaf(const Geometry& geometry, std::uint32_t leaf, T near, SearchRay<T>& ray, const T& t_max,
                    const Visit& visit) const;

    // Where a primitive is: its leaf, its lane in it, and the slot of the BVH that leads there. Nobody needs to know
    // before the first update.
    struct Place {
        std::uint32_t leaf, slot;
        std::uint8_t lane;
    };
    void find_places(std::size_t primitives);

    Bvh bvh_;
    std::vector<SpherePack> spheres_;
    std::vector<TrianglePack> triangles_;
    std::vector<Place> places_;
    float built_cost_ = 0;
};

template <class Visit>
void Accelerator::visit_primitives(std::uint32_t leaf, const Visit& visit) const {
    const std::uint32_t index = leaf & index_mask;
    const auto lanes = [&visit](const auto& pack) {
        for (std::uint32_t rest = pack.lanes; rest != 0;) visit(pack.id[bvh::take_lowest(rest)]);
    };
    switch (Kind(leaf >> kind_shift)) {
        case Kind::single:
            return visit(index);
        case Kind::spheres:
            return lanes(spheres_[index]);
        case Kind::triangles:
            return lanes(triangles_[index]);
    }
}

template <class T, class Visit>
bool Accelerator::visit_leaf(const Geometry& geometry, std::uint32_t leaf, T near, SearchRay<T>& ray, const T& t_max,
                             const Visit& visit) const {
    const std::uint32_t index = leaf & index_mask;
    const auto kind = Kind(leaf >> kind_shift);
    if (kind == Kind::single) return visit(index, near, false);
    std::uint32_t lanes;
    const std::uint32_t* ids;
    if (kind == Kind::spheres) {
        lanes = may_cross(spheres_[index], ray.origin, ray.direction);
        ids = spheres_[index].id;
    } else {
        lanes = may_cross(triangles_[index], ray.triangles(), t_max);
        ids = triangles_[index].id;
    }
    while (lanes != 0) {
        const std::uint32_t primitive = ids[bvh::take_lowest(lanes)];
        T entry;
        if (crosses(geometry.primitives[primitive].bounds, ray.slabs, t_max, &entry) && visit(primitive, entry, true))
            return true;
    }
    return false;
}

template <class T, class Visit>
void Accelerator::traverse(const Geometry& geometry, const Ray<T>& ray, T& t_max, const Visit& visit,
                           const Bvh::Frontier* from) const {
    if (from && from->count == 0) return;
    SearchRay<T> search(ray);
    bvh_.traverse(search.slabs, t_max,
                  observed([&](std::uint32_t leaf, T near) { visit_leaf(geometry, leaf, near, search, t_max, visit); },
                           observer_of(visit)),
                  from);
}

template <class T, class Visit>
bool Accelerator::any(const Geometry& geometry, const Ray<T>& ray, T t_max, const Visit& visit) const {
    SearchRay<T> search(ray);
    return bvh_.any(
        search.slabs, t_max,
        observed([&](std::uint32_t leaf, T near) { return visit_leaf(geometry, leaf, near, search, t_max, visit); },
                 observer_of(visit)));
}

}  // namespace raybound
