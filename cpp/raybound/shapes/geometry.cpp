#include "raybound/shapes/geometry.h"

#include <algorithm>
#include <stdexcept>

#include "raybound/shapes/unit_quadric.h"

namespace raybound {

namespace {

bool is_scaled_identity(const Mat3<double>& m) {
    return m == Mat3<double>({m.row[0].x, 0, 0}, {0, m.row[0].x, 0}, {0, 0, m.row[0].x}) && m.row[0].x > 0;
}
bool is_positive_diagonal(const Mat3<double>& m) {
    return m == Mat3<double>({m.row[0].x, 0, 0}, {0, m.row[1].y, 0}, {0, 0, m.row[2].z}) && m.row[0].x > 0 &&
           m.row[1].y > 0 && m.row[2].z > 0;
}

// What placing a point in double may be off; nothing where the map does nothing.
float placement_error(const Affine& placement, const Vec3d& p) {
    if (placement.is_identity()) return 0;
    const double reach = norm_infinity(placement.linear) * norm1(p) + norm1(placement.offset);
    return next_float_up(float(0x1p-50 * reach));
}

LeafKind leaf_kind(ShapeKind kind) { return static_cast<LeafKind>(kind); }
static_assert(static_cast<int>(LeafKind::mesh) == static_cast<int>(ShapeKind::mesh));

// R, the power of two at the mean column length of the map from unit coordinates to the world.
double frame_radius(const Affine& unit) {
    const Vec3d c0 = unit.linear.column(0), c1 = unit.linear.column(1), c2 = unit.linear.column(2);
    const double least = minimum(minimum(length(c0), length(c1)), length(c2));
    if (!(least >= 0.5 * double(least_size)))
        throw std::invalid_argument("Shape: transforms must keep sizes at least 2**-60, got " + format(least));
    return power_of_two_below(std::cbrt(length(c0)) * std::cbrt(length(c1)) * std::cbrt(length(c2)));
}

// A' = R B^-1 with B the map from unit coordinates to the world.
Frame make_frame(const Affine& unit, double radius, double top_ratio) {
    Frame frame;
    const Mat3<double> inverted = inverse(unit.linear);
    for (int i = 0; i < 3; ++i) frame.linear_wide.row[i] = inverted.row[i] * radius;
    frame.center_wide = unit.offset;
    frame.linear = Mat3<float>(frame.linear_wide);
    frame.center = Vec3f(frame.center_wide);
    frame.radius = float(radius);
    for (int i = 0; i < 3; ++i)
        frame.row_norm[i] = next_float_up(float(norm1(frame.linear_wide.row[i]) * (1 + 0x1p-40)));
    frame.slope = 1 - top_ratio;
    frame.top_radius = top_ratio * radius;
    frame.inverse_norm = norm_infinity(unit.linear) / radius * (1 + 0x1p-40);
    return frame;
}

// How far the frame's surface can be from the description's (derivation D5): the residual A B - R 1 is measured, with
// its own rounding and that of composing B; a point of the unit shape is moved by no more than each column times it.
float frame_surface_error(const Frame& frame, const Affine& unit) {
    const Mat3<double> product = frame.linear_wide * unit.linear;
    const Mat3<double> size = absolute(frame.linear_wide) * absolute(unit.linear);
    const double radius = frame.radius;
    double moved = 0x1p-50 * norm1(unit.offset);
    for (int i = 0; i < 3; ++i) {
        double residual = 0;
        for (int j = 0; j < 3; ++j)
            residual += std::abs(product.row[i][j] - (i == j ? radius : 0)) + 0x1p-50 * size.row[i][j];
        moved += residual / radius * length(unit.linear.column(i));
    }
    return next_float_up(float(moved));
}

PolygonPlane make_plane(const std::vector<Vec3d>& v) {
    const Vec3d normal = newell_normal(v);
    const Vec3d a = absolute(normal);
    PolygonPlane plane;
    plane.axis = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
    plane.slope_i = normal[(plane.axis + 1) % 3] / normal[plane.axis];
    plane.slope_j = normal[(plane.axis + 2) % 3] / normal[plane.axis];
    plane.orientation = normal[plane.axis] > 0 ? 1.0f : -1.0f;
    const Vec3d u = normalize(v[1] - v[0]), w = cross(normalize(normal), u);
    double u_low = 0, u_high = 0, w_low = 0, w_high = 0;
    for (const Vec3d& p : v) {
        const Vec3d r = p - v[0];
        u_low = std::min(u_low, dot(u, r)), u_high = std::max(u_high, dot(u, r));
        w_low = std::min(w_low, dot(w, r)), w_high = std::max(w_high, dot(w, r));
    }
    plane.u_axis = Vec3f(u * (1 / (u_high - u_low)));
    plane.v_axis = Vec3f(w * (1 / (w_high - w_low)));
    plane.u_offset = float(-u_low / (u_high - u_low));
    plane.v_offset = float(-w_low / (w_high - w_low));
    return plane;
}

void place_polygon(Geometry& geometry, Leaf& leaf, const Shape& shape, const Affine& placement) {
    std::vector<Vec3d> placed;
    for (const Vec3f& v : shape.vertices()) {
        placed.push_back(placement.point(Vec3d(v)));
        leaf.surface_error = maximum(leaf.surface_error, placement_error(placement, Vec3d(v)));
    }
    PolygonPlane plane = make_plane(placed);
    if (determinant(placement.linear) < 0) plane.orientation = -plane.orientation;  // a mirror keeps outside outside
    if (!is_finite(Vec3d(plane.slope_i, plane.slope_j, 0)) || !is_finite(plane.u_axis) || !is_finite(plane.v_axis))
        throw std::invalid_argument("Polygon: the transform must keep the vertices apart, they collapse in double");
    plane.first_vertex = std::uint32_t(geometry.vertices.size());
    plane.vertex_count = std::uint32_t(placed.size());
    // The plane passes through the first vertex; the user may have rounded the others off it.
    for (const Vec3d& v : placed) {
        const double off = plane_form(plane, placed[0], v).value;
        leaf.surface_error = maximum(leaf.surface_error, next_float_up(float(std::abs(off))));
    }
    leaf.polygon = std::uint32_t(geometry.polygons.size());
    geometry.vertices.insert(geometry.vertices.end(), placed.begin(), placed.end());
    geometry.polygons.push_back(plane);
}

// A mesh keeps its own coordinates: R = 1. Its reach stands for the unit shape's.
void place_mesh(Geometry& geometry, Leaf& leaf, const Shape& shape, const Affine& placement) {
    leaf.polygon = std::uint32_t(geometry.meshes.size());
    geometry.meshes.push_back({shape.mesh().get(), placement});
    if (placement.is_identity()) return;
    const Frame frame = make_frame(placement, 1, 1);
    const double extent = max_component(Vec3d(shape.mesh()->bounds().extent()));
    if (!(extent / norm_infinity(frame.linear_wide) >= double(least_size)))
        throw std::invalid_argument("Mesh: transforms must keep sizes at least 2**-60");
    const double growth = norm_infinity(placement.linear), shrinking = norm_infinity(frame.linear_wide);
    if (!(growth <= 0x1p60 && shrinking <= 0x1p60))  // so that rays stay in range in the mesh's coordinates
        throw std::invalid_argument("Mesh: transforms must scale by 2**-60 to 2**60");
    const double moved = double(frame_surface_error(frame, {placement.linear, {}})) * double(shape.mesh()->reach());
    leaf.surface_error = next_float_up(float(moved + 0x1p-50 * norm1(placement.offset)));
    leaf.frame = std::int32_t(geometry.frames.size());
    geometry.frames.push_back(frame);
}

// The largest row sums of |A| |B| / R and of |A| |center|, which bound what the frame's rounding does (derivation D7).
Quadric make_quadric(const Shape& shape, const Frame& frame, const Affine& unit) {
    Quadric quadric = local_quadric(unit_quadric(shape), frame.radius);
    const Mat3<double> size = absolute(frame.linear_wide);
    quadric.stretch = norm_infinity(size * absolute(unit.linear)) / double(frame.radius);
    quadric.center = max_component(size * absolute(frame.center_wide));
    return quadric;
}

// Spheres under a similarity without rotation, and boxes under translation and scaling, need no frame.
bool place_in_world(Leaf& leaf, const Shape& shape, const Affine& placement) {
    const bool sphere = shape.kind() == ShapeKind::sphere && is_scaled_identity(placement.linear);
    const bool box = shape.kind() == ShapeKind::box && is_positive_diagonal(placement.linear);
    if (!sphere && !box) return false;
    const Vec3d first(shape.first()), second(shape.second());
    leaf.first = placement.point(first);
    leaf.surface_error = placement_error(placement, first);
    if (sphere) {
        leaf.second.x = placement.linear.row[0].x * double(shape.radius());
        leaf.surface_error += placement_error(placement, {double(shape.radius()), 0, 0});
    } else {
        leaf.second = placement.point(second);
        leaf.surface_error = maximum(leaf.surface_error, placement_error(placement, second));
    }
    const double size = sphere ? leaf.radius() : min_component(leaf.second - leaf.first);
    if (!(size >= 0.5 * double(least_size)))
        throw std::invalid_argument("Shape: transforms must keep sizes at least 2**-60, got " + format(size));
    return true;
}

std::uint32_t add_leaf(Geometry& geometry, const Shape& shape, const Affine& placement) {
    Leaf leaf;
    leaf.kind = leaf_kind(shape.kind());
    if (shape.kind() == ShapeKind::polygon) {
        place_polygon(geometry, leaf, shape, placement);
    } else if (shape.kind() == ShapeKind::mesh) {
        place_mesh(geometry, leaf, shape, placement);
    } else if (!place_in_world(leaf, shape, placement)) {
        const Affine unit = placement * unit_frame(shape);
        const double top = shape.kind() == ShapeKind::cone ? double(shape.top_radius()) / double(shape.radius()) : 1;
        const Frame frame = make_frame(unit, frame_radius(unit), top);
        if (frame.slope == 0 && leaf.kind == LeafKind::cone) leaf.kind = LeafKind::cylinder;
        leaf.surface_error = frame_surface_error(frame, unit);
        leaf.frame = std::int32_t(geometry.frames.size());
        if (leaf.kind == LeafKind::quadric) {
            leaf.polygon = std::uint32_t(geometry.quadrics.size());
            geometry.quadrics.push_back(make_quadric(shape, frame, unit));
        }
        geometry.frames.push_back(frame);
    }
    geometry.leaves.push_back(leaf);
    return std::uint32_t(geometry.leaves.size() - 1);
}

CsgKind csg_kind(ShapeKind kind) {
    if (kind == ShapeKind::csg_union) return CsgKind::csg_union;
    return kind == ShapeKind::csg_intersection ? CsgKind::csg_intersection : CsgKind::csg_difference;
}

// A CSG operation whose parts are being added: their nodes follow those of the operations it is part of.
struct Open {
    const Shape* shape;
    Affine placement;
    bool is_complement;  // taken away, an odd number of times
    std::size_t next = 0, first_child = 0;

