// Some rays of a batch in packs: read from where they stand, and written back.
#pragma once

#include "raybound/certify/ray_batch.h"

namespace raybound {

// Numbers of rays, compacted: the first ones in `order`, the last repeated to fill its pack.
struct Order {
    std::uint8_t index[batch_size];
    int count = 0;

    explicit Order(RaySet rays) {
        while (rays != 0) index[count++] = std::uint8_t(take_first(rays));
        for (int k = count; k % pack_width != 0; ++k) index[k] = index[count - 1];
    }
    int packs() const { return (count + pack_width - 1) / pack_width; }
    const std::uint8_t* pack(int k) const { return index + k * pack_width; }
    int lanes(int k) const { return std::min(pack_width, count - k * pack_width); }
};

// Rays that stand side by side, a whole pack of them, are read and written at once.
inline bool is_pack(const std::uint8_t* index) {
    return index[0] + 7 == index[7] && index[6] != index[7] && index[0] % pack_width == 0;
}
inline FloatPack gather(const BatchFloats& from, const std::uint8_t* index) {
    if (is_pack(index)) return from.pack(index[0] / pack_width);
    FloatPack v;
    for (int lane = 0; lane < pack_width; ++lane) v.v[lane] = from[index[lane]];
    return v;
}
inline Vec3<FloatPack> gather(const BatchVectors& from, const std::uint8_t* index) {
    return {gather(from.x, index), gather(from.y, index), gather(from.z, index)};
}
inline void scatter(const FloatPack& from, const std::uint8_t* index, int count, BatchFloats& to) {
    if (is_pack(index)) return store(from, to.value + index[0]);
    for (int lane = 0; lane < count; ++lane) to[index[lane]] = from.v[lane];
}
inline void scatter(const Vec3<FloatPack>& from, const std::uint8_t* index, int count, BatchVectors& to) {
    scatter(from.x, index, count, to.x);
    scatter(from.y, index, count, to.y);
    scatter(from.z, index, count, to.z);
}
inline RaySet scatter(std::uint32_t lanes, const std::uint8_t* index, int count) {
    if (is_pack(index)) return RaySet(lanes) << index[0];
    RaySet set = 0;
    for (int lane = 0; lane < count; ++lane) set |= RaySet(lanes >> lane & 1) << index[lane];
    return set;
}
inline std::uint32_t gather(RaySet set, const std::uint8_t* index) {
    if (is_pack(index)) return std::uint32_t(set >> index[0]) & 0xffu;
    std::uint32_t lanes = 0;
    for (int lane = 0; lane < pack_width; ++lane) lanes |= std::uint32_t(set >> index[lane] & 1) << lane;
    return lanes;
}

}  // namespace raybound
