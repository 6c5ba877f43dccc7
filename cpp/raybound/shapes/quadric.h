// The solid q <= 0 of a quadric within a box: in its own coordinates F(y) = y'Qy + 2 l.y + c over |y_i| <= R. A line
// may be inside twice. Faces: 0 the quadric, 1 -x, 2 +x, 3 -y, 4 +y, 5 -z, 6 +z of the box. (Derivation D7.)
#pragma once

#include "raybound/geometry/matrix.h"
#include "raybound/shapes/box.h"

namespace raybound {

struct Quadric {
    Mat3<double> form;    // Q, the largest coefficient of F / R^2 about 1
    Vec3d linear;         // R times what it is in the unit cube
    double constant = 0;  // R^2 times
    double radius = 1;
    double norm = 0;     // |F(y)| <= norm |y|^2 for |y| >= R, in the largest component
    double stretch = 1;  // of the frame: the largest row sum of |A| |A^-1|, and of |A| |center|
    double center = 0;
    double rise = 0, fall = 0;  // lower bounds of the largest eigenvalue of Q and of minus the least, where positive
    Vec3d inside;               // a point with F <= -depth, if that is positive
    double depth = 0;
};

// A sign is read as one only if it is this many times beyond its error: what keeps a ray certain of its side all along
// its way through the box.
template <class T>
inline constexpr T quadric_margin = T(32);

// How far computed coordinates of at most `reach` are from the exact map's.
template <class T>
inline T quadric_error(const Quadric& s, T reach) {
    return gamma<T>(30) * T(s.stretch) * reach + gamma<T>(1) * T(s.center);
}

// How far F is off at such a point.
template <class T>
inline T quadric_noise(const Quadric& s, T reach, T error) {
    return T(s.norm) * (gamma<T>(12) * reach * reach + (T(2) * reach + error) * error);
}

template <class T>
inline Vec3<T> quadric_half_gradient(const Quadric& s, const Vec3<T>& y) {
    return Mat3<T>(s.form) * y + Vec3<T>(s.linear);
}

template <class T>
inline T quadric_value(const Quadric& s, const Vec3<T>& y, const Vec3<T>& half_gradient) {
    return dot(half_gradient + Vec3<T>(s.linear), y) + T(s.constant);
}

// F along a ray, from an origin near the box: at `shift` along the ray if its own is `far` away.
template <class T>
struct QuadricLine {
    Quadratic<T> along;
    T a_band, shift;
    Mask<T> far;
};

template <class T>
inline QuadricLine<T> quadric_line(const Quadric& s, const LocalRay<T>& ray) {
    const Vec3<T>& d = ray.direction;
    const T radius(s.radius), away = max_component(absolute(ray.origin));
    QuadricLine<T> line;
    line.far = away > T(2) * radius;
    line.shift = select(line.far, -(dot(ray.origin, d) / dot(d, d)), T(0));
    const Vec3<T> f = ray.origin + d * line.shift;
    const T reach = maximum(radius, max_component(absolute(f)));
    const T noise = quadric_noise(s, reach, quadric_error(s, maximum(away, reach)));
    const T ratio = max_component(absolute(d)) / reach;
    const Vec3<T> half = quadric_half_gradient(s, f);
    Quadratic<T>& q = line.along;
    q.a = dot(Mat3<T>(s.form) * d, d);
    q.b = dot(half, d);
    q.c = {quadric_value(s, f, half), quadric_margin<T> * noise};
    q.b_band = noise * ratio;
    line.a_band = q.b_band * ratio;
    const T b2 = q.b * q.b, ac = q.a * q.c.value;
    q.discriminant = {b2 - ac, (T(2) * abs(q.b) + q.b_band) * q.b_band + (abs(q.a) + line.a_band) * noise +
                                   abs(q.c.value) * line.a_band + gamma<T>(4) * (b2 + abs(ac))};
    return line;
}

// The filter for a type that is not the one that decides; an unsure or negative `a` says nothing.
template <class T>
inline Mask<T> quadric_missed(const Quadric& s, const LocalRay<T>& ray) {
    const QuadricLine<T> line = quadric_line(s, ray);
    const Quadratic<T>& q = line.along;
    const Mask<T> behind = !line.far & (q.c.value > q.c.band) & (q.b > q.b_band);
    return (q.a > line.a_band) & ((q.discriminant.value < -q.discriminant.band) | behind);
}

// The parts of a line inside a solid that need not be convex, in order.
template <class T>
struct Spans {
    Span<T> part[2];
    int count = 0;

