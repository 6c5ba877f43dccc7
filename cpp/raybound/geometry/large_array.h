// Vectors for what rays walk at random and for frames: large ones ask the system for large pages, of which far fewer
// are looked up, and leave their memory to the next of the same size.
#pragma once

#include <cstddef>
#include <vector>

namespace raybound {

// Memory for arrays, aligned to cache lines at least; `bytes` and `alignment` must be the same for both.
void* allocate_array(std::size_t bytes, std::size_t alignment);
void release_array(void* memory, std::size_t bytes, std::size_t alignment);

template <class T>
struct LargePageAllocator {
    using value_type = T;

    LargePageAllocator() = default;
    template <class S>
    LargePageAllocator(const LargePageAllocator<S>&) {}
    bool operator==(const LargePageAllocator&) const { return true; }

    T* allocate(std::size_t count) { return static_cast<T*>(allocate_array(count * sizeof(T), alignof(T))); }
    void deallocate(T* memory, std::size_t count) { release_array(memory, count * sizeof(T), alignof(T)); }
};

template <class T>
using LargeArray = std::vector<T, LargePageAllocator<T>>;

}  // namespace raybound
