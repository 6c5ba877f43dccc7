// Many questions about rays at once.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "raybound/frame/work_queue.h"
#include "raybound/geometry/ray.h"

namespace raybound {

// The ray of a direction as users give it, which is `scale` times as long as the ray's.
template <class T>
inline Ray<T> user_ray(const Vec3<T>& origin, Vec3<T> direction, T& scale, std::size_t index) {
    if (!scale_direction(direction, scale))
        throw std::invalid_argument("directions must not be zero, direction " + std::to_string(index) + " is");
    return make_ray(origin, direction);
}

// Calls answer(i) for every i in [0, count), in chunks, on some threads (0: all cores).
template <class Answer>
void answer_all(std::size_t count, const Watch& watch, const Answer& answer, int threads = 0) {
    constexpr std::size_t chunk = 512;
    std::atomic<bool> cancelled = false;
    const auto work = [&](int item, int) {
        const std::size_t begin = std::size_t(item) * chunk;
        for (std::size_t i = begin; i < std::min(count, begin + chunk); ++i) answer(i);
    };
    run_work(int((count + chunk - 1) / chunk), threads, cancelled, work, watch);
}

// Puts lists one after the other into `all`; returns where each begins, and where the last one ends.
template <class Item>
std::vector<std::int64_t> append_all(const std::vector<std::vector<Item>>& lists, std::vector<Item>& all) {
    std::vector<std::int64_t> offsets{0};
    for (const std::vector<Item>& list : lists) {
        all.insert(all.end(), list.begin(), list.end());
        offsets.push_back(std::int64_t(all.size()));
    }
    return offsets;
}

}  // namespace raybound