    void add(const Span<T>& span) {
        if (!none(span.hit)) part[count++] = span;
    }
};

// An `a` within its band is none: F is as good as linear in the box.
template <class T>
inline QuadricLine<T> settled_line(const Quadric& s, const LocalRay<T>& ray) {
    QuadricLine<T> line = quadric_line(s, ray);
    Quadratic<T>& q = line.along;
    if (abs(q.a) <= line.a_band) q.a = T(0), q.discriminant.value = q.b * q.b;
    return line;
}

// A `b` within its band is none, too, if `a` is: F is as good as constant in the box. From far away all of the box lies
// on one side of the origin.
template <class T>
inline Spans<T> quadric_spans(const Quadric& s, const LocalRay<T>& ray) {
    const T r(s.radius), inf = infinity<T>;
    Span<T> box = box_span(ray, {-r, -r, -r}, {r, r, r});
    ++box.face_in, ++box.face_out;  // after the quadric's own
    Spans<T> spans;
    if (none(box.hit)) return spans;
    const QuadricLine<T> line = settled_line(s, ray);
    const Quadratic<T>& q = line.along;
    if (q.a == T(0) && abs(q.b) <= q.b_band) {
        if (q.c.value <= T(0)) spans.add(box);
        return spans;
    }
    const Roots<T> roots = solve(q);
    const Mask<T> ahead = box.t_out > T(0);
    const Mask<T> low_ahead = select(line.far, ahead, roots.low_ahead);
    const Mask<T> high_ahead = select(line.far, ahead, roots.high_ahead);
    const T low = line.shift + roots.low, high = line.shift + roots.high;
    if (q.a >= T(0)) {
        spans.add(clip(Span<T>{low, high, 0, 0, roots.real, low_ahead, high_ahead}, box));
    } else if (none(roots.real)) {
        spans.add(box);
    } else {
        spans.add(clip(Span<T>{-inf, low, 0, 0, roots.real, Mask<T>(false), low_ahead}, box));
        spans.add(clip(Span<T>{high, inf, 0, 0, roots.real, high_ahead, Mask<T>(false)}, box));
    }
    return spans;
}

// Where a ray that is inside leaves. Where F falls to both ends of the line (a < 0) it leaves at the lower root if it
// is before the gap between the roots.
template <class T>
inline Exit<T> quadric_exit(const Quadric& s, const LocalRay<T>& ray) {
    const T r(s.radius);
    const Span<T> box = box_span(ray, {-r, -r, -r}, {r, r, r});
    const Exit<T> out{box.t_out, box.face_out + 1};
    const QuadricLine<T> line = settled_line(s, ray);
    const Quadratic<T>& q = line.along;
    if (q.a == T(0) && abs(q.b) <= q.b_band) return out;
    if (q.a >= T(0)) return earlier(Exit<T>{line.shift + last_root(q), 0}, out);
    const Roots<T> roots = solve(q);
    const bool before_gap = roots.real && line.shift - q.b / q.a > T(0);
    return before_gap ? earlier(Exit<T>{line.shift + roots.low, 0}, out) : out;
}

template <class T>
inline Surface<T> quadric_surface(const Quadric& s, const Vec3<T>& y, const Vec3<T>& d, int face,
                                  const Vec3<T>& error) {
    const T radius(s.radius);
    if (face != 0) return box_surface(y, face - 1, {-radius, -radius, -radius}, {radius, radius, radius}, error);
    const T reach = maximum(radius, max_component(absolute(y)));
    const Vec3<T> half = quadric_half_gradient(s, y);
    return {{quadric_value(s, y, half), quadric_noise(s, reach, quadric_error(s, reach))},
            half * T(2),
            dot(Mat3<T>(s.form) * d, d)};
}

// How far the quadric is from y, where |F| <= residual, by what leads to it wherever y is: along an eigenvector F
// falls, or rises, at least as s^2 times the eigenvalue; toward a point inside at least as the chord does, if F is
// convex.
template <class T>
inline T quadric_distance(const Quadric& s, const Vec3<T>& y, const Banded<T>& form, T residual) {
    const Vec3<T> inward = Vec3<T>(s.inside) - y;
    const Mask<T> convex = (T(2) * residual < T(s.depth)) & (dot(Mat3<T>(s.form) * inward, inward) >= T(0));
    const T chord = select(convex, length(inward) * (T(2) * residual / T(s.depth)), infinity<T>);
    const T from_outside = minimum(chord, sqrt(residual / T(s.fall))), from_inside = sqrt(residual / T(s.rise));
    const T surely = select(form.value > T(0), from_outside, from_inside);
    return select(abs(form.value) > form.band, surely, maximum(from_outside, from_inside));
}

// The quadric: u the longitude about the middle of the box from +x, counter-clockwise seen from +z; v the height in the
// box. The faces of the box: as a box's.
template <class T>
inline UV<T> quadric_uv(const Quadric& s, const Vec3<T>& y, int face) {
    const T r(s.radius);
    if (face != 0) return box_uv(y, face - 1, {-r, -r, -r}, {r, r, r});
    return {turn(y.y, y.x), disk_coordinate(y.z, r)};
}

}  // namespace raybound
