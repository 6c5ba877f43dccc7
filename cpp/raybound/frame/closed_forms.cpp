#include "raybound/frame/closed_forms.h"

#include <stdexcept>

#include "raybound/frame/user_rays.h"
#include "raybound/shapes/closed_form.h"

namespace raybound {

namespace {

template <class T>
ClosedFormRecord record_of(const Geometry& geometry, const WideRay<T>& ray) {
    ClosedFormRecord record{};
    const Primitive& primitive = geometry.primitives.front();
    if (primitive.is_csg) return record;
    const Crossing<Wide<T>> crossing = first_crossing(geometry, primitive, ray);
    if (!crossing.hit) return record;
    const std::optional<WithError<T>> at = closed_form(geometry, crossing, ray);
    if (!at) return record;
    record.known = true;
    for (int i = 0; i < 3; ++i) {
        record.point[i] = double(at->value[i]);
        record.point_error[i] = double(at->error[i]);
    }
    return record;
}

}  // namespace

template <class T>
std::vector<ClosedFormRecord> closed_forms(const Shape& shape, std::span<const Vec3d> origins,
                                           std::span<const Vec3d> directions) {
    require_directions<T>("closed_forms", directions);
    Geometry geometry;
    add_primitive(geometry, 0, shape, {});
    std::vector<ClosedFormRecord> records;
    records.reserve(origins.size());
    for (std::size_t i = 0; i < origins.size(); ++i) {
        Vec3<T> direction(directions[i]);
        T scale;
        scale_direction(direction, scale);
        records.push_back(record_of(geometry, WideRay<T>(Vec3<T>(origins[i]), direction)));
    }
    return records;
}

template std::vector<ClosedFormRecord> closed_forms<float>(const Shape&, std::span<const Vec3d>,
                                                           std::span<const Vec3d>);
template std::vector<ClosedFormRecord> closed_forms<double>(const Shape&, std::span<const Vec3d>,
                                                            std::span<const Vec3d>);

}  // namespace raybound
