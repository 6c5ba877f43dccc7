// A bounding volume hierarchy, eight children wide, built by the surface area heuristic. Traversal is conservative: it
// reaches every leaf that holds a box which a brute-force loop would find crossed.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "raybound/geometry/box.h"
#include "raybound/geometry/large_array.h"
#include "raybound/geometry/watch.h"
#include "raybound/numbers/pack.h"

namespace raybound {

struct alignas(64) BvhNode {
    float plane[6][pack_width];       // lower x, y, z, upper x, y, z; absent children have an empty box
    std::uint32_t child[pack_width];  // a node, or what the maker of leaves returned, with the high bit set
    std::uint32_t parent;             // the node and slot that lead here: node * 8 + slot
};

// Who is told what a search visits: nobody, or two counters. A visit without an observer is the plain function that it
// is, and so is the code of its traversals.
struct Unseen {
    void node() const {}
    void primitive() const {}
};
struct Visits {
    std::uint64_t nodes = 0, primitives = 0;
};
struct Counted {
    Visits* visits;
    void node() const { ++visits->nodes; }
    void primitive() const { ++visits->primitives; }
};
template <class Visit>
struct CountedVisit {
    const Visit& visit;
    Counted observer;
    template <class... Arguments>
    auto operator()(Arguments... arguments) const {
        return visit(arguments...);
    }
};
template <class Visit>
inline const Visit& observed(const Visit& visit, Unseen) {
    return visit;
}
template <class Visit>
inline CountedVisit<Visit> observed(const Visit& visit, Counted observer) {
    return {visit, observer};
}
template <class Visit>
inline Unseen observer_of(const Visit&) {
    return {};
}
template <class Visit>
inline Counted observer_of(const CountedVisit<Visit>& visit) {
    return visit.observer;
}

class Bvh {
  public:
    static constexpr std::uint32_t leaf_bit = 0x80000000u;
    static constexpr std::uint32_t no_parent = 0xffffffffu;

    // How leaves are made. Items of one class may share a leaf, up to the class's capacity (at most 8); `make_leaf`
    // returns a number below 2^31 for the leaf.
    struct Leaves {
        std::function<int(std::uint32_t item)> class_of;
        std::function<int(int item_class)> capacity;
        std::function<std::uint32_t(std::span<const std::uint32_t> items)> make_leaf;
    };

    Bvh() = default;
    Bvh(std::span<const Box> boxes, const Leaves& leaves, Lookout& lookout);

    std::span<const BvhNode> nodes() const { return nodes_; }
    std::size_t bytes() const { return nodes_.capacity() * sizeof(BvhNode); }

    // Gives the leaf at a slot another box, and all nodes above it theirs.
    void refit(std::uint32_t slot, const Box& box);

    // What a search costs, up to a factor: the area of all boxes. It grows as refitting loosens the tree.
    float cost() const;

    // The parts of the tree that the rays of a bundle can meet, as the children of a few nodes: where searches of its
    // rays may begin instead of at the root.
    struct Frontier {
        static constexpr int capacity = 2;
        BvhNode nodes[capacity];
        int count = 0;
    };
    void find_frontier(const SlabBundle& bundle, Frontier& frontier) const;

    // Calls visit(leaf, near) for each leaf whose box the ray crosses within [0, t_max], nearer ones first; `near` is
    // the entry into its box. visit may lower t_max. Boxes that begin exactly at t_max are visited: a tie has to be
    // settled by ids.
    template <class T, class Visit>
    void traverse(const SlabRay<T>& ray, T& t_max, const Visit& visit, const Frontier* from = nullptr) const;

    // The same in any order, until visit(leaf, near) returns true: is there such a leaf?
    template <class T, class Visit>
    bool any(const SlabRay<T>& ray, T t_max, const Visit& visit) const;

    // Calls visit(leaf, near) for each leaf whose box a bundle may meet, nearer children first: test(planes, near)
    // returns the children of a node that it may meet, and where at the earliest; `until` is asked before each node,
    // and nothing that begins beyond it is visited.
    template <class Test, class Until, class Visit>
    void visit(const Test& test, const Until& until, const Visit& visit_leaf) const;

  private:
    LargeArray<BvhNode> nodes_;
};

namespace bvh {

// Depth is at most 72 (the builder halves ranges below level 40), and each level leaves seven siblings behind.
inline constexpr int stack_size = 72 * (pack_width - 1) + 1;

// A bit for each child that the ray crosses within [0, t_max], and where it enters each.
template <class T>
[[gnu::always_inline]] inline std::uint32_t crossed_children(const BvhNode& node, const SlabRay<T>& ray, T t_max,
                                                             Pack<T>& near) {
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
void Bvh::traverse(const SlabRay<T>& ray, T& t_max, const Visit& visit, const Frontier* from) const {
    if (nodes_.empty()) return;
    const BvhNode* const nodes = nodes_.data();
    bvh::Entry<T> stack[bvh::stack_size + Frontier::capacity * pack_width];
    int size = 0;
    bvh::Entry<T> top{T(0), 0};
    if (from) {
        for (int i = 0; i < from->count; ++i) {
            Pack<T> near;
            std::uint32_t crossed = bvh::crossed_children(from->nodes[i], ray, t_max, near);
            while (crossed != 0) {
                const int k = bvh::take_lowest(crossed);
                bvh::push_sorted(stack, 0, size, {near[k], from->nodes[i].child[k]});
            }
        }
        if (size == 0) return;
        top = stack[--size];
    }
    for (;;) {
        while (!(top.child & leaf_bit)) {
            const BvhNode& node = nodes[top.child];
            observer_of(visit).node();
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
        observer_of(visit).node();
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

template <class Test, class Until, class Visit>
void Bvh::visit(const Test& test, const Until& until, const Visit& visit_leaf) const {
    if (nodes_.empty()) return;
    bvh::Entry<float> stack[bvh::stack_size];
    int size = 0;
    bvh::Entry<float> top{0, 0};
    for (;;) {
        if (top.child & leaf_bit) {
            visit_leaf(top.child & ~leaf_bit, top.near);
        } else {
            const BvhNode& node = nodes_[top.child];
            const auto plane = [&node](std::uint32_t i) { return Pack<float>::load(node.plane[i]); };
            Pack<float> near;
            const int begin = size;
            for (std::uint32_t met = test(plane, near); met != 0;) {
                const int k = bvh::take_lowest(met);
                bvh::push_sorted(stack, begin, size, {near[k], node.child[k]});
            }
        }
        do {
            if (size == 0) return;
            top = stack[--size];
        } while (top.near > until());
    }
}

}  // namespace raybound
