// Ray trees (thesis 4.2.1): what contributed to the radiance of a ray. The tracer records them through a policy, so
// that plain rendering, with NoRecord, pays nothing.
#pragma once

#include <memory>
#include <vector>

#include "raybound/geometry/vector.h"

namespace raybound {

enum class RayKind : std::uint8_t { eye, reflected, refracted };
enum class LightVerdict : std::uint8_t { lit, blocked, behind, outside_cone };

struct RayTreeLight {
    std::int32_t id;
    LightVerdict verdict;
    std::int32_t blocker;  // the id of an object that blocks it, or -1
};

struct RayTreeNode {
    RayKind kind = RayKind::eye;
    Vec3d origin, direction, point, normal, radiance;
    Vec3d weight{1, 1, 1};  // of its radiance in that of the whole tree
    double t = 0;
    bool hit = false, total_internal_reflection = false;
    std::int32_t object = -1, face = -1;
    std::vector<RayTreeLight> lights;
    std::vector<RayTreeNode> children;
};

struct NoRecord {
    static constexpr bool active = false;
    template <class T>
    NoRecord child(RayKind, const Vec3<T>&) const {
        return {};
    }
};

struct RecordTree {
    static constexpr bool active = true;
    RayTreeNode* node;

    template <class T>
    RecordTree child(RayKind kind, const Vec3<T>& weight) const {
        RayTreeNode& child = node->children.emplace_back();
        child.kind = kind;
        child.weight = node->weight * Vec3d(weight);
        return {&child};
    }
};

}  // namespace raybound
