// Rays that are traced together: up to 64, side by side, in packs of eight.
#pragma once

#include <algorithm>
#include <cstring>

#include "raybound/shapes/intersect_pack.h"
#include "raybound/trace/search.h"

namespace raybound {

inline constexpr int batch_size = 64;
inline constexpr int batch_packs = batch_size / pack_width;

// Sets of rays, the first ray's bit lowest.
using RaySet = std::uint64_t;

inline int take_first(RaySet& set) {
    const int first = std::countr_zero(set);
    set &= set - 1;
    return first;
}
inline std::uint32_t lanes_of_pack(RaySet set, int pack) { return std::uint32_t(set >> (pack * pack_width)) & 0xffu; }
inline RaySet set_of_pack(std::uint32_t lanes, int pack) { return RaySet(lanes) << (pack * pack_width); }

inline void store(const FloatPack& pack, float* to) { std::memcpy(to, &pack.v, sizeof pack.v); }

// Numbers of rays, vectors of rays; by packs or one by one.
struct alignas(64) BatchFloats {
    float value[batch_size];

    float& operator[](int i) { return value[i]; }
    float operator[](int i) const { return value[i]; }
    FloatPack pack(int k) const { return FloatPack::load(value + k * pack_width); }
};
struct BatchVectors {
    BatchFloats x, y, z;

    Vec3f operator[](int i) const { return {x[i], y[i], z[i]}; }
    void set(int i, const Vec3f& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
    Vec3<FloatPack> pack(int k) const { return {x.pack(k), y.pack(k), z.pack(k)}; }
    void set_pack(int k, const Vec3<FloatPack>& v) {
        store(v.x, x.value + k * pack_width);
        store(v.y, y.value + k * pack_width);
        store(v.z, z.value + k * pack_width);
    }
};

// What each ray knows of where it begins. What decides about a primitive, for packs: the solid that a ray is within,
// and the one that it has left, for good or not.
struct BatchStates {
    alignas(64) std::uint32_t within[batch_size], gone[batch_size], left[batch_size];
    Departure from[batch_size];

    void set(int i, const Departure& departure) {
        from[i] = departure;
        within[i] = departure.within;
        gone[i] = departure.gone();
        left[i] = departure.for_good ? Departure::none : departure.left;
    }
};

// The lanes of a pack that hold a primitive's number.
inline std::uint32_t lanes_with(const std::uint32_t (&numbers)[batch_size], int pack, std::uint32_t primitive) {
    PackVector<std::int32_t> lanes;
    std::memcpy(&lanes, numbers + pack * pack_width, sizeof lanes);
    return bits(PackMask<float>{lanes == std::int32_t(primitive)});
}

// The lanes of a pack that search for a primitive's crossing: not those that have left it for good, nor those that it
// is known of how they leave it.
inline std::uint32_t asking_lanes(const BatchStates& states, int pack, std::uint32_t primitive) {
    return 0xffu & ~(lanes_with(states.gone, pack, primitive) | lanes_with(states.within, pack, primitive));
}

// The lanes of a pack that are inside of some solid.
inline std::uint32_t lanes_within(const BatchStates& states, int pack) {
    return 0xffu & ~lanes_with(states.within, pack, Departure::none);
}

// Directions are as rays have them (flushed).
struct RayBatch {
    int count = 0;
    BatchVectors origin, direction;
    BatchFloats travelled;  // from the eye to the origin
    BatchStates states;

    int packs() const { return (count + pack_width - 1) / pack_width; }
    RaySet all() const { return count == batch_size ? ~RaySet(0) : (RaySet(1) << count) - 1; }
    void add(const Vec3f& o, const Vec3f& d, float way, const Departure& from) {
        origin.set(count, o);
        direction.set(count, d);
        travelled[count] = way;
        states.set(count++, from);
    }
    // Eight eye rays at once, where as many stand before as fill packs.
    void add_pack(const Vec3<FloatPack>& o, const Vec3<FloatPack>& d, const Departure& eye) {
        const int k = count / pack_width;
        origin.set_pack(k, o);
        direction.set_pack(k, d);
        store(FloatPack(0), travelled.value + count);
        for (int lane = 0; lane < pack_width; ++lane) states.set(count++, eye);
    }
    // Lanes out of use repeat the last ray.
    void pad() {
        for (int k = count; k < packs() * pack_width; ++k) {
            origin.set(k, origin[count - 1]);
            direction.set(k, direction[count - 1]);
            travelled[k] = travelled[count - 1];
            states.set(k, states.from[count - 1]);
        }
    }
    RayPack pack(int k) const { return RayPack(origin.pack(k), direction.pack(k)); }
};

// Why a search of the scene was needed, the first reason first; no: none was.
enum class Searched : std::uint8_t { no, eye, shadow, reflection, refraction, cost, unsupported };

// What a batch's rays see.
struct BatchRadiance {
    BatchVectors radiance;
    BatchFloats t;                    // infinite for the background
    std::int32_t object[batch_size];  // its id, -1 for the background
    Searched searched[batch_size];
};

}  // namespace raybound
