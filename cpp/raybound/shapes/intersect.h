// Where rays meet primitives: which crossing counts, and the hit point with bounds of its errors.
//
// The number type T draws; whether and where a ray crosses a surface is *decided* in its wide type (double for float),
// so that the picture's decisions are those of double arithmetic, and T is a filter before it that never errs.
#pragma once

#include <utility>

#include "raybound/shapes/geometry.h"

namespace raybound {

// A ray as both types see it.
template <class T>
struct WideRay {
    WideRay(const Vec3<T>& origin, const Vec3<T>& direction)
        : narrow(make_ray(origin, direction)), wide(widen(narrow)) {}
    explicit WideRay(const Ray<T>& ray) : narrow(ray), wide(widen(narrow)) {}
    static WideRay segment(const Vec3<T>& origin, const Vec3<T>& target) { return {origin, target, true}; }

    Ray<T> narrow;
    Ray<Wide<T>> wide;

  private:
    WideRay(const Vec3<T>& origin, const Vec3<T>& target, bool)
        : narrow(make_segment(origin, target)), wide(widen(narrow)) {}
};

// The first crossing of a primitive that certainly lies ahead of a ray's origin.
template <class T>
struct Crossing {
    T t;
    std::uint32_t leaf;
    std::int32_t face;         // of the leaf
    std::int32_t face_offset;  // of the leaf's faces within the object
    Mask<T> hit;
    Mask<T> entering;  // a solid, from outside
};

// What a search knows before it asks about a primitive.
template <class T>
struct Asking {
    bool filtered = false;     // the filter in T has been asked already
    bool brute_force = false;  // look at every face of a mesh
    T t_max = infinity<T>;     // nothing beyond is of interest
};

// (`observer` sees what is visited within a mesh.)
template <class T, class Observer = Unseen>
Crossing<Wide<T>> first_crossing(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray,
                                 const Asking<T>& asking = {}, Observer observer = {});

// Does a crossing lie certainly before the ray's target, if it has one?
template <class T>
Mask<T> is_before_end(const Geometry& geometry, const Crossing<Wide<T>>& crossing, const WideRay<T>& ray);

// The crossing that a primitive blocks a ray by.
struct Blocking {
    bool entering = false;
};

// Does the primitive block the ray, certainly after its origin and certainly before its target, if it has one?
template <class T, class Observer = Unseen>
Mask<T> blocks(const Geometry& geometry, const Primitive& primitive, const WideRay<T>& ray,
               const Asking<T>& asking = {}, Blocking* how = nullptr, Observer observer = {});

// Do two crossings of a ray lie within their errors of each other, those of the surfaces as described included?
bool coincide(const Geometry& geometry, const Crossing<double>& a, const Crossing<double>& b, const Ray<double>& ray);

// A hit with its error bounds. `entering`: the ray comes from outside. For solids that is a matter of which crossing it
// is, not of the normal's sign, which rounding may turn at a silhouette. The box point +- point_error holds a point of
// the surface, not always the ray's own crossing of it; t +- t_error holds that (derivation D3). `normal` is the
// outward unit normal, along which origins are moved; `shading` is the same, or interpolated between the vertices of a
// mesh, on the same side.
template <class T>
struct SurfacePoint {
    T t, t_error;
    Vec3<T> point, point_error, normal, shading;
    UV<T> uv;
    Mask<T> entering;
};

// What not everybody wants to know, and is zero unless asked for.
struct Wanted {
    bool t_error = false, uv = false;
};

template <class T>
SurfacePoint<T> surface_point(const Geometry& geometry, const Crossing<Wide<T>>& crossing, const Ray<Wide<T>>& ray,
                              Wanted wanted);

// What a tracer without bounds knows of a hit: o + t d and the unit normal there, all in T. It promises nothing: the
// epsilon policies start from it.
template <class T>
struct PlainPoint {
    Vec3<T> point, normal;
};
template <class T>
PlainPoint<T> estimate_point(const Geometry& geometry, const Crossing<Wide<T>>& crossing, const Ray<T>& ray);

// What settles a tie of t: the primitive's object, then the face, counted within the object.
using Rank = std::pair<std::uint32_t, std::int32_t>;
inline Rank rank(const Geometry& geometry, std::uint32_t primitive, std::int32_t face) {
    return {geometry.primitives[primitive].object, face};
}

// Once a ray has left a convex leaf outward (or a sheet on either side), it cannot meet it again.
bool is_left_for_good(const Geometry& geometry, const Primitive& primitive, bool outward);

// Is it one convex solid? (Of closed primitives those that are left for good.)
inline bool is_convex_solid(const Geometry& geometry, const Primitive& primitive) {
    return is_left_for_good(geometry, primitive, true);
}

}  // namespace raybound
