#include "raybound/certify/arena.h"

#include <algorithm>

namespace raybound {

namespace {

// Each chunk comes with a pointer to it; all of them with the heads of the lists of free records.
std::size_t chunks_within(std::size_t limit) {
    constexpr std::size_t lists = Arena::chunk_words * sizeof(std::uint32_t);
    const std::size_t count = limit < lists ? 0 : (limit - lists) / (Arena::chunk_bytes + sizeof(void*));
    return std::min<std::size_t>(count, std::size_t(1) << 16);  // as far as 30 bits reach
}

}  // namespace

Arena::Arena(std::size_t limit) { reset(limit); }

void Arena::reset(std::size_t limit) {
    const std::scoped_lock lock(mutex_);
    chunks_ = std::vector<Words>(chunks_within(limit));
    free_.assign(chunks_.empty() ? 0 : chunk_words, none);
    count_ = 0;
    next_ = 1;
    end_ = 0;
    used_words_ = 0;
    refused_ = false;
}

std::uint32_t Arena::allocate(std::uint32_t words) {
    const std::scoped_lock lock(mutex_);
    std::uint32_t index = none;
    if (words < free_.size() && free_[words] != none) {
        index = free_[words];
        free_[words] = *at(index);
        std::fill_n(at(index), words, 0u);
    } else {
        if (words >= chunk_words || (end_ < next_ + words && count_ == chunks_.size())) {
            refused_ = true;
            return none;
        }
        if (end_ < next_ + words) {  // (what is left of the last chunk stays unused)
            chunks_[count_] = std::make_unique<std::uint32_t[]>(chunk_words);
            next_ = std::uint32_t(count_) * chunk_words + (count_ == 0 ? 1 : 0);  // index 0 is none
            end_ = std::uint32_t(++count_) * chunk_words;
        }
        index = next_;
        next_ += words;
    }
    used_words_ += words;
    return index;
}

void Arena::release(std::uint32_t index, std::uint32_t words) {
    const std::scoped_lock lock(mutex_);
    *at(index) = free_[words];
    free_[words] = index;
    used_words_ -= words;
}

std::size_t Arena::bytes() const {
    const std::scoped_lock lock(mutex_);
    return count_ * chunk_bytes + chunks_.size() * sizeof(Words) + free_.size() * sizeof(std::uint32_t);
}

std::size_t Arena::used() const {
    const std::scoped_lock lock(mutex_);
    return used_words_ * sizeof(std::uint32_t);
}

}  // namespace raybound
