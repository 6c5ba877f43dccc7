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

Accelerator::Accelerator(const Geometry& geometry, Lookout& lookout) {
    std::vector<Box> boxes;
    boxes.reserve(geometry.primitives.size());
    for (const Primitive& primitive : geometry.primitives) boxes.push_back(primitive.bounds);
    const Bvh::Leaves leaves{[&](std::uint32_t item) { return int(kind_of(geometry, item)); },
                             [](int kind) { return Kind(kind) == Kind::single ? 1 : pack_width; },
                             [&](std::span<const std::uint32_t> items) { return make_leaf(geometry, items); }};
    bvh_ = Bvh(boxes, leaves, lookout);
    built_cost_ = bvh_.cost();
    spheres_.shrink_to_fit();
    triangles_.shrink_to_fit();
}

std::uint32_t Accelerator::make_leaf(const Geometry& geometry, std::span<const std::uint32_t> items) {
    const Kind kind = kind_of(geometry, items[0]);
    std::uint32_t index = items[0];
    if (kind == Kind::spheres) index = std::uint32_t(spheres_.size()), spheres_.emplace_back();
    if (kind == Kind::triangles) index = std::uint32_t(triangles_.size()), triangles_.emplace_back();
    const std::uint32_t leaf = std::uint32_t(kind) << kind_shift | index;
    for (std::uint32_t lane = 0; lane < items.size(); ++lane) fill_lane(geometry, items[lane], leaf, lane);
    return leaf;
}

void Accelerator::fill_lane(const Geometry& geometry, std::uint32_t primitive, std::uint32_t at, std::uint32_t lane) {
    const auto kind = Kind(at >> kind_shift);
    if (kind == Kind::single) return;
    const Leaf& leaf = geometry.leaves[geometry.primitives[primitive].root];
    const std::uint32_t index = at & index_mask;
    if (kind == Kind::spheres) {
        fill(spheres_[index], lane, leaf);
        spheres_[index].id[lane] = primitive;
        spheres_[index].lanes |= 1u << lane;
    } else {
        fill(triangles_[index], lane, geometry.polygon_vertices(geometry.polygons[leaf.polygon]));
        triangles_[index].id[lane] = primitive;
        triangles_[index].lanes |= 1u << lane;
    }
}

void Accelerator::find_places(std::size_t primitives) {
    places_.resize(primitives);
    const auto nodes = bvh_.nodes();
    for (std::uint32_t slot = 0; slot < nodes.size() * pack_width; ++slot) {
        const BvhNode& node = nodes[slot / pack_width];
        const std::uint32_t child = node.child[slot % pack_width], leaf = child & ~Bvh::leaf_bit;
        if (!(child & Bvh::leaf_bit) || node.plane[0][slot % pack_width] == infinity<float>) continue;
        const std::uint32_t index = leaf & index_mask;
        const auto add = [&](const auto& pack) {
            for (std::uint32_t lanes = pack.lanes; lanes != 0;) {
                const int lane = bvh::take_lowest(lanes);
                places_[pack.id[lane]] = {leaf, slot, std::uint8_t(lane)};
            }
        };
        if (Kind(leaf >> kind_shift) == Kind::single) places_[index] = {leaf, slot, 0};
        if (Kind(leaf >> kind_shift) == Kind::spheres) add(spheres_[index]);
        if (Kind(leaf >> kind_shift) == Kind::triangles) add(triangles_[index]);
    }
}

bool Accelerator::update(const Geometry& geometry, std::uint32_t primitive) {
    if (places_.empty()) find_places(geometry.primitives.size());
    const Place& place = places_[primitive];
    const auto kind = Kind(place.leaf >> kind_shift);
    if (kind_of(geometry, primitive) != kind) return false;
    fill_lane(geometry, primitive, place.leaf, place.lane);
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
