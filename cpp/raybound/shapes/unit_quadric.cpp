#include "raybound/shapes/unit_quadric.h"

#include <queue>

namespace raybound {

namespace {

// A sum of products of doubles with about 100 bits: q around a far box cancels (derivation D7).
class LongSum {
  public:
    void add(double a, double b, double c) {
        const double ab = a * b, ab_error = std::fma(a, b, -ab);
        const double abc = ab * c, abc_error = std::fma(ab, c, -abc);
        const double sum = high_ + abc, part = sum - high_;
        low_ += (high_ - (sum - part)) + (abc - part) + abc_error + ab_error * c;
        high_ = sum;
        size_ += std::abs(abc);
    }
    double value() const { return high_ + low_; }
    double size() const { return size_; }

  private:
    double high_ = 0, low_ = 0, size_ = 0;
};

// A sub-box of the cube, in the order of a bound.
struct Cell {
    Vec3d center, half;
    double bound;
    bool operator<(const Cell& other) const { return bound < other.bound; }
};

constexpr int most_cells = 4000;

// What F does around a cell's centre: F = value + 2 g.e + e'Qe.
struct Local {
    double value;
    Vec3d half_gradient;
    Vec3d bend;   // rows of |Q| times the cell's half size
    double fall;  // e'Qe is no less than minus this: squares with a positive coefficient only add
};

Local expand(const UnitQuadric& q, const Cell& cell) {
    const Vec3d qz = q.form * cell.center;
    const Vec3d bend = absolute(q.form) * cell.half;
    double squares = 0;
    for (int i = 0; i < 3; ++i) squares += maximum(0.0, q.form.row[i][i]) * cell.half[i] * cell.half[i];
    return {dot(qz + q.linear * 2.0, cell.center) + q.constant, qz + q.linear, bend, dot(bend, cell.half) - squares};
}

double margin(const UnitQuadric& q) { return 0x1p-44 * q.norm; }  // beyond all roundings of a value of F

// F's least value over the cell, from below.
double least(const Cell& cell, const Local& at) {
    return at.value - 2 * dot(absolute(at.half_gradient), cell.half) - at.fall;
}

// The greatest u.z where F <= 0, from above: that of u.z - m F for any m >= 0. The m that cancel a component of the
// slope are the best ones, where the solid ends at a face of the cube too.
struct Greatest {
    double bound;
    Vec3d slope, weight;  // of u.z - m F; how much each axis widens the bound
};

Greatest greatest(const UnitQuadric& q, const Cell& cell, const Local& at, const Vec3d& u) {
    const Vec3d g = at.half_gradient * 2.0;
    const Vec3d steep = (absolute(g) + at.bend) * (norm1(u) / q.norm);
    Greatest found{dot(absolute(u), cell.half), u, absolute(u) + steep};
    for (const double m : {u.x / g.x, u.y / g.y, u.z / g.z, dot(u, g) / dot(g, g)}) {
        const Vec3d slope = u - g * m;
        const double bound = dot(absolute(slope), cell.half) + m * (at.fall + margin(q) - at.value);
        if (m > 0 && bound < found.bound) found = {bound, slope, absolute(slope) + at.bend * m + steep};
    }
    found.bound += dot(u, cell.center);
    found.weight = found.weight * cell.half;
    return found;
}

// The two halves of a cell, cut across the axis that matters most.
template <class Push>
void split(const Cell& cell, const Vec3d& weight, Push push) {
    const int axis = weight.x >= weight.y ? (weight.x >= weight.z ? 0 : 2) : (weight.y >= weight.z ? 1 : 2);
    for (const double side : {-0.5, 0.5}) {
        Cell part = cell;
        part.half[axis] *= 0.5;
        part.center[axis] += side * cell.half[axis];
        push(part);
    }
}

double sign_of(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

// Any vector's Rayleigh quotient is at most the largest eigenvalue; repeated products with Q + shift come close to it.
double largest_eigenvalue(const Mat3<double>& form, double sign, double shift) {
    Vec3d v = normalize(Vec3d{1, 0.7, 0.4});
    for (int i = 0; i < 200; ++i) v = normalize(form * v * sign + v * shift);
    return maximum(0.0, sign * dot(v, form * v) - 0x1p-40 * shift);
}

}  // namespace

UnitQuadric unit_quadric(const Shape& shape) {
    const auto at = [&](int i) { return double(shape.coefficients()[std::size_t(i)]); };
    const Vec3d lower(shape.first()), upper(shape.second());
    const Vec3d m = (lower + upper) * 0.5, h = (upper - lower) * 0.5;
    const double x2 = at(0), y2 = at(1), z2 = at(2), xy = at(3) / 2, yz = at(4) / 2, xz = at(5) / 2;
    const Mat3<double> form{{x2, xy, xz}, {xy, y2, yz}, {xz, yz, z2}};
    const Vec3d linear{at(6) / 2, at(7) / 2, at(8) / 2};
    UnitQuadric q;
    LongSum constant;
    constant.add(at(9), 1, 1);
    double largest = 0, lost = 0;
    for (int i = 0; i < 3; ++i) {
        LongSum slope;
        slope.add(linear[i], h[i], 1);
        constant.add(linear[i] * 2, m[i], 1);
        for (int j = 0; j < 3; ++j) {
            q.form.row[i][j] = form.row[i][j] * h[i] * h[j];
            slope.add(form.row[i][j], m[j], h[i]);
            constant.add(form.row[i][j], m[i], m[j]);
            largest = maximum(largest, std::abs(q.form.row[i][j]));
        }
        q.linear[i] = slope.value();
        largest = maximum(largest, std::abs(q.linear[i]));
        lost += 2 * slope.size();
    }
    q.constant = constant.value();
    largest = maximum(largest, std::abs(q.constant));
    lost += constant.size();
    const double scale = 1 / power_of_two_below(largest);
    for (auto& row : q.form.row) row = row * scale;
    q.linear = q.linear * scale;
    q.constant *= scale;
    q.norm = 2 * norm1(q.linear) + std::abs(q.constant) + lost * scale * 0x1p-47;
    for (const auto& row : q.form.row) q.norm += norm1(row);
    return q;
}

Inside find_inside(const UnitQuadric& q) {
    Inside inside;
    std::priority_queue<Cell> cells;
    const auto push = [&](Cell cell) {
        cell.bound = -least(cell, expand(q, cell));
        if (cell.bound > margin(q)) cells.push(cell);
    };
    push({{}, {1, 1, 1}, 0});
    for (int i = 0; i < most_cells && !cells.empty(); ++i) {
        const Cell cell = cells.top();
        cells.pop();
        const Local at = expand(q, cell);
        const double depth = -at.value - margin(q);
        if (depth > inside.depth) inside = {true, cell.center, depth};
        if (cell.bound <= 2 * inside.depth) return inside;
        split(cell, cell.half * (absolute(at.half_gradient) + at.bend), push);
    }
    inside.possible = inside.depth > 0 || !cells.empty();
    return inside;
}

double enclose_reach(const UnitQuadric& q, const Vec3d& u) {
    const double whole = norm1(u), close = 0x1p-20 * whole;
    double known = -whole;
    std::priority_queue<Cell> cells;
    const auto push = [&](Cell cell) {
        const Local at = expand(q, cell);
        if (least(cell, at) > margin(q)) return;
        const auto [bound, slope, weight] = greatest(q, cell, at, u);
        cell.bound = bound;
        const Vec3d tip = cell.center + cell.half * Vec3d{sign_of(slope.x), sign_of(slope.y), sign_of(slope.z)};
        const Vec3d& g = at.half_gradient;
        for (const Vec3d& z : {tip, cell.center, cell.center - g * (0.500001 * at.value / dot(g, g))})
            if (max_component(absolute(z)) <= 1 && expand(q, {z, {}, 0}).value <= 0) known = maximum(known, dot(u, z));
        cells.push(cell);
    };
    push({{}, {1, 1, 1}, 0});
    for (int i = 0; i < most_cells && !cells.empty(); ++i) {
        const Cell cell = cells.top();
        if (cell.bound <= known + close) break;
        cells.pop();
        split(cell, greatest(q, cell, expand(q, cell), u).weight, push);
    }
    return cells.empty() ? whole : minimum(whole, cells.top().bound);
}

Quadric local_quadric(const UnitQuadric& q, double radius) {
    Quadric local;
    local.form = q.form;
    local.linear = q.linear * radius;
    local.constant = q.constant * radius * radius;
    local.norm = q.norm;
    local.radius = radius;
    const Inside inside = find_inside(q);
    local.inside = inside.point * radius;
    local.depth = inside.depth * radius * radius;
    local.rise = largest_eigenvalue(q.form, 1, q.norm);
    local.fall = largest_eigenvalue(q.form, -1, q.norm);
    return local;
}

}  // namespace raybound
