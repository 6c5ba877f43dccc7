// Whether a line meets a triangle: decided without rounding, so that a closed mesh is closed for every ray.
#pragma once

#include "raybound/numbers/exact.h"
#include "raybound/shapes/triangle.h"

namespace raybound {

// A difference of two doubles as the sum of two.
struct ExactDifference {
    Vec3d high, low;

    ExactDifference(const Vec3d& p, const Vec3d& o) : high(p - o) {
        for (int i = 0; i < 3; ++i) {
            const double back = high[i] - p[i];
            low[i] = (p[i] - (high[i] - back)) - (o[i] + back);
        }
    }
};

// The determinant of three vectors, each given as a sum of parts: within an ulp, with the exact sign.
inline double exact_determinant(const ExactDifference& p, const ExactDifference& q, const ExactDifference& r) {
    ExactSum<192> sum;  // 48 products of three, each four numbers
    for (const Vec3d* a : {&p.high, &p.low})
        for (const Vec3d* b : {&q.high, &q.low})
            for (const Vec3d* c : {&r.high, &r.low}) {
                if (*a == Vec3d{} || *b == Vec3d{} || *c == Vec3d{}) continue;
                for (int i = 0; i < 3; ++i) {
                    const int j = (i + 1) % 3, k = (i + 2) % 3;
                    sum.add_product((*a)[i], (*b)[j], (*c)[k]);
                    sum.add_product(-(*a)[j], (*b)[i], (*c)[k]);
                }
            }
    return sum.value();
}

// The sign of the two-dimensional determinant (p - q) x d in components i and j, exactly.
inline double exact_determinant(const ExactDifference& edge, const Vec3d& d, int i, int j) {
    ExactSum<8> sum;
    for (const Vec3d* e : {&edge.high, &edge.low}) {
        sum.add_product((*e)[i], d[j]);
        sum.add_product(-(*e)[j], d[i]);
    }
    return sum.value();
}

// A line with its shear. `origin_error` bounds how far each component of the origin is from the one that is meant.
struct PermutedLine {
    Vec3d origin, direction;
    double origin_error;
    bool closed;  // does the mesh enclose a volume, so that lines through its edges must come in and go out?
    Shear<double> shear;
    Vec3d permuted_origin, permuted_direction;

    PermutedLine(const Vec3d& o, const Vec3d& d, double error, bool is_closed)
        : origin(o),
          direction(d),
          origin_error(error),
          closed(is_closed),
          shear(d),
          permuted_origin(shear.permuted(o)),
          permuted_direction(shear.permuted(d)) {}
};

// Where a line meets a triangle: weights of the corners that add up to `sum`, and t. The whole triangle is met before
// `latest`, as far as the line's direction is right.
struct Piercing {
    double a = 0, b = 0, c = 0, sum = 0, t = 0, latest = 0;
    bool met = false;       // by the line, at any t
    bool hit = false;       // certainly ahead
    bool entering = false;  // against the outward normal: exact, as the normal's slope has the sign of -sum d_z
};

// The side of an edge that the line passes on, where it meets the edge itself: that of the line moved by (e, e^2)
// across its direction, for any e small enough. The edge function from p to q then changes by e (p - q)_y - e^2 (p -
// q)_x, so faces on both sides of an edge agree, and every face of a closed mesh is met or passed by the same line.
inline double side_of_moved_line(const Vec3d& p, const Vec3d& q, const PermutedLine& line) {
    const ExactDifference edge(p, q);
    double side = exact_determinant(edge, line.permuted_direction, 1, 2) / line.shear.dz;
    if (side == 0) side = -exact_determinant(edge, line.permuted_direction, 0, 2) / line.shear.dz;
    return side == 0 ? 0 : std::copysign(std::numeric_limits<double>::denorm_min(), side);
}

// Edge functions within their band are evaluated exactly (up to a last rounding): (q - o) x (p - o) . d over d_z.
inline void settle(EdgeFunctions<double>& e, const Corners<double>& corners, const PermutedLine& line) {
    const ExactDifference a(corners.a, line.permuted_origin), b(corners.b, line.permuted_origin),
        c(corners.c, line.permuted_origin), d(line.permuted_direction, {});
    const auto side = [&](double& value, const ExactDifference& from, const ExactDifference& to, const Vec3d& p,
                          const Vec3d& q) {
        if (!(abs(value) <= e.band)) return;
        value = exact_determinant(from, to, d) / line.shear.dz;
        if (value == 0 && line.closed) value = side_of_moved_line(p, q, line);
    };
    side(e.a, c, b, corners.c, corners.b);
    side(e.b, a, c, corners.a, corners.c);
    side(e.c, b, a, corners.b, corners.a);
}

inline double exact_volume(const Corners<double>& corners, const Vec3d& origin) {
    return -exact_determinant({corners.a, origin}, {corners.b, origin}, {corners.c, origin});
}

// Signs are those of exact arithmetic for the line as given. Zero counts for both sides of an edge, so nothing passes
// between triangles, and one seen edge-on, which has three zeros, is not met. A hit is ahead if the origin is certainly
// off the triangle's plane: farther than its error (seeds/000, 3.9.6, with every rounding).
// (Corners come permuted.)
inline Piercing pierce(const Corners<double>& corners, const PermutedLine& line) {
    EdgeFunctions<double> e = edge_functions(corners, line.permuted_origin, 0.0, line.shear);
    Piercing p;
    if (e.outside()) return p;
    if (!(e.least() > e.band || e.largest() < -e.band)) settle(e, corners, line);
    p.a = e.a, p.b = e.b, p.c = e.c, p.sum = e.a + e.b + e.c;
    if (!((e.least() >= 0 || e.largest() <= 0) && p.sum != 0)) return p;
    const double size = maximum(abs(e.least()), abs(e.largest())), far = maximum(abs(e.nearest()), abs(e.farthest()));
    const double band = 3 * ((gamma<double>(5) * size + e.band) * far + (size + e.band) * e.z_band);
    double scaled = e.a * e.za + e.b * e.zb + e.c * e.zc;
    if (abs(scaled) <= band) scaled = exact_volume(corners, line.permuted_origin);
    p.met = true;
    p.entering = p.sum * line.shear.dz > 0;
    p.t = scaled / (p.sum * line.shear.dz);
    const double unsure = line.origin_error * norm1(cross(corners.b - corners.a, corners.c - corners.a));
    p.hit = p.t > 0 && abs(scaled) > unsure * (1 + 0x1p-40);
    p.latest = ((line.shear.forward ? e.farthest() : -e.nearest()) + e.z_band + line.origin_error) / abs(line.shear.dz);
    return p;
}

}  // namespace raybound