    bool takes_away_next() const { return shape->kind() == ShapeKind::csg_difference && next > 0; }
};

// How deep a walk that recurses has to go, as far as a byte can tell.
std::uint8_t height_above(const Geometry& geometry, std::span<const std::uint32_t> children) {
    std::uint8_t height = 0;
    for (const std::uint32_t child : children) height = std::max(height, geometry.csg_nodes[child].height);
    return height == CsgNode::most_height ? height : std::uint8_t(height + 1);
}

// Adds the nodes of an expression, each after its children; returns the last one, its root.
std::uint32_t add_csg(Geometry& geometry, const Shape& shape, const Affine& placement) {
    std::vector<Open> open;
    std::vector<std::uint32_t> children;
    std::int32_t face = 0;
    const auto add_node = [&](const CsgNode& node) {
        children.push_back(std::uint32_t(geometry.csg_nodes.size()));
        geometry.csg_nodes.push_back(node);
    };
    const auto enter = [&](const Shape& part, Affine map, bool is_complement) {
        const Shape& inner = strip_transforms(part, map);
        if (!inner.parts().empty()) {
            open.push_back({&inner, map, is_complement, 0, children.size()});
            return;
        }
        add_node({CsgKind::leaf, 0, add_leaf(geometry, inner, map), 0, face});
        geometry.leaves.back().is_complement = is_complement;
        face += inner.face_count();
    };
    enter(shape, placement, false);
    while (!open.empty()) {
        Open& at = open.back();
        if (at.next < at.shape->parts().size()) {
            const bool is_complement = at.is_complement != at.takes_away_next();
            enter(*at.shape->parts()[at.next++], at.placement, is_complement);
            continue;
        }
        const std::span<const std::uint32_t> own = std::span(children).subspan(at.first_child);
        const CsgNode node{csg_kind(at.shape->kind()), height_above(geometry, own),
                           std::uint32_t(geometry.csg_children.size()), std::uint32_t(own.size()), 0};
        geometry.csg_children.insert(geometry.csg_children.end(), own.begin(), own.end());
        children.resize(at.first_child);
        open.pop_back();
        add_node(node);
    }
    return children[0];
}

// The box of what is really there, which differs from the description by the leaves' errors.
Box primitive_bounds(const Geometry& geometry, const Shape& shape, const Affine& placement, std::uint32_t first_leaf) {
    Boxd box = shape_bounds(shape, placement);
    double error = 0;
    for (std::size_t i = first_leaf; i < geometry.leaves.size(); ++i)
        error = std::max(error, double(geometry.leaves[i].surface_error));
    const Vec3d margin{error, error, error};
    return conservative_box({box.lower - margin, box.upper + margin});
}

// Faces count one after the other: they are those of the last child that begins at the face or before.
LeafFace leaf_of_node(const Geometry& geometry, std::uint32_t index, std::int32_t face) {
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

std::size_t Geometry::bytes() const {
    return primitives.size() * sizeof(Primitive) + leaves.size() * sizeof(Leaf) + frames.size() * sizeof(Frame) +
           polygons.size() * sizeof(PolygonPlane) + vertices.size() * sizeof(Vec3d) +
           meshes.size() * sizeof(MeshInstance) + quadrics.size() * sizeof(Quadric) +
           csg_nodes.size() * sizeof(CsgNode) + csg_children.size() * sizeof(std::uint32_t);
}

LeafFace leaf_of_face(const Geometry& geometry, const Primitive& primitive, std::int32_t face) {
    return primitive.is_csg ? leaf_of_node(geometry, primitive.root, face) : LeafFace{primitive.root, 0};
}

void replace_primitive(Geometry& geometry, std::uint32_t index, const Shape& shape, const Affine& placement) {
    const auto first_leaf = std::uint32_t(geometry.leaves.size());
    Affine map = placement;
    const Shape& inner = strip_transforms(shape, map);
    Primitive& primitive = geometry.primitives[index];
    primitive.is_csg = !inner.parts().empty();
    primitive.root = (primitive.is_csg ? add_csg(geometry, inner, map) : add_leaf(geometry, inner, map)) & 0x7fffffffu;
    primitive.bounds = primitive_bounds(geometry, inner, map, first_leaf);
}

void add_primitive(Geometry& geometry, std::uint32_t object, const Shape& shape, const Affine& placement) {
    Primitive primitive;
    primitive.object = object;
    geometry.primitives.push_back(primitive);
    replace_primitive(geometry, std::uint32_t(geometry.primitives.size() - 1), shape, placement);
}

}  // namespace raybound
