#include "raybound/shapes/depth.h"

#include <algorithm>

#include "raybound/shapes/closest.h"
#include "raybound/shapes/inside.h"
#include "raybound/shapes/leaf.h"

namespace raybound {

namespace {

// How deep a point lies below a face, by F over the size of its gradient.
double depth_below(const Geometry& geometry, const Leaf& leaf, int face, const Vec3d& p) {
    const Surface<double> surface = leaf_surface(geometry, leaf, face, p, Vec3d{0, 0, 1});
    if (surface.form.value == 0) return 0;
    return -surface.form.value / length(surface.gradient);
}

int face_count(const Leaf& leaf) {
    if (leaf.kind == LeafKind::sphere) return 1;
    if (leaf.kind == LeafKind::quadric) return 7;
    return leaf.kind == LeafKind::box ? 6 : 3;
}

double csg_depth(const Geometry& geometry, std::uint32_t root, const Vec3d& p) {
    const std::uint32_t begin = first_node(geometry, root);
    std::vector<double> depth;
    for (std::uint32_t index = begin; index <= root; ++index) {
        const CsgNode& node = geometry.csg_nodes[index];
        if (node.kind == CsgKind::leaf) {
            depth.push_back(leaf_depth(geometry, geometry.leaves[node.first], p));
            continue;
        }
        const auto of_child = [&](std::uint32_t i) { return depth[geometry.csg_children[node.first + i] - begin]; };
        double all = of_child(0);
        for (std::uint32_t i = 1; i < node.count; ++i) {
            if (node.kind == CsgKind::csg_union) all = std::max(all, of_child(i));
            if (node.kind == CsgKind::csg_intersection) all = std::min(all, of_child(i));
            if (node.kind == CsgKind::csg_difference) all = std::min(all, -of_child(i));
        }
        depth.push_back(all);
    }
    return depth.back();
}

// By the distance to the nearest face, and the parity of crossings along some line.
double mesh_distance(const Geometry& geometry, const Leaf& leaf, const Vec3d& p) {
    const MeshData& mesh = *geometry.meshes[leaf.polygon].data;
    const auto& [linear, offset] = geometry.meshes[leaf.polygon].placement;
    double least = infinity<double>;
    for (std::size_t i = 0; i < mesh.faces().size(); ++i) {
        Corners<double> c = mesh.corners<double>(std::int32_t(i));
        c = {linear * c.a + offset, linear * c.b + offset, linear * c.c + offset};
        const CornerWeights w = closest_weights(c, p);
        least = std::min(least, length(c.a * w.a + c.b * w.b + c.c * w.c - p));
    }
    return least;
}

bool mesh_contains(const Geometry& geometry, const Primitive& primitive, const Vec3d& p) {
    const Ray<double> up{p, {0, 0, 1}};
    for (const Stretch& stretch : stretches_of(geometry, primitive, up))
        if (stretch.in.t <= 0 && stretch.out.t > 0) return true;
    return false;
}

}  // namespace

double leaf_depth(const Geometry& geometry, const Leaf& leaf, const Vec3d& p) {
    double least = infinity<double>;
    for (int face = 0; face < face_count(leaf); ++face) least = std::min(least, depth_below(geometry, leaf, face, p));
    return least;
}

double depth_of(const Geometry& geometry, const Primitive& primitive, const Vec3d& p) {
    if (primitive.is_csg) return csg_depth(geometry, primitive.root, p);
    const Leaf& leaf = geometry.leaves[primitive.root];
    if (leaf.kind != LeafKind::mesh) return leaf_depth(geometry, leaf, p);
    return mesh_distance(geometry, leaf, p) * (mesh_contains(geometry, primitive, p) ? 1 : -1);
}

bool contains(const Geometry& geometry, const Primitive& primitive, const Vec3d& p) {
    if (is_mesh(geometry, primitive)) return mesh_contains(geometry, primitive, p);
    return depth_of(geometry, primitive, p) >= 0;
}

}  // namespace raybound
