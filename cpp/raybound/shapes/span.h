// The part of a line inside a convex solid: the common answer of all shape kernels.
#pragma once

#include "raybound/geometry/ray.h"

namespace raybound {

// A ray in the coordinates of a shape. The errors bound, component by component, how far origin and direction are
// from those that the exact map of the shape gives (derivation D1).
template <class T>
struct LocalRay {
    Vec3<T> origin, direction;
    Vec3<T> origin_error, direction_error;
};

// The line is inside for t in [t_in, t_out] where `hit`. A crossing is `ahead` if it *certainly* lies at t > 0: one
// whose sign the number type cannot tell is at the origin, which a ray has left (derivation D2).
template <class T>
struct Span {
    T t_in, t_out;
    Index<T> face_in, face_out;
    Mask<T> hit, in_ahead, out_ahead;
};

// The first boundary ahead of a ray's origin.
template <class T>
struct FirstAhead {
    T t;
    Index<T> face;
    Mask<T> hit, entering;
};

template <class T>
[[gnu::always_inline]] inline FirstAhead<T> first_ahead(const Span<T>& span) {
    const T t = select(span.in_ahead, span.t_in, span.t_out);
    const Index<T> face = select(span.in_ahead, span.face_in, span.face_out);
    return {t, face, Mask<T>(span.hit & (span.in_ahead | span.out_ahead)), span.in_ahead};
}

// A convex solid is the intersection of its pieces: the later entry, the earlier exit. On a tie the lower face, which
// is the first piece's, stays.
template <class T>
inline Span<T> clip(const Span<T>& a, const Span<T>& b) {
    const Mask<T> in = b.t_in > a.t_in, out = b.t_out < a.t_out;
    Span<T> both;
    both.t_in = select(in, b.t_in, a.t_in);
    both.t_out = select(out, b.t_out, a.t_out);
    both.face_in = select(in, b.face_in, a.face_in);
    both.face_out = select(out, b.face_out, a.face_out);
    both.hit = a.hit & b.hit & (both.t_in <= both.t_out);
    both.in_ahead = select(in, b.in_ahead, a.in_ahead);
    both.out_ahead = select(out, b.out_ahead, a.out_ahead);
    return both;
}

// Where a ray that is inside a convex solid leaves it, whatever its rounded origin says: how it came in is not asked.
template <class T>
struct Exit {
    T t;
    Index<T> face;
};

// The earlier one; on a tie the first piece's, as in `clip`.
template <class T>
inline Exit<T> earlier(const Exit<T>& a, const Exit<T>& b) {
    const Mask<T> second = b.t < a.t;
    return {select(second, b.t, a.t), select(second, b.face, a.face)};
}
template <class T>
inline Exit<T> exit_of(const Span<T>& span) {
    return {span.t_out, span.face_out};
}

// Between the planes `lower` and `upper` of one coordinate; f and d are the ray's origin and direction there, with the
// bounds of their errors. (Without error, signs of differences are exact.) A direction whose sign is unsure is
// parallel.
template <class T>
inline Span<T> slab_span(const LocalRay<T>& ray, int axis, T lower, T upper, int lower_face) {
    const T f = ray.origin[axis], d = ray.direction[axis], r = T(1) / d, band = ray.origin_error[axis];
    const T below = lower - f, above = f - upper;  // > 0: outside
    const Mask<T> parallel = (abs(d) <= ray.direction_error[axis]) | !(abs(r) < infinity<T>);
    const Mask<T> forward = d > T(0), within = (below <= T(0)) & (above <= T(0));
    const T at_lower = below * r, at_upper = -(above * r);
    const T entry = select(forward, below, above), exit = select(forward, above, below);
    Span<T> span;
    span.t_in = select(parallel, -infinity<T>, select(forward, at_lower, at_upper));
    span.t_out = select(parallel, infinity<T>, select(forward, at_upper, at_lower));
    const Index<T> lower_plane(lower_face), upper_plane(lower_face + 1);
    span.face_in = select(forward, lower_plane, upper_plane);
    span.face_out = select(forward, upper_plane, lower_plane);
    span.hit = select(parallel, within, Mask<T>(true));
    span.in_ahead = Mask<T>(!parallel) & (entry > band);
    span.out_ahead = Mask<T>(!parallel) & (exit < -band);
    return span;
}

}  // namespace raybound
