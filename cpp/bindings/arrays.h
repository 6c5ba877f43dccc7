// NumPy arrays and the engine's vectors.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstring>
#include <span>
#include <stdexcept>

#include "raybound/frame/work_queue.h"
#include "raybound/geometry/matrix.h"

namespace raybound::python {

namespace py = pybind11;
using namespace pybind11::literals;

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Vec3d) == 3 * sizeof(double));

template <class T>
Vec3<T> to_vec3(const py::array_t<T, py::array::c_style | py::array::forcecast>& a) {
    if (a.ndim() != 1 || a.shape(0) != 3) throw std::invalid_argument("expected an array of shape (3,)");
    return {a.data()[0], a.data()[1], a.data()[2]};
}

// An (n,3) array seen as vectors; the array must outlive the span.
template <class T>
std::span<const Vec3<T>> to_vectors(const py::array_t<T, py::array::c_style | py::array::forcecast>& a) {
    if (a.ndim() != 2 || a.shape(1) != 3) throw std::invalid_argument("expected an array of shape (n, 3)");
    return {reinterpret_cast<const Vec3<T>*>(a.data()), std::size_t(a.shape(0))};
}

template <class T>
py::array_t<T> from_vec3(const Vec3<T>& v) {
    py::array_t<T> a(3);
    for (int i = 0; i < 3; ++i) a.mutable_data()[i] = v[i];
    return a;
}

template <class T>
py::array_t<T> from_vectors(const std::vector<Vec3<T>>& v) {
    py::array_t<T> a({py::ssize_t(v.size()), py::ssize_t(3)});
    std::copy(v.begin(), v.end(), reinterpret_cast<Vec3<T>*>(a.mutable_data()));
    return a;
}

template <class T>
py::array_t<T> from_vector(const std::vector<T>& v) {
    py::array_t<T> a(py::ssize_t(v.size()));
    if (!v.empty()) std::memcpy(a.mutable_data(), v.data(), v.size() * sizeof(T));  // with the padding of records
    return a;
}

// A 4x4 matrix; throws in the name of `who` if it is not affine.
inline Affine to_affine(const std::string& who, const Doubles& m) {
    if (m.ndim() != 2 || m.shape(0) != 4 || m.shape(1) != 4)
        throw std::invalid_argument(who + ": matrix must have shape (4, 4)");
    const double* e = m.data();
    if (e[12] != 0 || e[13] != 0 || e[14] != 0 || e[15] != 1)
        throw std::invalid_argument(who + ": matrix must be affine, its last row must be (0, 0, 0, 1)");
    return {{{e[0], e[1], e[2]}, {e[4], e[5], e[6]}, {e[8], e[9], e[10]}}, {e[3], e[7], e[11]}};
}

inline Doubles from_affine(const Affine& a) {
    Doubles m({4, 4});
    double* e = m.mutable_data();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) e[4 * i + j] = a.linear.row[i][j];
        e[4 * i + 3] = a.offset[i];
    }
    e[12] = e[13] = e[14] = 0;
    e[15] = 1;
    return m;
}

template <class Bounds>
Doubles from_bounds(const Bounds& box) {
    Doubles a({2, 3});
    for (int i = 0; i < 3; ++i) {
        a.mutable_data()[i] = box.lower[i];
        a.mutable_data()[3 + i] = box.upper[i];
    }
    return a;
}

// Called with the GIL released; takes it to look at signals and to tell the caller how far the work is.
inline Watch watcher(const py::object& progress) {
    return [&progress](double fraction) {
        const py::gil_scoped_acquire acquired;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (!progress.is_none()) progress(fraction);
    };
}

void register_numbers(py::module_& m);
void register_number_kinds(py::module_& m);
void register_cells(py::module_& m);
void register_running_errors(py::module_& m);
void register_elementary_ranges(py::module_& m);
void register_intervals(py::module_& m);
void register_number_bench(py::module_& m);
void register_transforms(py::module_& m);
void register_shapes(py::module_& m);
void register_materials(py::module_& m);
void register_scene(py::module_& m);
void register_camera(py::module_& m);
void register_surface_cells(py::module_& m);
void register_render(py::module_& m);
void register_packs(py::module_& m);

}  // namespace raybound::python
