// A bounding volume hierarchy, eight children wide, built by the surface area heuristic. Traversal is conservative: it
// reaches every leaf that holds a box which a brute-force loop would find crossed.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "raybound/geometry/box.h"
#include "raybound/geometry/large_array.h"
#include "raybound/numbers/pack.h"

namespace raybound {

struct alignas(64) BvhNode {
    float plane[6][pack_width];       // lower x, y, z, upper x, y, z; absent children have an empty box
    std::uint32_t child[pack_width];  // a node, or what the maker of leaves returned, with the high bit set
    std::uint32_t parent;             // the node and slot that lead here: node * 8 + slot
};

class Bvh {
  public:
    static constexpr std::uint32_t leaf_bit = 0x80000000u;
    static constexpr std::uint32_t no_parent = 0xffffffffu;

    // How leaves are made. Items of one class may share a leaf, up to the class's capacity (at most 8); `make_leaf` is
    // told the items and the slot (node * 8 + slot) that leads to the leaf, and returns a number below 2^31.
    struct Leaves {
        std::function<int(std::uint32_t item)> class_of;
        std::function<int(int item_class)> capacity;
        std::function<std::uint32_t(std::span<const std::uint32_t> items, std::uint32_t slot)> make_leaf;
    };

    Bvh() = default;
    Bvh(std::span<const Box> boxes, const Leaves& leaves);

    std::span<const BvhNode> nodes() const { return nodes_; }
    std::size_t bytes() const { return nodes_.capacity() * sizeof(BvhNode); }

    // Gives the leaf at a slot another box, and all nodes above it theirs.
    void refit(std::uint32_t slot, const Box& box);

    // What a search costs, up to a factor: the area of all boxes. It grows as refitting loosens the tree.
    float cost() const;

    // Calls visit(leaf, near) for each leaf whose box the ray crosses within [0, t_max], nearer ones first; `near` is
    // the entry into its box. visit may lower t_max. Boxes that begin exactly at t_max are visited: a tie has to be
    // settled by ids.
    template <class T, class Visit>
    void traverse(const SlabRay<T>& ray, T& t_max, const Visit& visit) const;

    // The same in any order, until visit(leaf, near) returns true: is there such a leaf?
    template <class T, class Visit>
    bool any(const SlabRay<T>& ray, T t_max, const Visit& visit) const;

  private:
    LargeArray<BvhNode> nodes_;
};

namespace bvh {

// Depth is at most 72 (the builder halves ranges below level 40), and each level leaves seven siblings behind.
inline constexpr int stack_size = 72 * (pack_width - 1) + 1;

// A bit for each child that the ray crosses within [0, t_max], and where it enters each.
template <class T>
inline std::uint32_t crossed_children(const BvhNode& node, const SlabRay<T>& ray, T t_max, Pack<T>& near) {
    const auto plane = [&node](std::uint32_t i) { return Pack<T>::load(node.plane[i]); };
    const BoxInterval<Pack<T>> inside = slab_interval<Pack<T>>(ray, t_max, plane);
    near = inside.near;
    return bits(inside.near <= inside.far);
}

inline int take_lowest(std::uint32_t& set) {
    const int lowest = std::countr_zero(set);
    set &= set - 1;
    return lowest;
}

template <class T>
struct Entry {
    T near;
    std::uint32_t child;
};

// Puts one more crossed child on the stack, among those since `begin`, which come farthest first: the order in which
// the stack gives back the nearest.
template <class T>
inline void push_sorted(Entry<T>* stack, int begin, int& size, const Entry<T>& entry) {
    int at = size++;
    for (; at > begin && stack[at - 1].near < entry.near; --at) stack[at] = stack[at - 1];
    stack[at] = entry;
}

}  // namespace bvh

template <class T, class Visit>
void Bvh::traverse(const SlabRay<T>& ray, T& t_max, const Visit& visit) const {
    if (nodes_.empty()) return;
    const BvhNode* const nodes = nodes_.data();
    bvh::Entry<T> stack[bvh::stack_size];
    int size = 0;
    bvh::Entry<T> top{T(0), 0};
    for (;;) {
        while (!(top.child & leaf_bit)) {
            const BvhNode& node = nodes[top.child];
            Pack<T> near;
            std::uint32_t crossed = bvh::crossed_children(node, ray, t_max, near);
            if (crossed == 0) goto next;
            const auto take = [&]() -> bvh::Entry<T> {
                const int k = bvh::take_lowest(crossed);
                return {near[k], node.child[k]};
            };
            top = take();
            if (crossed == 0) continue;  // one child or two are by far the most frequent
            const bvh::Entry<T> second = take();
            const bool swapped = second.near < top.near;
            stack[size++] = swapped ? top : second;
            top = swapped ? second : top;
            if (crossed == 0) continue;
            const int begin = size - 1;
            bvh::push_sorted(stack, begin, size, top);
            while (crossed != 0) bvh::push_sorted(stack, begin, size, take());
            top = stack[--size];
        }
        visit(top.child & ~leaf_bit, top.near);
    next:
        do {
            if (size == 0) return;
            top = stack[--size];
        } while (top.near > t_max);
    }
}

template <class T, class Visit>
bool Bvh::any(const SlabRay<T>& ray, T t_max, const Visit& visit) const {
    if (nodes_.empty()) return false;
    std::uint32_t stack[bvh::stack_size];
    int size = 0;
    std::uint32_t current = 0;
    for (;;) {
        const BvhNode& node = nodes_[current];
        Pack<T> near;
        for (std::uint32_t crossed = bvh::crossed_children(node, ray, t_max, near); crossed != 0;) {
            const int k = bvh::take_lowest(crossed);
            const std::uint32_t child = node.child[k];
            if (!(child & leaf_bit))
                stack[size++] = child;
            else if (visit(child & ~leaf_bit, near[k]))
                return true;
        }
        if (size == 0) return false;
        current = stack[--size];
    }
}

}  // namespace raybound
