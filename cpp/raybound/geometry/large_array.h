// Vectors for what rays walk at random: large ones ask the system for large pages, of which far fewer are looked up.
#pragma once

#include <cstdlib>
#include <new>
#include <vector>
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace raybound {

template <class T>
struct LargePageAllocator {
    using value_type = T;

    LargePageAllocator() = default;
    template <class S>
    LargePageAllocator(const LargePageAllocator<S>&) {}
    bool operator==(const LargePageAllocator&) const { return true; }

    T* allocate(std::size_t count) {
        const std::size_t bytes = count * sizeof(T);
        void* memory = ::operator new(bytes, alignment(bytes));
#ifdef __linux__
        if (bytes >= page) madvise(memory, bytes, MADV_HUGEPAGE);  // a hint: nothing is lost where it is not taken
#endif
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t count) { ::operator delete(memory, alignment(count * sizeof(T))); }

  private:
    static constexpr std::size_t page = std::size_t(1) << 21, cache_line = 64;

    static std::align_val_t alignment(std::size_t bytes) {
        return std::align_val_t(bytes >= page ? page : alignof(T) > cache_line ? alignof(T) : cache_line);
    }
};

template <class T>
using LargeArray = std::vector<T, LargePageAllocator<T>>;

}  // namespace raybound
