#include "raybound/shapes/inside.h"

#include <algorithm>
#include <span>

#include "raybound/shapes/forced_exit.h"

namespace raybound {

namespace {

// How far an origin may have been rounded: the box around a hit point and the step out of it, with room to spare.
double rounding_of(const Primitive& primitive, const Ray<double>& ray) {
    const Vec3d extent(primitive.bounds.upper - primitive.bounds.lower);
    return 0x1p-20 * max_component(absolute(ray.origin)) + 0x1p-40 * max_component(extent);
}

// Chooses among what the line has inside of a solid, where the origin is known up to `near` along the ray.
class NextCrossing {
  public:
    NextCrossing(std::span<const Stretch> stretches, const Departure& from, double near)
        : stretches_(stretches), from_(from), near_(near) {}

    // Out of the stretch that the ray has come in by, or else the nearest one.
    const Stretch* exit() const {
        const Stretch* best = nullptr;
        double least = 64 * near_;
        for (const Stretch& s : stretches_) {
            if (begins_on(s.in) && std::abs(s.in.t) <= 2 * near_) return &s;
            const double gap = std::max({s.in.t, -s.out.t, 0.0});
            if (gap <= least && !(s.out.t <= 0 && begins_on(s.out))) best = &s, least = gap;
        }
        return best;
    }

    // The next stretch that the ray comes to, its first one if it begins within rounding of it. One that it may just
    // have left, as it is over within rounding, is passed by. `outside`: it cannot be inside of the solid; if it may,
    // that stretch counts, too, and its way in lies behind.
    const Stretch* entry(bool outside, bool left) const {
        std::size_t first = 0;
        for (std::size_t k = 0; k < stretches_.size(); ++k)
            if (begins_on(stretches_[k].out) && std::abs(stretches_[k].out.t) <= 2 * near_) first = k + 1;
        for (const Stretch& s : stretches_.subspan(first)) {
            if (s.out.t <= (left ? 2 * near_ : 0)) continue;
            if (s.in.t > 0) return &s;
            const bool near_in = -s.in.t <= near_ && !begins_on(s.in), near_out = s.out.t <= near_;
            if (near_in && (!near_out || -s.in.t <= s.out.t)) return &s;
            if (!near_out && !outside) return &s;
        }
        return nullptr;
    }

    bool is_inside(const Stretch& s) const { return s.in.t < -near_; }

  private:
    bool begins_on(const Crossing<double>& crossing) const {
        return crossing.leaf == from_.leaf && crossing.face == from_.face;
    }

    std::span<const Stretch> stretches_;
    const Departure& from_;
    double near_;
};

// Does a face of a mesh lie behind the plane of another one? Then a ray that has left by that one does not come in by
// it.
bool lies_behind(const MeshData& mesh, std::int32_t face, std::int32_t plane) {
    const Corners<double> c = mesh.corners<double>(face), p = mesh.corners<double>(plane);
    const Vec3d normal = cross(p.b - p.a, p.c - p.a);
    const double rounding = 0x1p-20 * norm1(normal) * double(mesh.reach());
    return dot(normal, c.a - p.a) <= rounding && dot(normal, c.b - p.a) <= rounding &&
           dot(normal, c.c - p.a) <= rounding;
}

// At an acute edge of a mesh the step out of one face may lead back before the other: no way in.
void drop_way_back(const Geometry& geometry, const Primitive& primitive, const Departure& from, double near,
                   std::vector<Stretch>& stretches) {
    if (!is_mesh(geometry, primitive) || from.leaf != primitive.root) return;
    const MeshData& mesh = *geometry.meshes[geometry.leaves[primitive.root].polygon].data;
    std::erase_if(stretches, [&](const Stretch& s) {
        return std::abs(s.in.t) <= 2 * near && lies_behind(mesh, s.in.face, from.face);
    });
}

Crossing<double> no_crossing() { return {infinity<double>, 0, 0, 0, false, false}; }

}  // namespace

template <class T, class Observer>
Crossing<Wide<T>> crossing_from_inside(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray,
                                       const Departure& from, const Asking<T>& asking, Observer observer) {
    if (is_convex_solid(geometry, primitive)) return exit_crossing(geometry, primitive.root, 0, ray.wide);
    const double rounding = rounding_of(primitive, ray.wide), near = 4 * rounding / length(ray.wide.direction);
    const Crossing<double> natural = first_crossing(geometry, primitive, ray, asking, observer);
    if (natural.hit && !natural.entering && natural.t > 2 * near) return natural;
    const std::vector<Stretch> stretches = stretches_of(geometry, primitive, ray.wide);
    if (const Stretch* found = NextCrossing(stretches, from, near).exit()) return ahead(found->out);
    return forced_exit(geometry, primitive, ray.wide, rounding);
}

template <class T, class Observer>
Crossing<Wide<T>> crossing_from_outside(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray,
                                        const Departure& from, bool left, const Asking<T>& asking, Observer observer) {
    const double rounding = rounding_of(primitive, ray.wide), near = 4 * rounding / length(ray.wide.direction);
    const Crossing<double> natural = first_crossing(geometry, primitive, ray, asking, observer);
    const double passed = (from.at_once ? 4 : 2) * near;
    if (!natural.hit || (natural.entering && !(left && natural.t <= passed))) return natural;
    std::vector<Stretch> stretches = stretches_of(geometry, primitive, ray.wide);
    if (left) drop_way_back(geometry, primitive, from, near, stretches);
    if (left && from.at_once) std::erase_if(stretches, [&](const Stretch& s) { return s.in.t <= passed; });
    const bool outside = left || std::abs(depth_of(geometry, primitive, ray.wide.origin)) <= rounding;
    const NextCrossing next(stretches, from, near);
    const Stretch* found = next.entry(outside, left);
    if (!found) return no_crossing();
    return !outside && next.is_inside(*found) ? found->out : ahead(found->in);
}

#define RAYBOUND_INSTANTIATE(T, Observer)                                                                 \
    template Crossing<double> crossing_from_inside(const Geometry&, const Primitive&, const WideRay<T>&,  \
                                                   const Departure&, const Asking<T>&, Observer);         \
    template Crossing<double> crossing_from_outside(const Geometry&, const Primitive&, const WideRay<T>&, \
                                                    const Departure&, bool, const Asking<T>&, Observer);
RAYBOUND_INSTANTIATE(float, Unseen)
RAYBOUND_INSTANTIATE(double, Unseen)
RAYBOUND_INSTANTIATE(float, Counted)
RAYBOUND_INSTANTIATE(double, Counted)
#undef RAYBOUND_INSTANTIATE

}  // namespace raybound
