#include "raybound/scene/document.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "raybound/geometry/sole_owner.h"

namespace raybound {

namespace {

// An object is compiled once when it enters, so that a shape that cannot be placed is refused then, not when a frame
// is rendered.
ObjectRecord checked_object(std::int32_t id, ShapePointer shape, MaterialPointer material, const Affine& transform) {
    if (!shape || !material) throw std::invalid_argument("Scene: shape and material must be given");
    const Affine placed = checked_transform("Scene: transform", transform);
    Geometry trial;
    add_primitive(trial, 0, *shape, placed);
    const Box& box = trial.primitives.back().bounds;
    const float reach = maximum(max_component(absolute(box.lower)), max_component(absolute(box.upper)));
    if (!(reach <= 2 * largest_coordinate))
        throw std::invalid_argument("Scene: shape must keep its coordinates within 2**60 when placed, got " +
                                    format(reach));
    return {id, std::move(shape), std::move(material),
            placed.is_identity() ? nullptr : std::make_shared<const Affine>(placed)};
}

template <class Records>
auto find(Records& records, std::int32_t id, const char* what) {
    const auto it =
        std::lower_bound(records.begin(), records.end(), id, [](const auto& r, std::int32_t i) { return r.id < i; });
    if (it == records.end() || it->id != id)
        throw std::invalid_argument(std::string("Scene: no ") + what + " with id " + std::to_string(id));
    return it;
}

}  // namespace

Document::Document(const Vec3f& ambient, const Vec3f& background) {
    set_ambient(ambient);
    set_background(background);
    state_.revision = 0;
}

Document::Document(const Document& other) {
    const std::scoped_lock lock(other.mutex_);
    state_ = other.before_ ? *other.before_ : other.state_;
}

SceneContent& Document::writable() {
    if (!is_sole_owner(state_.content)) state_.content = std::make_shared<SceneContent>(*state_.content);
    return *state_.content;
}

void Document::edited() { ++state_.revision; }

std::int32_t Document::add_object(ShapePointer shape, MaterialPointer material, const Affine& transform) {
    const std::scoped_lock lock(mutex_);
    ObjectRecord record = checked_object(state_.next_object, std::move(shape), std::move(material), transform);
    writable().objects.push_back(std::move(record));
    edited();
    return state_.next_object++;
}

void Document::set_object(std::int32_t id, ShapePointer shape, MaterialPointer material, const Affine& transform) {
    const std::scoped_lock lock(mutex_);
    const auto at = find(state_.content->objects, id, "object") - state_.content->objects.begin();
    ObjectRecord record = checked_object(id, std::move(shape), std::move(material), transform);
    writable().objects[std::size_t(at)] = std::move(record);
    edited();
}

void Document::remove_object(std::int32_t id) {
    const std::scoped_lock lock(mutex_);
    find(state_.content->objects, id, "object");  // throws before anything is copied
    auto& objects = writable().objects;
    objects.erase(find(objects, id, "object"));
    edited();
}

std::int32_t Document::add_light(LightPointer value) {
    if (!value) throw std::invalid_argument("Scene: light must be given");
    const std::scoped_lock lock(mutex_);
    writable().lights.push_back({state_.next_light, std::move(value)});
    edited();
    return state_.next_light++;
}

void Document::set_light(std::int32_t id, LightPointer value) {
    if (!value) throw std::invalid_argument("Scene: light must be given");
    const std::scoped_lock lock(mutex_);
    find(state_.content->lights, id, "light");
    find(writable().lights, id, "light")->light = std::move(value);
    edited();
}

void Document::remove_light(std::int32_t id) {
    const std::scoped_lock lock(mutex_);
    find(state_.content->lights, id, "light");
    auto& lights = writable().lights;
    lights.erase(find(lights, id, "light"));
    edited();
}

void Document::set_ambient(const Vec3f& ambient) {
    require_colour("Scene", "ambient", ambient);
    const std::scoped_lock lock(mutex_);
    writable().ambient = ambient;
    edited();
}

void Document::set_background(const Vec3f& background) {
    require_colour("Scene", "background", background);
    const std::scoped_lock lock(mutex_);
    writable().background = background;
    edited();
}

void Document::begin_edit() {
    const std::scoped_lock lock(mutex_);
    if (before_) throw std::logic_error("Scene: an edit block is already open");
    before_ = state_;
}

void Document::commit_edit() {
    const std::scoped_lock lock(mutex_);
    if (!before_) throw std::logic_error("Scene: no edit block is open");
    if (state_.revision != before_->revision) state_.revision = before_->revision + 1;
    before_.reset();
}

void Document::rollback_edit() {
    const std::scoped_lock lock(mutex_);
    if (!before_) throw std::logic_error("Scene: no edit block is open");
    state_ = std::move(*before_);
    before_.reset();
}

std::int64_t Document::revision() const {
    const std::scoped_lock lock(mutex_);
    return before_ ? before_->revision : state_.revision;
}

Boxd Document::object_bounds(std::int32_t id) const {
    const std::scoped_lock lock(mutex_);
    const auto record = find(state_.content->objects, id, "object");
    return shape_bounds(*record->shape, record->placement());
}

std::optional<Boxd> Document::bounds() const {
    const std::scoped_lock lock(mutex_);
    if (state_.content->objects.empty()) return std::nullopt;
    Boxd box;
    for (const ObjectRecord& record : state_.content->objects)
        box.extend(shape_bounds(*record.shape, record.placement()));
    return box;
}

Document::Building::Building(const Document& document, const Watch& watch) : document_(document) {
    if (document.builder_ == std::this_thread::get_id())
        throw std::logic_error("Scene: it cannot be rendered or asked while it is being prepared for that");
    while (!document.snapshot_mutex_.try_lock_for(std::chrono::milliseconds(20)))
        if (watch) watch(0);
    document.builder_ = std::this_thread::get_id();
}

Document::Building::~Building() {
    document_.builder_ = std::thread::id();
    document_.snapshot_mutex_.unlock();
}

SnapshotPointer Document::snapshot(const Watch& watch) const {
    const Building building(*this, watch);
    State state;
    {
        const std::scoped_lock lock(mutex_);
        const State& current = before_ ? *before_ : state_;
        if (snapshot_ && snapshot_->revision() == current.revision) return snapshot_;
        state = current;
    }
    Lookout lookout(watch);
    // The earlier snapshot is copied, or taken apart if nobody else holds it.
    const std::shared_ptr<Snapshot> earlier = std::exchange(snapshot_, nullptr);
    if (!earlier)
        snapshot_ = std::make_shared<Snapshot>(state.content, state.revision, lookout);
    else if (is_sole_owner(earlier))
        snapshot_ = std::make_shared<Snapshot>(std::move(*earlier), state.content, state.revision, lookout);
    else
        snapshot_ = std::make_shared<Snapshot>(*earlier, state.content, state.revision, lookout);
    return snapshot_;
}

}  // namespace raybound
