// The cell over which a number is a function of variables: |x_i - center_i| <= radius_i, seen as |xi_i| <= 1.
#pragma once

#include "raybound/numbers/rounding.h"

namespace raybound {

// A radius enlarged so that what rounds to an end of the cell, as its user computes it, lies in it. `relative` is 2^-40
// for new cells, and less for parts of them, so that these lie within.
inline constexpr double new_cell = 0x1p-40, derived_cell = 0x1p-44;
inline double enlarged_radius(double center, double radius, double relative) {
    if (radius == 0) return 0;
    return add_up(radius, add_up(multiply_up(radius, relative), multiply_up(std::abs(center), relative * 0x1p-10)));
}

// Does x lie in the cell, for certain?
inline bool is_in_cell(double x, double center, double radius) {
    return subtract_up(x, center) <= radius && subtract_up(center, x) <= radius;
}

// The radius of a part |x - part_center| <= part_radius of a cell: enlarged as far as the cell allows, negative if the
// part is none.
inline double part_radius(double center, double radius, double of_center, double of_radius) {
    if (!(of_center + of_radius <= center + radius && of_center - of_radius >= center - radius)) return -1;
    const double room_above = subtract_down(add_down(center, radius), of_center);
    const double room_below = subtract_down(of_center, subtract_up(center, radius));
    const double wanted = enlarged_radius(of_center, of_radius, derived_cell);
    const double room = room_above < room_below ? room_above : room_below;
    return room < 0 ? 0 : wanted < room ? wanted : room;
}

// The normalised coordinate of a point of the cell, within 2^-52 of itself: two roundings.
inline double normalised(double x, double center, double radius) { return radius == 0 ? 0 : (x - center) / radius; }

}  // namespace raybound
