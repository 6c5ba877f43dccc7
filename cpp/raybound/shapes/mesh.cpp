#include "raybound/shapes/mesh.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace raybound {

namespace {

[[noreturn]] void refuse(const std::string& message) { throw std::invalid_argument("Mesh: " + message); }

Vec3d area_vector(const Corners<double>& c) { return cross(c.b - c.a, c.c - c.a); }

void check_indices(std::span<const Face> faces, std::size_t vertex_count, Lookout& lookout) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
        lookout.step();
        for (const std::int32_t index : {faces[i].a, faces[i].b, faces[i].c})
            if (index < 0 || std::size_t(index) >= vertex_count)
                refuse("faces must index the " + std::to_string(vertex_count) + " vertices, face " + std::to_string(i) +
                       " has index " + std::to_string(index));
    }
}

void check_normals(std::span<const Vec3f> normals, Lookout& lookout) {
    for (std::size_t i = 0; i < normals.size(); ++i) {
        lookout.step();
        if (!(length(Vec3d(normals[i])) >= double(least_size)))
            refuse("normals must not be zero, normal " + std::to_string(i) + " is " + format(normals[i]));
    }
}

struct Edge {
    std::uint64_t ends;  // the smaller index first
    std::uint32_t face;
    auto operator<=>(const Edge&) const = default;
};

// An edge belongs to one face, at a border, or to two.
void check_edges(std::span<const Face> faces, Lookout& lookout) {
    std::vector<Edge> edges;
    edges.reserve(faces.size() * 3);
    const auto add = [&](std::int32_t a, std::int32_t b, std::size_t face) {
        edges.push_back({std::uint64_t(std::min(a, b)) << 32 | std::uint32_t(std::max(a, b)), std::uint32_t(face)});
    };
    for (std::size_t i = 0; i < faces.size(); ++i) {
        lookout.step();
        add(faces[i].a, faces[i].b, i);
        add(faces[i].b, faces[i].c, i);
        add(faces[i].c, faces[i].a, i);
    }
    std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) {
        lookout.step();
        return a < b;
    });
    for (std::size_t i = 2; i < edges.size(); ++i) {
        lookout.step();
        if (edges[i].ends == edges[i - 2].ends)
            refuse("faces must be manifold, faces " + std::to_string(edges[i - 2].face) + ", " +
                   std::to_string(edges[i - 1].face) + " and " + std::to_string(edges[i].face) +
                   " share the edge of vertices " + std::to_string(edges[i].ends >> 32) + " and " +
                   std::to_string(edges[i].ends & 0xffffffffu));
    }
}

Box box_of(const Corners<float>& corners) {
    Box box;
    box.extend(corners.a);
    box.extend(corners.b);
    box.extend(corners.c);
    return box;
}

}  // namespace

void MeshData::check(Lookout& lookout) const {
    if (vertices_.empty()) refuse("vertices must not be empty");
    if (faces_.empty()) refuse("faces must not be empty");
    if (faces_.size() >= std::size_t(Bvh::leaf_bit)) refuse("faces must be fewer than 2**31");
    for (const Vec3f& v : vertices_) require_finite("Mesh", "vertices", v);
    for (const Vec3f& n : normals_) require_finite("Mesh", "normals", n);
    for (const UV<float>& uv : uvs_) require_finite("Mesh", "uvs", Vec3f{uv.u, uv.v, 0});
    if (!normals_.empty() && normals_.size() != vertices_.size()) refuse("normals must be as many as vertices");
    if (!uvs_.empty() && uvs_.size() != vertices_.size()) refuse("uvs must be as many as vertices");
    check_indices(faces_, vertices_.size(), lookout);
    check_normals(normals_, lookout);
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        lookout.step();
        if (area_vector(corners<double>(std::int32_t(i))) == Vec3d{})
            refuse("faces must not be degenerate, the corners of face " + std::to_string(i) + " are on one line");
    }
    check_edges(faces_, lookout);
}

// One pack for each leaf. Boxes of triangles are exact.
void MeshData::build(Lookout& lookout) {
    std::vector<Box> boxes;
    boxes.reserve(faces_.size());
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        lookout.step();
        boxes.push_back(box_of(corners<float>(std::int32_t(i))));
        bounds_.extend(boxes.back());
    }
    reach_ = maximum(max_component(absolute(bounds_.lower)), max_component(absolute(bounds_.upper)));
    const auto make_leaf = [this](std::span<const std::uint32_t> items) {
        TrianglePack pack;
        for (std::size_t lane = 0; lane < items.size(); ++lane) {
            const Corners<float> c = corners<float>(std::int32_t(items[lane]));
            const Vec3f* corner[3] = {&c.a, &c.b, &c.c};
            for (int k = 0; k < 3; ++k)
                for (int axis = 0; axis < 3; ++axis) pack.corner[k][axis][lane] = (*corner[k])[axis];
            pack.id[lane] = items[lane];
            pack.lanes |= 1u << lane;
        }
        packs_.push_back(pack);
        return std::uint32_t(packs_.size() - 1);
    };
    bvh_ = Bvh(boxes, {[](std::uint32_t) { return 0; }, [](int) { return pack_width; }, make_leaf}, lookout);
    packs_.shrink_to_fit();
}

MeshPointer MeshData::make(std::vector<Vec3f> vertices, std::vector<Face> faces, std::vector<Vec3f> normals,
                           std::vector<UV<float>> uvs, const Watch& watch) {
    const std::shared_ptr<MeshData> mesh(new MeshData);
    mesh->vertices_ = std::move(vertices);
    mesh->faces_ = std::move(faces);
    mesh->normals_ = std::move(normals);
    mesh->uvs_ = std::move(uvs);
    Lookout lookout(watch);
    mesh->check(lookout);
    mesh->build(lookout);
    if (!(max_component(mesh->bounds_.extent()) >= least_size)) refuse("vertices must extend over at least 2**-60");
    return mesh;
}

std::size_t MeshData::bytes() const {
    return sizeof(*this) + vertices_.capacity() * sizeof(Vec3f) + normals_.capacity() * sizeof(Vec3f) +
           faces_.capacity() * sizeof(Face) + uvs_.capacity() * sizeof(UV<float>) + bvh_.bytes() +
           packs_.capacity() * sizeof(TrianglePack);
}

}  // namespace raybound
