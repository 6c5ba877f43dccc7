// Where rays begin, as scripts say it: arrays of points, or records of hits.
#pragma once

#include "bindings/arrays.h"
#include "raybound/frame/hit_record.h"

namespace raybound::python {

// Calls use(origins). `who` is named by errors.
template <class Use>
auto with_origins(const char* who, const Snapshot& scene, const py::array& origins, const Use& use) {
    if (!origins.dtype().has_fields()) {
        const auto points = Floats::ensure(origins);
        if (!points) throw py::error_already_set();
        return use(RayOrigins(scene, to_vectors<float>(points)));
    }
    const auto records = py::array_t<HitRecord, py::array::c_style>::ensure(origins);
    if (!records || !origins.dtype().is(py::dtype::of<HitRecord>()))
        throw std::invalid_argument(std::string(who) + ": origins must be points or the records of an intersect");
    return use(RayOrigins(scene, std::span<const HitRecord>(records.data(), std::size_t(records.size())), who));
}

}  // namespace raybound::python
