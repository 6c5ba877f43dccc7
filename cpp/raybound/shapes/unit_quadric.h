// A quadric in the coordinates of its box, and what can be said for certain about its solid there: in double, once.
#pragma once

#include "raybound/shapes/quadric.h"
#include "raybound/shapes/shape.h"

namespace raybound {

// F(z) = z'Qz + 2 l.z + c over the cube |z_i| <= 1, scaled by a power of two so that its largest coefficient is in
// [1, 2). `norm` is the sum of all |coefficients| and of what forming them may have lost.
struct UnitQuadric {
    Mat3<double> form;
    Vec3d linear;
    double constant = 0, norm = 0;
};

UnitQuadric unit_quadric(const Shape& shape);

// A point with F <= -depth < 0, about as deep as any; `possible` is false only if F surely stays above what double's
// rounding can tell from 0: then nothing is inside.
struct Inside {
    bool possible = true;
    Vec3d point;
    double depth = 0;
};
Inside find_inside(const UnitQuadric& q);

// An upper bound of u.z over the solid, at most |u|_1: within 2^-20 |u|_1 but for very thin solids.
double enclose_reach(const UnitQuadric& q, const Vec3d& u);

// The quadric of a leaf whose frame has size `radius`.
Quadric local_quadric(const UnitQuadric& q, double radius);

}  // namespace raybound
