#include "bindings/arrays.h"
#include "raybound/trace/cell_trials.h"

namespace raybound::python {

namespace {

void require_dimensions(int n) {
    if (n != 2 && n != 4) throw std::invalid_argument("cells: n must be 2 or 4, got " + std::to_string(n));
}

py::dict cell_trials(int n, std::int64_t cells, std::int64_t points, std::uint64_t seed) {
    require_dimensions(n);
    CellTrials trials;
    {
        const py::gil_scoped_release released;
        trials = run_cell_trials(n, cells, points, seed);
    }
    return py::dict("cells"_a = trials.cells, "bounded"_a = trials.bounded, "far"_a = trials.far,
                    "grazing"_a = trials.grazing, "points"_a = trials.points, "float_outside"_a = trials.float_outside,
                    "double_outside"_a = trials.double_outside, "largest_share"_a = trials.largest_share,
                    "widest"_a = trials.widest);
}

std::tuple<double, double> cell_times(int n, int rounds) {
    require_dimensions(n);
    const py::gil_scoped_release released;
    const CellTimes times = time_cells(n, rounds);
    return {times.plain, times.taylor};
}

}  // namespace

void register_cells(py::module_& m) {
    m.def("cell_trials", &cell_trials, "n"_a, "cells"_a, "points"_a, "seed"_a);
    m.def("cell_times", &cell_times, "n"_a, "rounds"_a);
}

}  // namespace raybound::python
