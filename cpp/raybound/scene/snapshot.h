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
    std::shared_ptr<const Affine> transform;  // null: where the shape is

    Affine placement() const { return transform ? *transform : Affine{}; }
    bool is_placed_as(const ObjectRecord& o) const { return shape == o.shape && placement() == o.placement(); }
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

using ContentPointer = std::shared_ptr<const SceneContent>;

class Snapshot {
  public:
    Snapshot(ContentPointer content, std::int64_t revision, Lookout& lookout);

    // The next one, from an earlier one: where the same objects are still there, only those that have changed are
    // compiled anew, and the accelerator is refitted.
    Snapshot(Snapshot earlier, ContentPointer content, std::int64_t revision, Lookout& lookout);

    const Geometry& geometry() const { return geometry_; }
    const Accelerator& accelerator() const { return accelerator_; }
    const std::vector<ObjectRecord>& objects() const { return content_->objects; }
    const std::vector<LightRecord>& lights() const { return content_->lights; }
    const Vec3f& ambient() const { return content_->ambient; }
    const Vec3f& background() const { return content_->background; }
    const ContentPointer& content() const { return content_; }
    std::int64_t revision() const { return revision_; }
    std::size_t bytes() const;  // of all this, the shared data of meshes counted once; not of shapes and textures

  private:
    void build(Lookout& lookout);
    bool update(const SceneContent& before, Lookout& lookout);

    ContentPointer content_;
    std::int64_t revision_;
    Geometry geometry_;
    Accelerator accelerator_;
    std::size_t replaced_ = 0;  // primitives compiled anew since the last build
};

using SnapshotPointer = std::shared_ptr<const Snapshot>;

}  // namespace raybound
