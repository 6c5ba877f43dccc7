#include "raybound/certify/image_blocks.h"

#include <algorithm>
#include <cstring>

namespace raybound {

namespace {

constexpr std::size_t most_changes = 8;  // that a record may be behind

}  // namespace

void ImageBlocks::reset(std::size_t bytes) {
    limit_ = bytes;
    bytes_ = 0;
    camera_.clear();
    records_ = std::vector<Record>();
    changes_.clear();
    lights_.clear();
    places_.clear();
}

void ImageBlocks::begin_view(std::span<const float> camera, int blocks) {
    const auto count = std::size_t(blocks);
    const bool same = camera.size() == camera_.size() &&
                      std::memcmp(camera.data(), camera_.data(), camera.size_bytes()) == 0;  // zeros have signs
    if (same && count == records_.size()) return;
    camera_.assign(camera.begin(), camera.end());
    if (count != records_.size()) {
        records_ = std::vector<Record>();
        changes_.clear();  // no record is behind
        const std::size_t table = count * sizeof(Record);
        if (table < limit_) records_.resize(count);
        bytes_ = records_.size() * sizeof(Record);
    }
    for (Record& record : records_) record.count = 0;
}

void ImageBlocks::follow(SceneChange change) {
    if (change.is_empty() || records_.empty()) return;
    ++version_;
    const std::size_t more = change.bytes();
    while (!changes_.empty() && (changes_.size() == most_changes || !has_room(more))) drop_change();
    if (!has_room(more)) {  // all records are dropped, then: they would be of no use
        for (Record& record : records_) record = {};
        bytes_ = records_.size() * sizeof(Record);
        return;
    }
    bytes_ += more;
    changes_.push_back(std::move(change));
}

void ImageBlocks::drop_change() {
    bytes_ -= changes_.front().bytes();
    changes_.erase(changes_.begin());
}

void ImageBlocks::follow_lights(const std::vector<LightRecord>& lights) {
    std::vector<Place> now;
    places_.clear();
    for (const LightRecord& light : lights) {
        const auto before = std::ranges::find(lights_, light.id, &Place::id);
        const bool stays = before != lights_.end() && casts_same_shadows(*before->light, *light.light);
        now.push_back({light.id, light.light, stays ? before->number : next_place_++});
        places_.push_back(now.back().number);
    }
    lights_ = std::move(now);
}

ImageBlocks::Kept ImageBlocks::kept(int block) const {
    if (records_.empty()) return {};
    const Record& record = records_[std::size_t(block)];
    const std::uint64_t behind = version_ - record.version;
    if (record.count == 0 || behind > changes_.size()) return {};
    return {record.words.get(), std::span(changes_).last(std::size_t(behind))};
}

bool ImageBlocks::make_room(Record& record, std::size_t words) {
    if (words <= record.capacity) return true;
    words += words / 4;  // other views need a little more, or less
    const std::size_t more = (words - record.capacity) * sizeof(std::uint64_t);
    for (std::size_t used = bytes_.load(std::memory_order_relaxed);;) {
        if (used + more > limit_) return false;
        if (bytes_.compare_exchange_weak(used, used + more, std::memory_order_relaxed)) break;
    }
    record.words = std::make_unique_for_overwrite<std::uint64_t[]>(words);
    record.capacity = std::uint32_t(words);
    return true;
}

void ImageBlocks::keep(int block, std::span<const std::uint64_t> words) {
    if (records_.empty()) return;
    Record& record = records_[std::size_t(block)];
    record.count = 0;
    if (!make_room(record, words.size())) return;
    std::ranges::copy(words, record.words.get());
    record.count = std::uint32_t(words.size());
    record.version = version_;
}

}  // namespace raybound
