// Memory for many small records that never move: words in chunks, with a limit. Records are named by the index of their
// first word; 0 names none. Allocation is locked, reading is not: whoever has an index may read its words.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace raybound {

class Arena {
  public:
    static constexpr std::uint32_t chunk_words = 1u << 14;
    static constexpr std::size_t chunk_bytes = chunk_words * sizeof(std::uint32_t);
    static constexpr std::uint32_t none = 0;

    // At most `limit` bytes of all that is kept, in whole chunks.
    explicit Arena(std::size_t limit = 0);

    // `words` zeros; none if the limit does not allow it, or if a chunk cannot hold so many.
    std::uint32_t allocate(std::uint32_t words);
    void release(std::uint32_t index, std::uint32_t words);
    void reset(std::size_t limit);  // nothing is kept

    std::uint32_t* at(std::uint32_t index) const { return chunks_[index / chunk_words].get() + index % chunk_words; }
    std::atomic_ref<std::uint32_t> word(std::uint32_t index) const { return std::atomic_ref(*at(index)); }

    std::size_t limit() const { return chunks_.size() * chunk_bytes; }
    std::size_t bytes() const;                                                     // of chunks, and to know of them
    std::size_t used() const;                                                      // of records
    bool has_refused() const { return refused_.load(std::memory_order_relaxed); }  // since the last `accept`
    void accept() { refused_ = false; }

  private:
    using Words = std::unique_ptr<std::uint32_t[]>;

    mutable std::mutex mutex_;
    std::vector<Words> chunks_;
    std::size_t count_ = 0;             // of chunks in use
    std::uint32_t next_ = 1, end_ = 0;  // the rest of the last chunk
    std::vector<std::uint32_t> free_;   // by words: the first free record, whose first word leads to the next
    std::size_t used_words_ = 0;
    std::atomic<bool> refused_ = false;
};

}  // namespace raybound
