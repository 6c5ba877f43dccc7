// How deep points lie in solids.
#pragma once

#include "raybound/shapes/geometry.h"

namespace raybound {

// How deep a point lies inside a solid leaf that is no mesh, to first order near its surface; negative outside.
double leaf_depth(const Geometry& geometry, const Leaf& leaf, const Vec3d& p);

// The same for a closed primitive.
double depth_of(const Geometry& geometry, const Primitive& primitive, const Vec3d& p);

// Is a point inside a closed primitive? The sign of its depth, or for meshes the parity of crossings.
bool contains(const Geometry& geometry, const Primitive& primitive, const Vec3d& p);

inline bool is_mesh(const Geometry& geometry, const Primitive& primitive) {
    return !primitive.is_csg && geometry.leaves[primitive.root].kind == LeafKind::mesh;
}

// The first node of an expression: they stand in a row, each after its children, the root last.
inline std::uint32_t first_node(const Geometry& geometry, std::uint32_t root) {
    while (geometry.csg_nodes[root].kind != CsgKind::leaf) root = geometry.csg_children[geometry.csg_nodes[root].first];
    return root;
}

}  // namespace raybound
