// Whether a shared object may be taken apart.
#pragma once

#include <atomic>
#include <memory>

namespace raybound {

// What others have read before they let go must not be overtaken by what is written now.
template <class T>
inline bool is_sole_owner(const std::shared_ptr<T>& pointer) {
    const bool sole = pointer.use_count() == 1;
    std::atomic_thread_fence(std::memory_order_acquire);
    return sole;
}

}  // namespace raybound
