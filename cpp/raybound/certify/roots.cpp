#include "raybound/certify/roots.h"

namespace raybound {

namespace {

// The leaf of an object's face, and the number of its first face.
struct LeafFace {
    std::uint32_t leaf;
    std::int32_t face_offset;
};
// Faces count one after the other: they are those of the last child that begins at the face or before.
LeafFace leaf_of_face(const Geometry& geometry, std::uint32_t index, std::int32_t face) {
    const auto first_face = [&](std::uint32_t at) {
        while (geometry.csg_nodes[at].kind != CsgKind::leaf) at = geometry.csg_children[geometry.csg_nodes[at].first];
        return geometry.csg_nodes[at].face_offset;
    };
    for (;;) {
        const CsgNode& node = geometry.csg_nodes[index];
        if (node.kind == CsgKind::leaf) return {node.first, node.face_offset};
        index = geometry.csg_children[node.first];
        for (std::uint32_t i = 1; i < node.count; ++i) {
            const std::uint32_t next = geometry.csg_children[node.first + i];
            if (first_face(next) > face) break;
            index = next;
        }
    }
}

}  // namespace

FaceKey key_of_root(const Geometry& geometry, std::uint32_t primitive, std::uint32_t root) {
    const Primitive& p = geometry.primitives[primitive];
    const auto face = std::int32_t(root / roots_of_face);
    const LeafFace at = p.is_csg ? leaf_of_face(geometry, p.root, face) : LeafFace{p.root, 0};
    FaceKey key{primitive,     at.leaf, face - at.face_offset, at.face_offset, int(root % roots_of_face / 2),
                root % 2 == 0, 0};
    key.departed = departure(geometry, primitive, key.outward).primitive;
    return key;
}

}  // namespace raybound
