// How rays meet meshes. The deciding type sees every triangle of a mesh from the same ray, in the mesh's coordinates,
// so that nothing passes between triangles; T walks the mesh's hierarchy and filters (derivation D8).
#pragma once

#include <algorithm>

#include "raybound/shapes/boundary.h"
#include "raybound/shapes/closest.h"
#include "raybound/shapes/intersect.h"
#include "raybound/shapes/pierce.h"

namespace raybound {

// A ray in the mesh's coordinates. This rounded line, as it is, is what decides, about every triangle of the mesh.
inline PermutedLine mesh_line(const Geometry& geometry, const Leaf& leaf, const Ray<double>& ray) {
    const bool closed = geometry.meshes[leaf.polygon].data->is_closed();
    if (leaf.frame < 0) return {ray.origin, ray.direction, 0, closed};
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    const LocalPoint<double> origin = to_local(frame, ray.origin);
    const Vec3d d = frame.linear_wide * ray.direction;
    const auto flush = [](double x) { return flush_component(float(x)) == 0 ? 0.0 : x; };  // for every type alike
    return {origin.y, {flush(d.x), flush(d.y), flush(d.z)}, max_component(origin.error), closed};
}

// The same with what T's slabs and filter need; T's line is within rounding of it.
template <class T>
struct MeshRay {
    PermutedLine line;
    SlabRay<T> slabs;
    TrianglePackRay<T> packs;

    MeshRay(const Geometry& geometry, const Leaf& leaf, const Ray<double>& ray)
        : line(mesh_line(geometry, leaf, ray)),
          slabs(narrow(line.origin), rounding(line.origin), narrow(line.direction)),
          packs(narrow(line.origin), narrow(line.direction), max_component(rounding(line.origin))) {}

