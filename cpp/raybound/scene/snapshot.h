// What a frame is rendered from: an immutable picture of a scene, flattened for rays.
#pragma once

#include "raybound/scene/accelerator.h"
#include "raybound/scene/material.h"
#include "raybound/shapes/intersect.h"

namespace raybound {

struct ObjectRecord {
    std::int32_t id;
    ShapePointer shape;
    MaterialPointer material;
    Affine transform;
};

struct LightRecord {
    std::int32_t id;
    LightPointer light;
};

// Objects and lights in order of id: so that ties by object index are ties by id.
struct SceneContent {
    std::vector<ObjectRecord> objects;
    std::vector<LightRecord> lights;
    Vec3f ambient, background;
};

class Snapshot {
  public:
    Snapshot(SceneContent content, std::int64_t revision);

    const Geometry& geometry() const { return geometry_; }
    const Accelerator& accelerator() const { return accelerator_; }
    const std::vector<ObjectRecord>& objects() const { return content_.objects; }
    const std::vector<LightRecord>& lights() const { return content_.lights; }
    const Vec3f& ambient() const { return content_.ambient; }
    const Vec3f& background() const { return content_.background; }
    std::int64_t revision() const { return revision_; }
    std::size_t bytes() const { return geometry_.bytes() + accelerator_.bytes(); }

  private:
    SceneContent content_;
    std::int64_t revision_;
    Geometry geometry_;
    Accelerator accelerator_;
};

using SnapshotPointer = std::shared_ptr<const Snapshot>;

}  // namespace raybound
