#include "raybound/certify/roots.h"

namespace raybound {

namespace {

// The leaf of an object's face, and the number of its first face.
struct LeafFace {
    std::uint32_t leaf;
    std::int32_t face_offset;
};
LeafFace leaf_of_face(const Geometry& geometry, std::uint32_t node_index, std::int32_t face) {
    const CsgNode& node = geometry.csg_nodes[node_index];
    if (node.kind == CsgKind::leaf) return {node.first, node.face_offset};
    // Faces count one after the other: the last child that begins at the face or before.
    const auto first_face = [&](std::uint32_t index) {
        while (geometry.csg_nodes[index].kind != CsgKind::leaf)
            index = geometry.csg_children[geometry.csg_nodes[index].first];
        return geometry.csg_nodes[index].face_offset;
    };
    std::uint32_t child = geometry.csg_children[node.first];
    for (std::uint32_t i = 1; i < node.count; ++i) {
        const std::uint32_t next = geometry.csg_children[node.first + i];
        if (first_face(next) > face) break;
        child = next;
    }
    return leaf_of_face(geometry, child, face);
}

}  // namespace

FaceKey key_of_root(const Geometry& geometry, std::uint32_t primitive, std::uint32_t root) {
    const Primitive& p = geometry.primitives[primitive];
    const auto face = std::int32_t(root / roots_of_face);
    const LeafFace at = p.is_csg ? leaf_of_face(geometry, p.root, face) : LeafFace{p.root, 0};
    FaceKey key{primitive,     at.leaf, face - at.face_offset, at.face_offset, int(root % roots_of_face / 2),
                root % 2 == 0, 0};
    key.departed = is_left_for_good(geometry, p, key.outward) ? primitive : Departure::none;
    return key;
}

}  // namespace raybound
