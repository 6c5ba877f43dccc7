#include "raybound/scene/snapshot.h"

#include <algorithm>
#include <set>

namespace raybound {

namespace {

constexpr int steps_of_object = 64;  // TUNED: compiling one takes half a microsecond, or much longer

}  // namespace

Snapshot::Snapshot(ContentPointer content, std::int64_t revision, Lookout& lookout)
    : content_(std::move(content)), revision_(revision) {
    build(lookout);
}

Snapshot::Snapshot(Snapshot earlier, ContentPointer content, std::int64_t revision, Lookout& lookout)
    : content_(std::move(content)),
      revision_(revision),
      geometry_(std::move(earlier.geometry_)),
      accelerator_(std::move(earlier.accelerator_)),
      replaced_(earlier.replaced_) {
    if (!update(*earlier.content_, lookout)) build(lookout);
}

void Snapshot::build(Lookout& lookout) {
    geometry_ = {};
    geometry_.primitives.reserve(objects().size());
    geometry_.leaves.reserve(objects().size());
    for (std::size_t i = 0; i < objects().size(); ++i) {
        lookout.step(steps_of_object);
        add_primitive(geometry_, std::uint32_t(i), *objects()[i].shape, objects()[i].placement());
    }
    accelerator_ = Accelerator(geometry_, lookout);
    replaced_ = 0;
}

// False if that is not possible, or no longer worth it: objects came or went, a kind has changed, the tree has become
// bad, or more has been left behind than is in use.
bool Snapshot::update(const SceneContent& before, Lookout& lookout) {
    const auto& now = objects();
    if (&before == content_.get()) return true;
    if (!std::ranges::equal(before.objects, now, {}, &ObjectRecord::id, &ObjectRecord::id)) return false;
    for (std::size_t i = 0; i < now.size(); ++i) {
        if (now[i].is_placed_as(before.objects[i])) continue;
        if (++replaced_ > now.size()) return false;
        lookout.step(steps_of_object);
        replace_primitive(geometry_, std::uint32_t(i), *now[i].shape, now[i].placement());
        if (!accelerator_.update(geometry_, std::uint32_t(i))) return false;
    }
    return !accelerator_.is_degraded();
}

std::size_t Snapshot::bytes() const {
    std::set<const MeshData*> meshes;
    for (const MeshInstance& mesh : geometry_.meshes) meshes.insert(mesh.data);
    std::size_t shared = 0;
    for (const MeshData* mesh : meshes) shared += mesh->bytes();
    return geometry_.bytes() + accelerator_.bytes() + objects().size() * sizeof(ObjectRecord) + shared;
}

}  // namespace raybound
