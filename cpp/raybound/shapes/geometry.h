// The shapes of a scene in the form that rays meet: flat arrays of leaves, in world coordinates.
#pragma once

#include <span>
#include <vector>

#include "raybound/shapes/mesh.h"
#include "raybound/shapes/polygon.h"
#include "raybound/shapes/quadric.h"

namespace raybound {

enum class LeafKind : std::uint8_t { sphere, box, cylinder, cone, disk, polygon, quadric, mesh };

// The map y = A (x - center) from the world to a leaf's own coordinates, in which the shape has the size R, a power of
// two near its size in the world. The *double* map is the truth; the float one approximates it within the errors that
// LocalRay carries.
struct Frame {
    Mat3<float> linear;
    Vec3f center;
    float radius = 1;
    Vec3f row_norm{1, 1, 1};  // the row sums of |A|, rounded up
    Mat3<double> linear_wide;
    Vec3d center_wide;
    double slope = 0;         // of a cone
    double top_radius = 0;    // of a cone, in its own coordinates
    double inverse_norm = 1;  // of A^-1: how far a local distance reaches in the world
};

// A primitive, convex but for quadrics. Without a frame it stands in world coordinates, placed in double: a sphere
// (first, radius()), a box (first, second), a polygon. surface_error bounds how far the surface that the leaf describes
// is from the one the user described.
struct Leaf {
    LeafKind kind = LeafKind::sphere;
    bool is_complement = false;  // taken away by a CSG difference: its own outside is the object's inside
    std::int32_t frame = -1;
    std::uint32_t polygon = 0;  // index into polygons, quadrics or meshes
    float surface_error = 0;
    Vec3d first, second;

    double radius() const { return second.x; }  // of a sphere
};
static_assert(sizeof(Leaf) == 64);

// A mesh in its place; the data are the shape's.
struct MeshInstance {
    const MeshData* data;
    Affine placement;
};

inline bool is_sheet(const Leaf& leaf) { return leaf.kind == LeafKind::disk || leaf.kind == LeafKind::polygon; }

// (What is curved of a solid is its face 0.)
inline bool is_flat_face(const Leaf& leaf, int face) {
    return face != 0 || leaf.kind == LeafKind::box || leaf.kind == LeafKind::mesh || is_sheet(leaf);
}

// Does a face's chart go around: u once around an axis, back to where it began, and v from one end to the other?
inline bool goes_around(const Leaf& leaf, int face) {
    if (face != 0) return false;
    return leaf.kind == LeafKind::sphere || leaf.kind == LeafKind::cylinder || leaf.kind == LeafKind::cone ||
           leaf.kind == LeafKind::quadric;
}

enum class CsgKind : std::uint8_t { leaf, csg_union, csg_intersection, csg_difference };

// A node of a CSG expression: a leaf (index `first`) or `count` nodes that start at `first` in csg_children.
// Expressions may be of any height (levels above the leaves): what recurses may do so up to `most_height` less one.
struct CsgNode {
    static constexpr std::uint8_t most_height = 255;  // that, or more

    CsgKind kind = CsgKind::leaf;
    std::uint8_t height = 0;
    std::uint32_t first = 0, count = 0;
    std::int32_t face_offset = 0;
};

// What the BVH holds, one for each object: a single leaf, or a CSG expression. Rays meet it only where they cross its
// bounds: that is part of what a hit *is*, so any traversal that is conservative finds the same hits.
struct Primitive {
    Box bounds;
    std::uint32_t object = 0;
    std::uint32_t root : 31 = 0;  // of leaves, or of CSG nodes
    bool is_csg : 1 = false;
};
static_assert(sizeof(Primitive) == 32);

struct Geometry {
    std::vector<Primitive> primitives;
    std::vector<Leaf> leaves;
    std::vector<Frame> frames;
    std::vector<PolygonPlane> polygons;
    std::vector<Vec3d> vertices;
    std::vector<MeshInstance> meshes;
    std::vector<Quadric> quadrics;
    std::vector<CsgNode> csg_nodes;
    std::vector<std::uint32_t> csg_children;

    std::span<const Vec3d> polygon_vertices(const PolygonPlane& p) const {
        return {vertices.data() + p.first_vertex, p.vertex_count};
    }
    bool is_high(std::uint32_t csg_node) const { return csg_nodes[csg_node].height == CsgNode::most_height; }
    std::size_t bytes() const;
};

// Does the primitive enclose a volume? (All but disks, polygons and meshes with a border.)
inline bool is_closed(const Geometry& geometry, const Primitive& primitive) {
    if (primitive.is_csg) return true;
    const Leaf& leaf = geometry.leaves[primitive.root];
    return leaf.kind == LeafKind::mesh ? geometry.meshes[leaf.polygon].data->is_closed() : !is_sheet(leaf);
}

// The leaf of a primitive's face, and the number of the leaf's first face.
struct LeafFace {
    std::uint32_t leaf;
    std::int32_t face_offset;
};
LeafFace leaf_of_face(const Geometry& geometry, const Primitive& primitive, std::int32_t face);

// Adds a placed shape as one primitive of `object`. Throws std::invalid_argument if it cannot be placed so.
void add_primitive(Geometry& geometry, std::uint32_t object, const Shape& shape, const Affine& placement);

// Gives a primitive another shape or place. What it was made of before stays behind, unused.
void replace_primitive(Geometry& geometry, std::uint32_t primitive, const Shape& shape, const Affine& placement);

}  // namespace raybound
