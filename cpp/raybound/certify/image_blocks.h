// What the rays of image blocks have met: kept as long as the camera stays, so that after an edit only what it touches
// is asked again (thesis chapter 6). A block's record is a certificate about its bundles of rays: nothing that changed
// since lies in them.
#pragma once

#include <atomic>
#include <memory>
#include <span>

#include "raybound/certify/scene_change.h"

namespace raybound {

class ImageBlocks {
  public:
    // A block's record (block_record.h) and what has changed since it was written. No words: nothing is known.
    struct Kept {
        const std::uint64_t* words = nullptr;
        std::span<const SceneChange> changes;
    };

    // Forgets everything. No more than `bytes` for all of it: what does not fit in is not kept.
    void reset(std::size_t bytes);
    std::size_t bytes() const { return bytes_.load(std::memory_order_relaxed); }

    // The next pictures are of this camera, in so many blocks; those of others are forgotten.
    void begin_view(std::span<const float> camera, int blocks);
    void follow(SceneChange change);
    void follow_lights(const std::vector<LightRecord>& lights);

    // For a light's index, the number of the place that it shines from: another one when it moves.
    const std::vector<std::uint32_t>& light_places() const { return places_; }

    bool is_open() const { return !records_.empty(); }
    Kept kept(int block) const;
    // By one thread for each block.
    void keep(int block, std::span<const std::uint64_t> words);

    // TUNED: words of a record, beyond which it is not worth having: trees grow with the power of their depth.
    static constexpr std::size_t most_words = std::size_t(1) << 17;

  private:
    struct Record {
        std::unique_ptr<std::uint64_t[]> words;
        std::uint32_t count = 0, capacity = 0;
        std::uint64_t version = 0;
    };
    struct Place {
        std::int32_t id;
        LightPointer light;
        std::uint32_t number;
    };

    bool make_room(Record& record, std::size_t words);
    bool has_room(std::size_t bytes) const { return bytes_.load(std::memory_order_relaxed) + bytes <= limit_; }
    void drop_change();

    std::size_t limit_ = 0;
    std::atomic<std::size_t> bytes_ = 0;
    std::vector<float> camera_;
    std::vector<Record> records_;
    std::vector<SceneChange> changes_;  // the last ones, up to version_
    std::uint64_t version_ = 0;
    std::vector<Place> lights_;
    std::vector<std::uint32_t> places_;
    std::uint32_t next_place_ = 0;
};

}  // namespace raybound
