#include "raybound/scene/accelerator.h"

#include <algorithm>

namespace raybound {

namespace {

void fill(SpherePack& pack, std::uint32_t lane, const Leaf& leaf) {
    for (int axis = 0; axis < 3; ++axis) pack.center[axis][lane] = float(leaf.first[axis]);
    pack.radius[lane] = float(leaf.radius());
}

void fill(TrianglePack& pack, std::uint32_t lane, std::span<const Vec3d> vertices) {
    for (int corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis) {
            const double exact = vertices[std::size_t(corner)][axis];
            pack.corner[corner][axis][lane] = float(exact);
            const double error = std::abs(double(float(exact)) - exact);
            if (error > 0) pack.error = maximum(pack.error, next_float_up(float(error)));
        }
}

}  // namespace

Accelerator::Kind Accelerator::kind_of(const Geometry& geometry, std::uint32_t primitive) {
    const Primitive& p = geometry.primitives[primitive];
    if (p.is_csg) return Kind::single;
    const Leaf& leaf = geometry.leaves[p.root];
    if (leaf.kind == LeafKind::sphere && leaf.frame < 0) return Kind::spheres;
    if (leaf.kind == LeafKind::polygon && geometry.polygons[leaf.polygon].vertex_count == 3) return Kind::triangles;
    return Kind::single;
}

Accelerator::Accelerator(const Geometry& geometry) : places_(geometry.primitives.size()) {
    std::vector<Box> boxes;
    boxes.reserve(geometry.primitives.size());
    for (const Primitive& primitive : geometry.primitives) boxes.push_back(primitive.bounds);
    const Bvh::Leaves leaves{
        [&](std::uint32_t item) { return int(kind_of(geometry, item)); },
        [](int kind) { return Kind(kind) == Kind::single ? 1 : pack_width; },
        [&](std::span<const std::uint32_t> items, std::uint32_t slot) { return make_leaf(geometry, items, slot); }};
    bvh_ = Bvh(boxes, leaves);
    built_cost_ = bvh_.cost();
    spheres_.shrink_to_fit();
    triangles_.shrink_to_fit();
}

std::uint32_t Accelerator::make_leaf(const Geometry& geometry, std::span<const std::uint32_t> items,
                                     std::uint32_t slot) {
    const Kind kind = kind_of(geometry, items[0]);
    std::uint32_t index = items[0];
    if (kind == Kind::spheres) index = std::uint32_t(spheres_.size()), spheres_.emplace_back();
    if (kind == Kind::triangles) index = std::uint32_t(triangles_.size()), triangles_.emplace_back();
    const std::uint32_t leaf = std::uint32_t(kind) << kind_shift | index;
    for (std::size_t lane = 0; lane < items.size(); ++lane) {
        places_[items[lane]] = {leaf, slot, std::uint8_t(lane)};
        fill_lane(geometry, items[lane], kind);
    }
    return leaf;
}

void Accelerator::fill_lane(const Geometry& geometry, std::uint32_t primitive, Kind kind) {
    if (kind == Kind::single) return;
    const Place& place = places_[primitive];
    const Leaf& leaf = geometry.leaves[geometry.primitives[primitive].root];
    const std::uint32_t index = place.leaf & index_mask;
    if (kind == Kind::spheres) {
        fill(spheres_[index], place.lane, leaf);
        spheres_[index].id[place.lane] = primitive;
        spheres_[index].lanes |= 1u << place.lane;
    } else {
        fill(triangles_[index], place.lane, geometry.polygon_vertices(geometry.polygons[leaf.polygon]));
        triangles_[index].id[place.lane] = primitive;
        triangles_[index].lanes |= 1u << place.lane;
    }
}

bool Accelerator::update(const Geometry& geometry, std::uint32_t primitive) {
    const Place& place = places_[primitive];
    const auto kind = Kind(place.leaf >> kind_shift);
    if (kind_of(geometry, primitive) != kind) return false;
    fill_lane(geometry, primitive, kind);
    Box box = geometry.primitives[primitive].bounds;
    const std::uint32_t index = place.leaf & index_mask;
    const auto add = [&](const auto& pack) {
        for (std::uint32_t lanes = pack.lanes; lanes != 0;)
            box.extend(geometry.primitives[pack.id[bvh::take_lowest(lanes)]].bounds);
    };
    if (kind == Kind::spheres) add(spheres_[index]);
    if (kind == Kind::triangles) add(triangles_[index]);
    bvh_.refit(place.slot, box);
    return true;
}

std::size_t Accelerator::bytes() const {
    return bvh_.bytes() + spheres_.capacity() * sizeof(SpherePack) + triangles_.capacity() * sizeof(TrianglePack) +
           places_.capacity() * sizeof(Place);
}

}  // namespace raybound
