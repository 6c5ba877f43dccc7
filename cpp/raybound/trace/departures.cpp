// What rays know that leave a hit, or begin anywhere.
#include "raybound/trace/search.h"

namespace raybound {

template <class T>
Departures departures(const Geometry& geometry, const Nearest<T>& nearest) {
    const std::uint32_t none = Departure::none, here = nearest.primitive, within = nearest.within;
    const std::uint32_t leaf = nearest.crossing.leaf;
    const std::int32_t face = nearest.crossing.face;
    const bool for_good = is_left_for_good(geometry, geometry.primitives[here], true);
    if (!is_closed(geometry, geometry.primitives[here])) {
        const Departure both{within, here, leaf, face, for_good};
        return {both, both};
    }
    if (!nearest.crossing.entering) {
        const bool at_once = !(nearest.crossing.t > 0);
        return {{here, none, leaf, face, false}, {within == here ? none : within, here, leaf, face, for_good, at_once}};
    }
    if (!nearest.touching) return {{within, here, leaf, face, for_good}, {here, none, leaf, face, false}};
    const bool other_for_good = is_left_for_good(geometry, geometry.primitives[within], true);
    return {{within, here, leaf, face, for_good}, {here, within, leaf, face, other_for_good}};
}

void visit_containing(const Snapshot& scene, const Vec3f& point, const std::function<void(std::uint32_t)>& visit) {
    const Geometry& geometry = scene.geometry();
    const auto holds = [&](const auto& plane, Pack<float>& near) {
        using P = Pack<float>;
        near = P(0.0f);
        auto inside = (plane(0) <= P(point.x)) & (P(point.x) <= plane(3));
        inside = inside & (plane(1) <= P(point.y)) & (P(point.y) <= plane(4));
        return bits(inside & (plane(2) <= P(point.z)) & (P(point.z) <= plane(5)));
    };
    scene.accelerator().bvh().visit(
        holds, [] { return infinity<float>; },
        [&](std::uint32_t leaf, float) {
            scene.accelerator().visit_primitives(leaf, [&](std::uint32_t index) {
                const Primitive& primitive = geometry.primitives[index];
                for (int i = 0; i < 3; ++i)
                    if (!(primitive.bounds.lower[i] <= point[i] && point[i] <= primitive.bounds.upper[i])) return;
                if (is_closed(geometry, primitive) && contains(geometry, primitive, Vec3d(point))) visit(index);
            });
        });
}

Departure departure_at(const Snapshot& scene, const Vec3f& origin) {
    Departure from;
    int count = 0;
    visit_containing(scene, origin, [&](std::uint32_t primitive) { from.within = primitive, ++count; });
    if (count > 1) from.within = Departure::none;
    return from;
}

template <class T>
T outside_ior(const Snapshot& scene, const Nearest<T>& nearest) {
    if (!nearest.touching) return T(1);
    return T(scene.objects()[scene.geometry().primitives[nearest.within].object].material->ior);
}

template Departures departures(const Geometry&, const Nearest<float>&);
template Departures departures(const Geometry&, const Nearest<double>&);
template float outside_ior(const Snapshot&, const Nearest<float>&);
template double outside_ior(const Snapshot&, const Nearest<double>&);

}  // namespace raybound
