// A queue of numbered work items for a few threads (the thesis's work queue, 7.8).
#pragma once

#include <atomic>
#include <functional>

#include "raybound/geometry/watch.h"

namespace raybound {

// The number of threads that is meant; 0 stands for usable_processors(), which another call may find changed.
int thread_count(int threads);

// Runs work(item, worker) for every item in [0, items), on `threads` threads (0: usable_processors()). Items are
// handed out in order, one at a time; results must not depend on who computes what. Returns the number of threads.
int run_work(int items, int threads, std::atomic<bool>& cancelled, const std::function<void(int, int)>& work,
             const Watch& watch);

}  // namespace raybound