  private:
    // How far T's origin is from the deciding one (half an ulp), and the slabs' own rounding of it.
    static Vec3<T> rounding(const Vec3d& origin) { return absolute(narrow(origin)) * gamma<T>(3); }
    static Vec3<T> narrow(const Vec3d& v) { return Vec3<T>(v); }
};

inline Piercing pierce_face(const Corners<double>& corners, const PermutedLine& line) {
    const auto& shear = line.shear;
    return pierce({shear.permuted(corners.a), shear.permuted(corners.b), shear.permuted(corners.c)}, line);
}

// A triangle's crossing, if it is decided that there is one ahead. A crossing needs the triangle's own box crossed,
// and its t is no less than the entry, as for primitives: so any conservative traversal finds the same.
template <class T>
struct FaceCrossing {
    double t, latest;
    T rounded;
    std::int32_t face;
    bool hit, entering;
};

template <class T>
inline FaceCrossing<T> cross_lane(const TrianglePack& pack, int lane, const MeshRay<T>& ray, T t_max) {
    const auto corner = [&](int k) {
        return Vec3f{pack.corner[k][0][lane], pack.corner[k][1][lane], pack.corner[k][2][lane]};
    };
    const Corners<float> corners{corner(0), corner(1), corner(2)};
    const Piercing p = pierce_face({Vec3d(corners.a), Vec3d(corners.b), Vec3d(corners.c)}, ray.line);
    if (!p.hit) return {};
    const Box box{minimum(minimum(corners.a, corners.b), corners.c), maximum(maximum(corners.a, corners.b), corners.c)};
    T entry;
    if (!crosses(box, ray.slabs, t_max, &entry)) return {};
    return {p.t, p.latest, maximum(T(p.t), entry), std::int32_t(pack.id[lane]), true, p.entering};
}

// Calls visit(pack) for the packs that the ray may meet; with brute force, for all.
template <class T, class Visit>
inline void visit_packs(const MeshData& mesh, const MeshRay<T>& ray, T& t_max, bool brute_force, const Visit& visit) {
    const auto visit_pack = [&](std::uint32_t pack, T) { visit(mesh.packs()[pack]); };
    if (!brute_force) return mesh.bvh().traverse(ray.slabs, t_max, observed(visit_pack, observer_of(visit)));
    for (const TrianglePack& pack : mesh.packs()) visit(pack);
}

// The first crossing, by (t, face), among those not beyond t_max. Its t includes the clamp to the entry: what is beyond
// t_max by it is out whether this mesh is asked before the object that set t_max or after.
template <class T, class Observer>
inline Crossing<double> cross_mesh(const Geometry& geometry, std::uint32_t index, const Ray<double>& world, T t_max,
                                   bool brute_force, Observer observer) {
    const Leaf& leaf = geometry.leaves[index];
    const MeshData& mesh = *geometry.meshes[leaf.polygon].data;
    const MeshRay<T> ray(geometry, leaf, world);
    FaceCrossing<T> best{infinity<double>, infinity<double>, t_max, 0, false, false};
    const auto visit = [&](const TrianglePack& pack) {
        observer.primitive();
        for (std::uint32_t lanes = may_cross(pack, ray.packs, best.rounded); lanes != 0;) {
            const FaceCrossing<T> found = cross_lane(pack, bvh::take_lowest(lanes), ray, best.rounded);
            if (!found.hit || found.rounded > best.rounded) continue;
            if (!best.hit || found.rounded < best.rounded || found.face < best.face) best = found;
        }
    };
    visit_packs(mesh, ray, best.rounded, brute_force, observed(visit, observer));
    const double t = T(best.t) < best.rounded ? double(best.rounded) : best.t;
    return {t, index, best.face, 0, best.hit, best.entering};
}

// How far a local direction may be off, relative to its length: 5 roundings of |A||d|, and |d| <= |A^-1||d'|.
inline double line_error(const Geometry& geometry, const Leaf& leaf) {
    if (leaf.frame < 0) return 0;
    const Frame& frame = geometry.frames[std::size_t(leaf.frame)];
    return gamma<double>(16) * double(max_component(frame.row_norm)) * frame.inverse_norm;
}

// Does any triangle block: certainly ahead, and certainly before `end`?
template <class T, class Observer>
inline bool mesh_blocks(const Geometry& geometry, std::uint32_t index, const Ray<double>& world, double end,
                        bool brute_force, Blocking* how, Observer observer) {
    const Leaf& leaf = geometry.leaves[index];
    const MeshData& mesh = *geometry.meshes[leaf.polygon].data;
    const MeshRay<T> ray(geometry, leaf, world);
    const T reach = T(end) * T(1 + 0x1p-10);
    const double surely_before = end / (1 + 0x1p-20 + line_error(geometry, leaf));
    const auto blocked_by = [&](const TrianglePack& pack) {
        observer.primitive();
        for (std::uint32_t lanes = may_cross(pack, ray.packs, reach); lanes != 0;) {
            const FaceCrossing<T> found = cross_lane(pack, bvh::take_lowest(lanes), ray, reach);
            if (!found.hit || !(found.t < end)) continue;
            if (how) how->entering = found.entering;
            if (!world.has_target || found.latest < surely_before) return true;
            if (found.t + boundary_error(geometry, leaf, found.face, found.t, world) < end) return true;
        }
        return false;
    };
    if (!brute_force)
        return mesh.bvh().any(
            ray.slabs, reach,
            observed([&](std::uint32_t pack, T) { return blocked_by(mesh.packs()[pack]); }, observer));
    return std::ranges::any_of(mesh.packs(), blocked_by);
}

// The hit point by its barycentric coordinates, in the world, with the bound of its error: seven roundings of
// sum |b v| (seeds/000, 3.9.4), those of the map to the world, and how far the inverse that decides is off it.
struct BarycentricHit {
    Vec3d point, error;
    Vec3d normal;   // outward, of the face
    Vec3d shading;  // the interpolated normal, on the same side; the face's own where there is none
    UV<double> uv;
};

template <class Value>
inline auto interpolate(const Piercing& weights, const Value& a, const Value& b, const Value& c) {
    return a * (weights.a / weights.sum) + b * (weights.b / weights.sum) + c * (weights.c / weights.sum);
}

inline Vec3d scaled_unit(const Vec3d& v) { return normalize(v * (1.0 / max_component(absolute(v)))); }

inline Vec3d shading_normal(const MeshData& mesh, const Face& face, const Piercing& weights, const Vec3d& normal) {
    if (mesh.normals().empty()) return normal;
    const auto at = [&](std::int32_t vertex) { return scaled_unit(Vec3d(mesh.normals()[std::size_t(vertex)])); };
    const Vec3d sum = interpolate(weights, at(face.a), at(face.b), at(face.c));
    return max_component(absolute(sum)) > 0x1p-20 ? sum : normal;  // opposite normals cancel: the face's own then
}

inline UV<double> mesh_uv(const MeshData& mesh, const Face& face, const Piercing& weights) {
    if (mesh.uvs().empty()) return {weights.b / weights.sum, weights.c / weights.sum};
    const auto at = [&](std::int32_t vertex) {
        const UV<float>& uv = mesh.uvs()[std::size_t(vertex)];
        return Vec3d(double(uv.u), double(uv.v), 0.0);
    };
    const Vec3d uv = interpolate(weights, at(face.a), at(face.b), at(face.c));
    return {uv.x, uv.y};
}

inline BarycentricHit barycentric_hit(const Geometry& geometry, const Leaf& leaf, std::int32_t index,
                                      const Ray<double>& world, double t) {
    const MeshInstance& instance = geometry.meshes[leaf.polygon];
    const MeshData& mesh = *instance.data;
    const PermutedLine line = mesh_line(geometry, leaf, world);
    const Corners<double> c = mesh.corners<double>(index);
    const Face& face = mesh.faces()[std::size_t(index)];
    Piercing weights = pierce_face(c, line);
    if (!weights.met) {  // the ray must leave here, though by rounding it passes beside the face
        const CornerWeights closest = closest_weights(c, line.origin + line.direction * t);
        weights.a = closest.a, weights.b = closest.b, weights.c = closest.c, weights.sum = 1;
    }
    BarycentricHit hit;
    hit.point = interpolate(weights, c.a, c.b, c.c);
    hit.error = interpolate(weights, absolute(c.a), absolute(c.b), absolute(c.c)) * gamma<double>(7);
    hit.normal = cross(c.b - c.a, c.c - c.a);
    hit.shading = shading_normal(mesh, face, weights, hit.normal);
    hit.uv = mesh_uv(mesh, face, weights);
    if (leaf.frame >= 0) {
        const Mat3<double>& inverse = geometry.frames[std::size_t(leaf.frame)].linear_wide;
        const auto& [linear, offset] = instance.placement;
        const Mat3<double> size = absolute(linear);
        const double off = leaf.surface_error;
        hit.error = size * (hit.error + absolute(hit.point) * gamma<double>(4)) + absolute(offset) * gamma<double>(1) +
                    Vec3d{off, off, off};
        hit.point = linear * hit.point + offset;
        hit.normal = transpose_times(inverse, hit.normal);
        hit.shading = transpose_times(inverse, hit.shading);
    }
    hit.normal = scaled_unit(hit.normal);
    hit.shading = scaled_unit(hit.shading);
    if (dot(hit.shading, hit.normal) < 0.0) hit.shading = -hit.shading;
    return hit;
}

}  // namespace raybound
