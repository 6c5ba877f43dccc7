// The scene that scripts edit. Safe from any thread; rendering reads snapshots, so editing never races with it.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "raybound/scene/snapshot.h"

namespace raybound {

class Document {
  public:
    Document(const Vec3f& ambient, const Vec3f& background);
    Document(const Document& other);
    Document& operator=(const Document&) = delete;

    // Each throws std::invalid_argument, and changes nothing, if the shape cannot be placed so or the id is unknown.
    std::int32_t add_object(ShapePointer shape, MaterialPointer material, const Affine& transform);
    void set_object(std::int32_t id, ShapePointer shape, MaterialPointer material, const Affine& transform);
    void remove_object(std::int32_t id);
    std::int32_t add_light(LightPointer light);
    void set_light(std::int32_t id, LightPointer light);
    void remove_light(std::int32_t id);
    void set_ambient(const Vec3f& ambient);
    void set_background(const Vec3f& background);

    // Between begin and commit the edits are seen by nobody; rollback undoes them all, ids included.
    void begin_edit();
    void commit_edit();
    void rollback_edit();

    std::int64_t revision() const;
    Boxd object_bounds(std::int32_t id) const;
    std::optional<Boxd> bounds() const;

    // The committed scene; built at most once for each revision. `watch` is called while it is built or waited for, and
    // may throw to stop that; it must not ask for a snapshot itself (std::logic_error).
    SnapshotPointer snapshot(const Watch& watch = {}) const;

  private:
    // The content is shared with snapshots, and copied before it is written where it is.
    struct State {
        std::shared_ptr<SceneContent> content = std::make_shared<SceneContent>();
        std::int32_t next_object = 0, next_light = 0;
        std::int64_t revision = 0;
    };

    // Holds the right to build: one thread builds, others wait for it.
    class Building {
      public:
        Building(const Document& document, const Watch& watch);
        ~Building();
        Building(const Building&) = delete;
        Building& operator=(const Building&) = delete;

      private:
        const Document& document_;
    };

    SceneContent& writable();
    void edited();

    mutable std::mutex mutex_;
    State state_;
    std::optional<State> before_;  // during an edit block: what everybody else sees
    mutable std::timed_mutex snapshot_mutex_;
    mutable std::atomic<std::thread::id> builder_;
    mutable std::shared_ptr<Snapshot> snapshot_;
};

}  // namespace raybound
