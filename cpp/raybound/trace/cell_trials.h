// Trials of the bounds over cells of rays: kernels run in float and double at random points of random cells, which must
// lie in what the kernel gives over Taylor models of the whole cell; and the time that both take.
#pragma once

#include <cstdint>

#include "raybound/trace/cell_shading.h"

namespace raybound {

struct CellTrials {
    std::int64_t cells = 0, bounded = 0, far = 0,
                 grazing = 0;  // of the bounded ones: far from the origin, at < 0.1 rad
    std::int64_t points = 0, float_outside = 0, double_outside = 0;
    double largest_share = 0;  // of a bound that a result's distance from the polynomial took
    double widest = 0;         // the largest remainder over the largest size of the polynomial, of bounded cells
};

// `cells` random cells of N = 2 or 4 variables (image blocks of an eye, or pairs of points on two planes) on spheres
// and planes, some seen in a mirror: sizes 10^U(-2, 2), up to 10^5 sizes from the origin and 10^3 from the eye, cells
// from 10^-5 to 0.1 of the size, grazing to head on; `points` random points in each.
CellTrials run_cell_trials(int n, std::int64_t cells, std::int64_t points, std::uint64_t seed);

// Nanoseconds per evaluation of the sphere's kernel (a ray's intersection, normal and Ward shading, three channels)
// over cells of N variables: in double at a point of each cell, and with TaylorModel<N, float32> over it. The least of
// `rounds`, taken in turn.
struct CellTimes {
    double plain, taylor;
};
CellTimes time_cells(int n, int rounds);

}  // namespace raybound
