#include "raybound/scene/snapshot.h"

namespace raybound {

Snapshot::Snapshot(SceneContent content, std::int64_t revision) : content_(std::move(content)), revision_(revision) {
    for (std::size_t i = 0; i < content_.objects.size(); ++i) {
        const ObjectRecord& object = content_.objects[i];
        add_primitive(geometry_, std::uint32_t(i), *object.shape, object.transform);
    }
    accelerator_ = Accelerator(geometry_);
}

}  // namespace raybound
