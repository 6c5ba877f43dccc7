// How rays meet meshes. The deciding type sees every triangle of a mesh from the same ray, in the mesh's coordinates,
// so that nothing passes between triangles; T walks the mesh's hierarchy and filters (derivation D8).
#pragma once

#include <algorithm>

#include "raybound/shapes/boundary.h"

namespace raybound {

// The ray in the mesh's coordinates.
template <class T>
struct MeshRay {
    using W = Wide<T>;

    Vec3<W> origin, direction;
    W origin_error;
    Shear<W> shear;
    Vec3<W> permuted_origin;
    SlabRay<T> slabs;
    TrianglePackRay<T> packs;

    MeshRay(const Geometry& geometry, const Leaf& leaf, const MeshData& mesh, const Ray<W>& ray)
        : MeshRay(mesh, local_line(geometry, leaf, ray)) {}

  private:
    struct Line {
        LocalPoint<W> origin;
        Vec3<W> direction;
    };

    static Line local_line(const Geometry& geometry, const Leaf& leaf, const Ray<W>& ray) {
        if (leaf.frame < 0) return {{ray.origin, {}}, ray.direction};
        const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
        const Vec3<W> d = frame_linear<W>(frame) * ray.direction;
        // A component flushed is flushed for both types.
        const auto flush = [](W x) { return flush_component(T(x)) == T(0) ? W(0) : x; };
        return {to_local(frame, ray.origin), {flush(d.x), flush(d.y), flush(d.z)}};
    }

    // How far T's origin is from the deciding type's (an ulp's half, and half as much again for the slabs' own
    // rounding of it), and as much as that type may err in telling on which side of an edge a ray passes: what it
    // accepts, the slabs must not drop.
    static Vec3<T> slab_error(const MeshData& mesh, const LocalPoint<W>& o) {
        const Vec3<T> y = absolute(Vec3<T>(o.y));
        const T off = T(max_component(o.error)) + T(0x1p-44) * (max_component(y) + T(mesh.reach()));
        return y * gamma<T>(3) + Vec3<T>{off, off, off} * T(1.25f);
    }

