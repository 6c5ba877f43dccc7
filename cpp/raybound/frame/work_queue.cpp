#include "raybound/frame/work_queue.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "raybound/frame/processors.h"

namespace raybound {

namespace {

// What the threads share: the next item, how many are done, and the first exception.
struct Shared {
    std::atomic<int> next{0}, done{0};
    std::mutex mutex;
    std::condition_variable finished;
    int running = 0;
    std::exception_ptr error;
};

void drain(Shared& shared, int items, int worker, std::atomic<bool>& cancelled,
           const std::function<void(int, int)>& work) {
    try {
        for (int item = shared.next++; item < items && !cancelled; item = shared.next++) {
            work(item, worker);
            ++shared.done;
        }
    } catch (...) {
        const std::scoped_lock lock(shared.mutex);
        if (!shared.error) shared.error = std::current_exception();
        cancelled = true;
    }
    const std::scoped_lock lock(shared.mutex);
    if (--shared.running == 0) shared.finished.notify_all();
}

}  // namespace

int thread_count(int threads) { return threads > 0 ? threads : usable_processors(); }

int run_work(int items, int threads, std::atomic<bool>& cancelled, const std::function<void(int, int)>& work,
             const Watch& watch) {
    const int count = std::max(1, std::min(thread_count(threads), items));
    Shared shared;
    shared.running = count;
    std::vector<std::jthread> pool;
    const auto wait = [&] {
        std::unique_lock lock(shared.mutex);
        while (!shared.finished.wait_for(lock, std::chrono::milliseconds(20), [&] { return shared.running == 0; })) {
            lock.unlock();
            watch(items ? double(shared.done) / items : 1.0);
            lock.lock();
        }
    };
    try {
        for (int k = 0; k < count; ++k) pool.emplace_back([&, k] { drain(shared, items, k, cancelled, work); });
        wait();
    } catch (...) {
        cancelled = true;  // the pool's destructors join
        throw;
    }
    if (shared.error) std::rethrow_exception(shared.error);
    return count;
}

}  // namespace raybound
