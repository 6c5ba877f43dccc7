// A bounding volume hierarchy, four children wide, built by the surface area heuristic. Traversal is conservative: it
// finds exactly the primitives whose bounds a brute-force loop would find crossed.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "raybound/geometry/box.h"
#include "raybound/numbers/pack.h"

namespace raybound {

struct alignas(64) BvhNode {
    float lower[3][4], upper[3][4];
    std::uint32_t child[4];  // a node, or a primitive if the high bit is set; absent children have an empty box
};

class Bvh {
  public:
    static constexpr std::uint32_t primitive_bit = 0x80000000u;

    Bvh() = default;
    explicit Bvh(std::span<const Box> boxes);

    std::span<const BvhNode> nodes() const { return nodes_; }
    std::size_t bytes() const { return nodes_.size() * sizeof(BvhNode); }

    // Calls visit(primitive, entry, &t_max) for each primitive whose box the ray crosses within [0, t_max]; boxes
    // nearer first. visit may lower t_max, and returns true to stop. Boxes that begin exactly at t_max are visited: a
    // tie has to be settled by ids.
    template <class T, class Visit>
    void traverse(const Ray<T>& ray, T t_max, const Visit& visit) const;

  private:
    std::vector<BvhNode> nodes_;
};

namespace bvh {

template <class T>
inline Pack4<T> load(const float (&p)[4]) {
    return Pack4<T>{T(p[0]), T(p[1]), T(p[2]), T(p[3])};
}

template <class T>
struct Entry {
    T near;
    std::uint32_t child;
};

// Which children the ray crosses within [0, t_max] (a byte each, not zero where it does), and where it enters each.
template <class T>
inline std::uint32_t crossed_children(const BvhNode& node, const Ray<T>& ray, T t_max, Pack4<T>& near) {
    typedef std::int8_t Bytes __attribute__((vector_size(4)));
    const Pack4<T> lower[3] = {load<T>(node.lower[0]), load<T>(node.lower[1]), load<T>(node.lower[2])};
    const Pack4<T> upper[3] = {load<T>(node.upper[0]), load<T>(node.upper[1]), load<T>(node.upper[2])};
    const BoxInterval<Pack4<T>> inside = slab_interval(lower, upper, ray, T(0), t_max);
    near = inside.near;
    return std::bit_cast<std::uint32_t>(__builtin_convertvector(inside.near <= inside.far, Bytes));
}

// Sorts a few entries, farthest first: the order in which a stack gives back the nearest.
template <class T>
inline void push_sorted(Entry<T>* stack, int& size, int begin, const Entry<T>& entry) {
    int at = size++;
    for (; at > begin && stack[at - 1].near < entry.near; --at) stack[at] = stack[at - 1];
    stack[at] = entry;
}

}  // namespace bvh

template <class T, class Visit>
void Bvh::traverse(const Ray<T>& ray, T t_max, const Visit& visit) const {
    if (nodes_.empty()) return;
    bvh::Entry<T> stack[256];  // depth is at most 64 (the builder halves below it), three siblings each
    int size = 0;
    stack[size++] = {T(0), 0};
    while (size > 0) {
        const bvh::Entry<T> top = stack[--size];
        if (top.near > t_max) continue;
        if (top.child & primitive_bit) {
            if (visit(top.child & ~primitive_bit, top.near, t_max)) return;
            continue;
        }
        const BvhNode& node = nodes_[top.child];
        Pack4<T> near;
        const int begin = size;
        for (std::uint32_t crossed = bvh::crossed_children(node, ray, t_max, near); crossed != 0;) {
            const int k = std::countr_zero(crossed) / 8;
            crossed &= ~(0xffu << (8 * k));
            bvh::push_sorted(stack, size, begin, {near[k], node.child[k]});
        }
    }
}

}  // namespace raybound
