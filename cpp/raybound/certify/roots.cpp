#include "raybound/certify/roots.h"

namespace raybound {

FaceKey key_of_root(const Geometry& geometry, std::uint32_t primitive, std::uint32_t root) {
    const Primitive& p = geometry.primitives[primitive];
    const auto face = std::int32_t(root / roots_of_face);
    const LeafFace at = leaf_of_face(geometry, p, face);
    FaceKey key{primitive,     at.leaf, face - at.face_offset, at.face_offset, int(root % roots_of_face / 2),
                root % 2 == 0, 0};
    key.departed = is_left_for_good(geometry, p, key.outward) ? primitive : Departure::none;
    return key;
}

}  // namespace raybound