    MeshRay(const MeshData& mesh, const Line& line) : MeshRay(line, slab_error(mesh, line.origin)) {}
    MeshRay(const Line& line, const Vec3<T>& error)
        : origin(line.origin.y),
          direction(line.direction),
          origin_error(max_component(line.origin.error)),
          shear(direction),
          permuted_origin(shear.permuted(origin)),
          slabs(Vec3<T>(origin), error, Vec3<T>(direction)),
          packs(Vec3<T>(origin), Vec3<T>(direction), max_component(error)) {}
};

template <class T>
inline Piercing<T> pierce_face(const Corners<T>& corners, const Vec3<T>& permuted_origin, T origin_error,
                               const Shear<T>& shear) {
    const Corners<T> permuted{shear.permuted(corners.a), shear.permuted(corners.b), shear.permuted(corners.c)};
    return pierce(edge_functions(permuted, permuted_origin, origin_error, shear), shear);
}

// A triangle's crossing, if it is decided that there is one ahead. A crossing needs the triangle's own box crossed,
// and its t is no less than the entry, as for primitives: so any conservative traversal finds the same.
template <class T>
struct FaceCrossing {
    Wide<T> t;
    T rounded;
    std::int32_t face;
    bool hit;
};

template <class T>
inline FaceCrossing<T> cross_lane(const TrianglePack& pack, int lane, const MeshRay<T>& ray, T t_max) {
    using W = Wide<T>;
    const auto corner = [&](int k) {
        return Vec3f{pack.corner[k][0][lane], pack.corner[k][1][lane], pack.corner[k][2][lane]};
    };
    const Corners<float> corners{corner(0), corner(1), corner(2)};
    const Piercing<W> p = pierce_face<W>({Vec3<W>(corners.a), Vec3<W>(corners.b), Vec3<W>(corners.c)},
                                         ray.permuted_origin, ray.origin_error, ray.shear);
    if (none(p.hit & p.ahead)) return {W(0), T(0), 0, false};
    const Box box{minimum(minimum(corners.a, corners.b), corners.c), maximum(maximum(corners.a, corners.b), corners.c)};
    T entry;
    if (!crosses(box, ray.slabs, t_max, &entry)) return {W(0), T(0), 0, false};
    return {p.t, maximum(T(p.t), entry), std::int32_t(pack.id[lane]), true};
}

// Calls visit(pack) for the packs that the ray may meet; with brute force, for all.
template <class T, class Visit>
inline void visit_packs(const MeshData& mesh, const MeshRay<T>& ray, T& t_max, bool brute_force, const Visit& visit) {
    if (!brute_force)
        return mesh.bvh().traverse(ray.slabs, t_max, [&](std::uint32_t pack, T) { visit(mesh.packs()[pack]); });
    for (const TrianglePack& pack : mesh.packs()) visit(pack);
}

// The first crossing, by (t, face), among those not beyond t_max.
template <class T>
inline Crossing<Wide<T>> cross_mesh(const Geometry& geometry, std::uint32_t index, const Ray<Wide<T>>& world, T t_max,
                                    bool brute_force) {
    const Leaf& leaf = geometry.leaves[index];
    const MeshData& mesh = *geometry.meshes[leaf.polygon].data;
    const MeshRay<T> ray(geometry, leaf, mesh, world);
    FaceCrossing<T> best{infinity<Wide<T>>, t_max, 0, false};
    visit_packs(mesh, ray, best.rounded, brute_force, [&](const TrianglePack& pack) {
        for (std::uint32_t lanes = may_cross(pack, ray.packs, best.rounded); lanes != 0;) {
            const FaceCrossing<T> found = cross_lane(pack, bvh::take_lowest(lanes), ray, best.rounded);
            if (!found.hit || found.rounded > best.rounded) continue;
            if (!best.hit || found.rounded < best.rounded || found.face < best.face) best = found;
        }
    });
    return {best.t, index, best.face, 0, best.hit, false};
}

// Does any triangle block: certainly ahead, and certainly before `end`?
template <class T>
inline bool mesh_blocks(const Geometry& geometry, std::uint32_t index, const Ray<Wide<T>>& world, Wide<T> end,
                        bool brute_force) {
    const Leaf& leaf = geometry.leaves[index];
    const MeshData& mesh = *geometry.meshes[leaf.polygon].data;
    const MeshRay<T> ray(geometry, leaf, mesh, world);
    const T reach = T(end) * T(1 + 0x1p-10);
    const auto blocked_by = [&](const TrianglePack& pack) {
        for (std::uint32_t lanes = may_cross(pack, ray.packs, reach); lanes != 0;) {
            const FaceCrossing<T> found = cross_lane(pack, bvh::take_lowest(lanes), ray, reach);
            if (!found.hit || !(found.t < end)) continue;
            if (!world.has_target || found.t + boundary_error(geometry, leaf, found.face, found.t, world) < end)
                return true;
        }
        return false;
    };
    if (!brute_force)
        return mesh.bvh().any(ray.slabs, reach, [&](std::uint32_t pack, T) { return blocked_by(mesh.packs()[pack]); });
    return std::ranges::any_of(mesh.packs(), blocked_by);
}

// The hit point by its barycentric coordinates, in the world, with the bound of its error: seven roundings of
// sum |b v| (seeds/000, 3.9.4), those of the map to the world, and how far the inverse that decides is off it.
template <class T>
struct BarycentricHit {
    Vec3<T> point, error;
    Vec3<T> normal;   // outward, of the face
    Vec3<T> shading;  // the interpolated normal, on the same side; the face's own where there is none
    UV<T> uv;
};

template <class T, class Value>
inline auto interpolate(const Piercing<T>& weights, const Value& a, const Value& b, const Value& c) {
    return a * (weights.a / weights.sum) + b * (weights.b / weights.sum) + c * (weights.c / weights.sum);
}

template <class T>
inline Vec3<T> scaled_unit(const Vec3<T>& v) {
    return normalize(v * (T(1) / max_component(absolute(v))));
}

template <class T>
inline Vec3<T> shading_normal(const MeshData& mesh, const Face& face, const Piercing<T>& weights,
                              const Vec3<T>& normal) {
    if (mesh.normals().empty()) return normal;
    const auto at = [&](std::int32_t vertex) { return scaled_unit(Vec3<T>(mesh.normals()[std::size_t(vertex)])); };
    const Vec3<T> sum = interpolate(weights, at(face.a), at(face.b), at(face.c));
    return max_component(absolute(sum)) > T(0x1p-20) ? sum : normal;  // opposite normals cancel: the face's own then
}

template <class T>
inline UV<T> mesh_uv(const MeshData& mesh, const Face& face, const Piercing<T>& weights) {
    if (mesh.uvs().empty()) return {weights.b / weights.sum, weights.c / weights.sum};
    const auto at = [&](std::int32_t vertex) {
        const UV<float>& uv = mesh.uvs()[std::size_t(vertex)];
        return Vec3<T>(T(uv.u), T(uv.v), T(0));
    };
    const Vec3<T> uv = interpolate(weights, at(face.a), at(face.b), at(face.c));
    return {uv.x, uv.y};
}

template <class T>
inline BarycentricHit<T> barycentric_hit(const Geometry& geometry, const Leaf& leaf, std::int32_t index,
                                         const Ray<T>& world) {
    const MeshInstance& instance = geometry.meshes[leaf.polygon];
    const MeshData& mesh = *instance.data;
    const MeshRay<T> ray(geometry, leaf, mesh, world);
    const Corners<T> c = mesh.corners<T>(index);
    const Face& face = mesh.faces()[std::size_t(index)];
    const Piercing<T> weights = pierce_face(c, ray.permuted_origin, ray.origin_error, ray.shear);
    BarycentricHit<T> hit;
    hit.point = interpolate(weights, c.a, c.b, c.c);
    hit.error = interpolate(weights, absolute(c.a), absolute(c.b), absolute(c.c)) * gamma<T>(7);
    hit.normal = cross(c.b - c.a, c.c - c.a);
    hit.shading = shading_normal(mesh, face, weights, hit.normal);
    hit.uv = mesh_uv(mesh, face, weights);
    if (leaf.frame >= 0) {
        const Mat3<T>& inverse = frame_linear<T>(geometry.frames[std::size_t(leaf.frame)]);
        const Mat3<T> linear(instance.placement.linear), size = absolute(linear);
        const Vec3<T> offset(instance.placement.offset);
        const T off(leaf.surface_error);
        hit.error = size * (hit.error + absolute(hit.point) * gamma<T>(4)) + absolute(offset) * gamma<T>(1) +
                    Vec3<T>{off, off, off};
        hit.point = linear * hit.point + offset;
        hit.normal = transpose_times(inverse, hit.normal);
        hit.shading = transpose_times(inverse, hit.shading);
    }
    hit.normal = scaled_unit(hit.normal);
    hit.shading = scaled_unit(hit.shading);
    if (dot(hit.shading, hit.normal) < T(0)) hit.shading = -hit.shading;
    return hit;
}

}  // namespace raybound
