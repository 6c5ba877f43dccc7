#include "raybound/geometry/large_array.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <new>
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace raybound {

namespace {

// The address sanitizer is to see each array's end.
#ifndef __has_feature
#define __has_feature(x) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || __has_feature(address_sanitizer)
constexpr bool keeps_blocks = false;
#else
constexpr bool keeps_blocks = true;
#endif

constexpr std::size_t page = std::size_t(1) << 21, cache_line = 64;

struct Block {
    void* memory;
    std::size_t bytes;
};

std::align_val_t block_alignment(std::size_t bytes, std::size_t alignment) {
    return std::align_val_t(bytes >= page ? page : std::max(alignment, cache_line));
}

// Blocks that were released, the oldest first, for arrays of the same size: new pages cost more than what is drawn on
// them. Both limits are TUNED for two frames of 1200 x 900 pixels.
class ReleasedBlocks {
  public:
    static constexpr std::size_t least = std::size_t(1) << 18, most_bytes = std::size_t(1) << 26, most_blocks = 16;

    void* take(std::size_t bytes) {
        const std::scoped_lock lock(mutex_);
        for (std::size_t i = count_; i-- > 0;)
            if (blocks_[i].bytes == bytes) return remove(i);
        return nullptr;
    }

    // Gives back what has no place, if only the block itself.
    void keep(Block block) {
        std::array<Block, most_blocks + 1> out;
        std::size_t out_count = 0;
        {
            const std::scoped_lock lock(mutex_);
            while (count_ > 0 && (count_ == most_blocks || bytes_ + block.bytes > most_bytes)) {
                out[out_count].bytes = blocks_[0].bytes;
                out[out_count++].memory = remove(0);
            }
            blocks_[count_++] = block;
            bytes_ += block.bytes;
        }
        for (std::size_t i = 0; i < out_count; ++i)
            ::operator delete(out[i].memory, block_alignment(out[i].bytes, cache_line));
    }

  private:
    void* remove(std::size_t i) {
        void* memory = blocks_[i].memory;
        bytes_ -= blocks_[i].bytes;
        std::copy(blocks_.begin() + std::ptrdiff_t(i) + 1, blocks_.begin() + std::ptrdiff_t(count_--),
                  blocks_.begin() + std::ptrdiff_t(i));
        return memory;
    }

    std::mutex mutex_;
    std::array<Block, most_blocks> blocks_;
    std::size_t count_ = 0, bytes_ = 0;
};

// Never destroyed: arrays may outlive every static object.
ReleasedBlocks& released_blocks() {
    static ReleasedBlocks& blocks = *new ReleasedBlocks;
    return blocks;
}

bool is_kept(std::size_t bytes, std::size_t alignment) {
    return keeps_blocks && bytes >= ReleasedBlocks::least && bytes <= ReleasedBlocks::most_bytes &&
           alignment <= cache_line;
}

}  // namespace

void* allocate_array(std::size_t bytes, std::size_t alignment) {
    if (is_kept(bytes, alignment))
        if (void* memory = released_blocks().take(bytes)) return memory;
    void* memory = ::operator new(bytes, block_alignment(bytes, alignment));
#ifdef __linux__
    if (bytes >= page) madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: nothing is lost where it is not taken
#endif
    return memory;
}

void release_array(void* memory, std::size_t bytes, std::size_t alignment) {
    if (is_kept(bytes, alignment)) return released_blocks().keep({memory, bytes});
    ::operator delete(memory, block_alignment(bytes, alignment));
}

}  // namespace raybound
