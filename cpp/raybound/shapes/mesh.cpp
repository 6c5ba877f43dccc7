#include "raybound/shapes/mesh.h"

#include <algorithm>
#include <array>
#include <numeric>
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
    bool rising;  // the face runs from the smaller index to the larger
    auto operator<=>(const Edge&) const = default;
};

// All edges in order, with vertices numbered anew by number(index).
template <class Number>
std::vector<Edge> sorted_edges(std::span<const Face> faces, const Number& number, Lookout& lookout) {
    std::vector<Edge> edges;
    edges.reserve(faces.size() * 3);
    const auto add = [&](std::int32_t from, std::int32_t to, std::size_t face) {
        const std::uint32_t a = number(from), b = number(to);
        edges.push_back({std::uint64_t(std::min(a, b)) << 32 | std::max(a, b), std::uint32_t(face), a < b});
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
    return edges;
}

// An edge belongs to one face, at a border, or to two.
void check_edges(std::span<const Edge> edges, Lookout& lookout) {
    for (std::size_t i = 2; i < edges.size(); ++i) {
        lookout.step();
        if (edges[i].ends == edges[i - 2].ends)
            refuse("faces must be manifold, faces " + std::to_string(edges[i - 2].face) + ", " +
                   std::to_string(edges[i - 1].face) + " and " + std::to_string(edges[i].face) +
                   " share the edge of vertices " + std::to_string(edges[i].ends >> 32) + " and " +
                   std::to_string(edges[i].ends & 0xffffffffu));
    }
}

// Does each edge have as many faces that run along it one way as the other?
bool are_balanced(std::span<const Edge> edges) {
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        int rising = 0;
        for (; end < edges.size() && edges[end].ends == edges[begin].ends; ++end) rising += edges[end].rising ? 1 : -1;
        if (rising != 0) return false;
    }
    return true;
}

// Numbers of vertices that are equal for those at one place: files part them where (u,v) or normals differ.
std::vector<std::uint32_t> numbers_by_place(std::span<const Vec3f> vertices, Lookout& lookout) {
    const auto key = [&](std::uint32_t i) {
        const Vec3f& v = vertices[i];
        return std::array<float, 3>{v.x, v.y, v.z};
    };
    std::vector<std::uint32_t> order(vertices.size()), number(vertices.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        lookout.step();
        return key(a) < key(b);
    });
    for (std::size_t k = 0; k < order.size(); ++k)
        number[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? number[order[k - 1]] : order[k];
    return number;
}

// Six times the volume that closed faces enclose.
double enclosed_volume(const MeshData& mesh, Lookout& lookout) {
    const Vec3d middle(mesh.vertices().front());
    double volume = 0;
    for (std::size_t i = 0; i < mesh.faces().size(); ++i) {
        lookout.step();
        const Corners<double> c = mesh.corners<double>(std::int32_t(i));
        volume += dot(c.a - middle, area_vector(c));
    }
    return volume;
}

bool encloses_volume(const MeshData& mesh, std::span<const Edge> edges, Lookout& lookout) {
    if (!are_balanced(edges)) {
        const std::vector<std::uint32_t> number = numbers_by_place(mesh.vertices(), lookout);
        const auto by_place = [&](std::int32_t i) { return number[std::size_t(i)]; };
        if (!are_balanced(sorted_edges(mesh.faces(), by_place, lookout))) return false;
    }
    return enclosed_volume(mesh, lookout) > 0;
}

Box box_of(const Corners<float>& corners) {
    Box box;
    box.extend(corners.a);
    box.extend(corners.b);
    box.extend(corners.c);
    return box;
}

}  // namespace

void MeshData::check(Lookout& lookout) {
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
    const std::vector<Edge> edges = sorted_edges(faces_, [](std::int32_t i) { return std::uint32_t(i); }, lookout);
    check_edges(edges, lookout);
    closed_ = encloses_volume(*this, edges, lookout);
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
