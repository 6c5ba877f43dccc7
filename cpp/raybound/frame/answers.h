// Many questions about rays at once.
#pragma once

#include <algorithm>
#include <vector>

#include "raybound/frame/user_rays.h"
#include "raybound/frame/work_queue.h"
#include "raybound/geometry/ray.h"

namespace raybound {

// The ray of a direction that has passed require_directions, which is `scale` times as long as the ray's.
template <class T>
inline Ray<T> user_ray(const Vec3<T>& origin, Vec3<T> direction, T& scale) {
    scale_direction(direction, scale);
    return make_ray(origin, direction);
}

// Calls answer(i) for every i in [0, count), in chunks, on some threads (0: as many as may be used).
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
