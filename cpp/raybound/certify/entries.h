// The words in which cells keep verdicts: two bits of verdict and the index of a record [length, primitives...].
#pragma once

#include <span>

#include "raybound/certify/arena.h"
#include "raybound/certify/cells.h"

namespace raybound::entries {

// A list too long to keep has no record: its parts have to be found anew.
inline constexpr std::uint32_t longest = 1024;

inline std::uint32_t make(CellVerdict verdict, std::uint32_t record) { return record << 2 | std::uint32_t(verdict); }
inline CellVerdict verdict(std::uint32_t entry) { return CellVerdict(entry & 3); }
inline std::uint32_t record(std::uint32_t entry) { return entry >> 2; }
inline bool is_too_long(std::uint32_t entry) { return verdict(entry) == CellVerdict::list && record(entry) == 0; }

inline std::span<const std::uint32_t> primitives(const Arena& arena, std::uint32_t entry) {
    if (record(entry) == 0) return {};
    const std::uint32_t* words = arena.at(record(entry));
    return {words + 1, words[0]};
}

// 0 if there is no memory.
inline std::uint32_t store(Arena& arena, CellVerdict verdict, std::span<const std::uint32_t> primitives) {
    if (verdict == CellVerdict::list && primitives.size() > longest) return make(verdict, 0);
    if (verdict == CellVerdict::lit) return make(verdict, 0);
    const std::uint32_t index = arena.allocate(std::uint32_t(primitives.size()) + 1);
    if (index == Arena::none) return 0;
    std::uint32_t* words = arena.at(index);
    words[0] = std::uint32_t(primitives.size());
    for (std::size_t i = 0; i < primitives.size(); ++i) words[i + 1] = primitives[i];
    return make(verdict, index);
}

inline void release(Arena& arena, std::uint32_t entry) {
    if (record(entry) != 0) arena.release(record(entry), *arena.at(record(entry)) + 1);
}

}  // namespace raybound::entries
