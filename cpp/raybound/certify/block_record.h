// How the ray trees of an image block are kept: for each batch what its rays hit and which lights they were found to
// see, then the batches that it sends on, all in words of 64 bits.
#pragma once

#include <cstring>
#include <span>
#include <vector>

#include "raybound/certify/ray_batch.h"

namespace raybound::record {

using Words = std::vector<std::uint64_t>;

struct Batch {
    std::uint32_t reflected, refracted;  // where these trees begin, in words from here; 0: nothing was sent on
    std::uint16_t faces, lights;
    float until;                 // no ray looks for hits beyond
    RaySet hit, alone, special;  // (BatchFindings)
};

// Leaves are counted from the primitive's first one: others may come and go before it.
struct Face {
    std::uint32_t primitive, leaf;
    std::int32_t face, face_offset;
    std::uint32_t entering;
    float ior;  // that refracted rays were sent on with
    RaySet rays;
};

// Then sets of rays for which cells did not do, by why: those of `reasons`.
struct Light {
    std::uint32_t place, reasons;
    RaySet asked, blocked;
};

template <class T>
inline constexpr std::size_t words_of = sizeof(T) / sizeof(std::uint64_t);

template <class T>
std::size_t append(Words& words, const T* values, std::size_t count) {
    static_assert(sizeof(T) % sizeof(std::uint64_t) == 0 && std::is_trivially_copyable_v<T>);
    const std::size_t at = words.size();
    words.resize(at + count * words_of<T>);
    std::memcpy(words.data() + at, values, count * sizeof(T));
    return at;
}

template <class T>
const std::uint64_t* read(const std::uint64_t* words, T* values, std::size_t count) {
    std::memcpy(values, words, count * sizeof(T));
    return words + count * words_of<T>;
}

// Which rays of a batch have sent on those of the next, in their order: before each tree.
struct Parents {
    std::uint64_t count;
    std::uint8_t parent[batch_size];
};

}  // namespace raybound::record
