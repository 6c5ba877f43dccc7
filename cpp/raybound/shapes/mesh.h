// Triangle meshes: what copies and moved objects share, in the mesh's own coordinates.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "raybound/geometry/bvh.h"
#include "raybound/shapes/packs.h"
#include "raybound/shapes/shape.h"

namespace raybound {

struct Face {
    std::int32_t a, b, c;
};

// Immutable. The outside is where a face's corners are seen counter-clockwise.
class MeshData {
  public:
    // `normals` and `uvs` are for each vertex, or empty. Throws std::invalid_argument, naming the face or vertex: for
    // an empty mesh, indices out of range, faces without area, edges of more than two faces, zero normals. `watch` may
    // throw to stop it.
    static std::shared_ptr<const MeshData> make(std::vector<Vec3f> vertices, std::vector<Face> faces,
                                                std::vector<Vec3f> normals, std::vector<UV<float>> uvs,
                                                const Watch& watch = {});

    std::span<const Vec3f> vertices() const { return vertices_; }
    std::span<const Face> faces() const { return faces_; }
    std::span<const Vec3f> normals() const { return normals_; }
    std::span<const UV<float>> uvs() const { return uvs_; }
    const Box& bounds() const { return bounds_; }
    float reach() const { return reach_; }  // the largest coordinate
    std::size_t bytes() const;

    // Every edge has two faces that run along it in opposite directions, and the faces enclose a positive volume.
    bool is_closed() const { return closed_; }

    const Bvh& bvh() const { return bvh_; }
    std::span<const TrianglePack> packs() const { return packs_; }

    template <class T>
    Corners<T> corners(std::int32_t face) const {
        const Face& f = faces_[std::size_t(face)];
        return {Vec3<T>(vertex(f.a)), Vec3<T>(vertex(f.b)), Vec3<T>(vertex(f.c))};
    }

  private:
    MeshData() = default;
    const Vec3f& vertex(std::int32_t i) const { return vertices_[std::size_t(i)]; }
    void check(Lookout& lookout);
    void build(Lookout& lookout);

    std::vector<Vec3f> vertices_, normals_;
    std::vector<Face> faces_;
    std::vector<UV<float>> uvs_;
    Box bounds_;
    float reach_ = 0;
    bool closed_ = false;
    Bvh bvh_;
    LargeArray<TrianglePack> packs_;
};

}  // namespace raybound
