#include "bindings/number_kinds.h"
#include "raybound/numbers/cell.h"
#include "raybound/numbers/taylor_powers.h"
#include "raybound/numbers/taylor_views.h"

namespace raybound::python {

// constant, linear (N), pure squares (N), mixed (N (N - 1) / 2, pairs in lexicographic order), remainder.
template <int N, Arithmetic A>
struct Record<TaylorModel<N, A>> {
    using Value = double;
    static constexpr int width = 2 + 2 * N + N * (N - 1) / 2;
    template <class Visit>
    static void each_place(Visit visit) {
        using Layout = TaylorLayout<N>;
        int k = 0;
        visit(TaylorPlace{0, 0}, k++);
        for (int i = 0; i < N; ++i) visit(Layout::linear(i), k++);
        for (int i = 0; i < N; ++i) visit(Layout::pure(i), k++);
        for (int i = 0; i < N; ++i)
            for (int j = i + 1; j < N; ++j) visit(Layout::mixed(i, j), k++);
    }
    static TaylorModel<N, A> load(const double* p) {
        TaylorPolynomial<N> polynomial;
        each_place([&](TaylorPlace place, int k) { polynomial.set(place, p[k]); });
        return TaylorModel<N, A>::exactly(polynomial, p[width - 1]);
    }
    static void store(const TaylorModel<N, A>& x, double* p) {
        each_place([&](TaylorPlace place, int k) { p[k] = x.polynomial().at(place); });
        p[width - 1] = x.remainder();
    }
};

namespace {

template <int N, Arithmetic A>
using Taylor = Record<TaylorModel<N, A>>;

// Range and interpolation bound of each model: (n, 3).
template <int N, Arithmetic A>
Doubles ranges(const Doubles& models) {
    const py::ssize_t n = models.size() / Taylor<N, A>::width;
    Doubles out({n, py::ssize_t(3)});
    for (py::ssize_t i = 0; i < n; ++i) {
        const auto f = Taylor<N, A>::load(models.data() + i * Taylor<N, A>::width);
        const Interval<double> all = range(f);
        double* const to = out.mutable_data() + 3 * i;
        to[0] = all.inf();
        to[1] = all.sup();
        to[2] = interpolation_bound(f);
    }
    return out;
}

// The normalised coordinates of a point that lies in the cell.
template <int N>
std::array<double, std::size_t(N)> in_cell(const double* x, const double* center, const double* radius) {
    std::array<double, std::size_t(N)> normal;
    for (int i = 0; i < N; ++i) {
        if (!is_in_cell(x[i], center[i], radius[i]))
            throw std::invalid_argument("TaylorModel: x must lie in the cell, " + std::to_string(center[i]) + " +- " +
                                        std::to_string(radius[i]) + " along variable " + std::to_string(i) + ", got " +
                                        std::to_string(x[i]));
        normal[std::size_t(i)] = normalised(x[i], center[i], radius[i]);
    }
    return normal;
}

// A model, a cell and a point for each value.
template <int N, Arithmetic A>
Doubles values(const Doubles& models, const Doubles& centers, const Doubles& radii, const Doubles& points) {
    const py::ssize_t n = points.size() / N;
    if (models.size() != n * Taylor<N, A>::width || centers.size() != n * N || radii.size() != n * N)
        throw std::invalid_argument("taylor_values: as many models, cells and points");
    Doubles out({n, py::ssize_t(2)});
    double* const to = out.mutable_data();
    const py::gil_scoped_release released;
    for (py::ssize_t i = 0; i < n; ++i) {
        const auto x = in_cell<N>(points.data() + N * i, centers.data() + N * i, radii.data() + N * i);
        const auto f = Taylor<N, A>::load(models.data() + i * Taylor<N, A>::width);
        const Interval<double> value = value_at(f, x.data());
        to[2 * i] = value.inf();
        to[2 * i + 1] = value.sup();
    }
    return out;
}

struct Map {
    Doubles centers, radii;                             // of the cell, (N,)
    Doubles constants, slopes, new_centers, new_radii;  // x = constants + slopes y, y in the new cell
    bool is_part;                                       // the new cell is known to lie within the old one
};

template <int N, Arithmetic A, int M>
Doubles substituted(const Doubles& models, const Map& map) {
    std::array<TaylorModel<M>, std::size_t(N)> x;
    for (int i = 0; i < N; ++i) {
        auto& xi = x[std::size_t(i)];
        xi = normalised_coordinate<M>(map.centers.data()[i], map.radii.data()[i], map.constants.data()[i],
                                      map.slopes.data() + i * M, map.new_centers.data(), map.new_radii.data());
        if (!map.is_part && !(xi.low() >= -1 && xi.high() <= 1))
            throw std::invalid_argument(
                "TaylorModel: the image of the new cell must lie in the cell, got normalised [" +
                std::to_string(xi.low()) + ", " + std::to_string(xi.high()) + "] along variable " + std::to_string(i));
    }
    const py::ssize_t n = models.size() / Taylor<N, A>::width;
    Doubles out({n, py::ssize_t(Taylor<M, A>::width)});
    for (py::ssize_t i = 0; i < n; ++i)
        Taylor<M, A>::store(substitute(Taylor<N, A>::load(models.data() + i * Taylor<N, A>::width), x),
                            out.mutable_data() + i * Taylor<M, A>::width);
    return out;
}

template <int N, Arithmetic A>
Doubles substituted_for(const Doubles& models, const Map& map) {
    const py::ssize_t m = map.new_centers.size();
    if (map.centers.size() != N || map.constants.size() != N || (m != 2 && m != 4) || map.slopes.size() != N * m)
        throw std::invalid_argument("taylor_substituted: constants must be (N,), slopes (N, 2) or (N, 4)");
    return m == 2 ? substituted<N, A, 2>(models, map) : substituted<N, A, 4>(models, map);
}

// What each kind of model offers besides the operations.
struct Views {
    Doubles (*ranges)(const Doubles&);
    Doubles (*values)(const Doubles&, const Doubles&, const Doubles&, const Doubles&);
    Doubles (*substituted)(const Doubles&, const Map&);
};

std::map<std::string, Views> views;

const Views& views_of(const std::string& kind) {
    const auto found = views.find(kind);
    if (found == views.end()) throw std::invalid_argument("taylor: no such kind of model: '" + kind + "'");
    return found->second;
}

template <int N, Arithmetic A>
void register_taylor(const std::string& name) {
    register_kind<TaylorModel<N, A>>(name);
    views[name] = {&ranges<N, A>, &values<N, A>, &substituted_for<N, A>};
}

Doubles cell_radii(const Doubles& centers, const Doubles& radii, bool derived) {
    if (centers.size() != radii.size()) throw std::invalid_argument("cell_radii: as many radii as centers");
    Doubles out(radii.size());
    for (py::ssize_t i = 0; i < radii.size(); ++i)
        out.mutable_data()[i] = enlarged_radius(centers.data()[i], radii.data()[i], derived ? derived_cell : new_cell);
    return out;
}

Doubles part_radii(const Doubles& centers, const Doubles& radii, const Doubles& part_centers, const Doubles& given) {
    Doubles out(given.size());
    for (py::ssize_t i = 0; i < given.size(); ++i)
        out.mutable_data()[i] =
            part_radius(centers.data()[i], radii.data()[i], part_centers.data()[i], given.data()[i]);
    return out;
}

}  // namespace

void register_taylor_kinds(py::module_& m) {
    register_taylor<2, Arithmetic::real>("taylor_2_real");
    register_taylor<4, Arithmetic::real>("taylor_4_real");
    register_taylor<2, Arithmetic::float32>("taylor_2_float32");
    register_taylor<4, Arithmetic::float32>("taylor_4_float32");
    m.def("cell_radii", &cell_radii, "centers"_a, "radii"_a, "derived"_a);
    m.def("part_radii", &part_radii, "centers"_a, "radii"_a, "part_centers"_a, "part_radii"_a);
    m.def(
        "taylor_ranges", [](const std::string& kind, const Doubles& models) { return views_of(kind).ranges(models); },
        "kind"_a, "models"_a);
    m.def(
        "taylor_values",
        [](const std::string& kind, const Doubles& models, const Doubles& centers, const Doubles& radii,
           const Doubles& points) { return views_of(kind).values(models, centers, radii, points); },
        "kind"_a, "models"_a, "centers"_a, "radii"_a, "points"_a);
    m.def(
        "taylor_substituted",
        [](const std::string& kind, const Doubles& models, const Doubles& centers, const Doubles& radii,
           const Doubles& constants, const Doubles& slopes, const Doubles& new_centers, const Doubles& new_radii,
           bool is_part) {
            return views_of(kind).substituted(models,
                                              {centers, radii, constants, slopes, new_centers, new_radii, is_part});
        },
        "kind"_a, "models"_a, "centers"_a, "radii"_a, "constants"_a, "slopes"_a, "new_centers"_a, "new_radii"_a,
        "is_part"_a);
}

}  // namespace raybound::python
