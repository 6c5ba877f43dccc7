#include "raybound/geometry/bvh.h"

#include <algorithm>
#include <array>

namespace raybound {

namespace {

constexpr int bin_count = 32, most_classes = 4;
constexpr int deepest_sah_level = 40;  // below it the median splits: so the depth stays under 40 + 32 levels of two

struct alignas(16) Item {
    Box bounds;
    std::uint32_t index;
    std::int32_t item_class;
    float center(int axis) const { return bounds.lower[axis] * 0.5f + bounds.upper[axis] * 0.5f; }
};

// How many items there are of each class, and so how many leaves they need at least.
struct Census {
    std::array<int, most_classes> count{};

    void add(int item_class) { ++count[std::size_t(item_class)]; }
    void add(const Census& o) {
        for (std::size_t k = 0; k < count.size(); ++k) count[k] += o.count[k];
    }
    int total() const { return count[0] + count[1] + count[2] + count[3]; }
};

struct Range {
    std::uint32_t begin, end;
    Box bounds;
    int depth;
    bool is_leaf;
    std::uint32_t size() const { return end - begin; }
};

class Builder {
  public:
    Builder(std::span<const Box> boxes, const Bvh::Leaves& leaves, LargeArray<BvhNode>& nodes, Lookout& lookout)
        : leaves_(leaves), nodes_(nodes), lookout_(lookout) {
        items_.reserve(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i)
            items_.push_back({boxes[i], std::uint32_t(i), leaves.class_of(std::uint32_t(i))});
        for (int k = 0; k < most_classes; ++k) capacity_[std::size_t(k)] = leaves.capacity(k);
    }

    void build() { build_node(make_range(0, std::uint32_t(items_.size()), 0), Bvh::no_parent); }

  private:
    template <class Visit>
    void visit_items(const Range& range, const Visit& visit) const {
        for (std::uint32_t i = range.begin; i < range.end; ++i) {
            lookout_.step();
            visit(items_[i]);
        }
    }

    Range make_range(std::uint32_t begin, std::uint32_t end, int depth) const {
        Range range{begin, end, {}, depth, false};
        Census census;
        visit_items(range, [&](const Item& item) {
            range.bounds.extend(item.bounds);
            census.add(item.item_class);
        });
        const auto first = std::size_t(items_[begin].item_class);
        range.is_leaf = census.count[first] == int(range.size()) && int(range.size()) <= capacity_[first];
        return range;
    }

    // A node of eight: split the range, then the part of the largest area, until there are eight or none can be split.
    std::uint32_t build_node(const Range& range, std::uint32_t parent) {
        std::vector<Range> parts{range};
        while (parts.size() < pack_width) {
            auto widest = parts.end();
            for (auto it = parts.begin(); it != parts.end(); ++it)
                if (!it->is_leaf && (widest == parts.end() || it->bounds.half_area() > widest->bounds.half_area()))
                    widest = it;
            if (widest == parts.end()) break;
            const auto [left, right] = split(*widest);
            *widest = left;
            parts.push_back(right);
        }
        const auto index = std::uint32_t(nodes_.size());
        nodes_.push_back(empty_node(parent));
        for (std::size_t k = 0; k < parts.size(); ++k) {
            const std::uint32_t slot = index * pack_width + std::uint32_t(k);
            const std::uint32_t child = parts[k].is_leaf ? make_leaf(parts[k]) : build_node(parts[k], slot);
            set_child(nodes_[index], k, parts[k].bounds);
            nodes_[index].child[k] = child;
        }
        return index;
    }

    std::uint32_t make_leaf(const Range& range) const {
        std::array<std::uint32_t, pack_width> indices{};
        for (std::uint32_t i = 0; i < range.size(); ++i) indices[i] = items_[range.begin + i].index;
        return leaves_.make_leaf(std::span(indices).first(range.size())) | Bvh::leaf_bit;
    }

  public:
    static BvhNode empty_node(std::uint32_t parent) {
        BvhNode node{};
        node.parent = parent;
        for (std::size_t k = 0; k < pack_width; ++k) {
            set_child(node, k, Box{});
            node.child[k] = Bvh::leaf_bit;
        }
        return node;
    }

    static void set_child(BvhNode& node, std::size_t k, const Box& box) {
        for (int axis = 0; axis < 3; ++axis) {
            node.plane[axis][k] = box.lower[axis];
            node.plane[axis + 3][k] = box.upper[axis];
        }
    }

  private:
    std::pair<Range, Range> split(const Range& range) {
        std::uint32_t middle = range.begin;
        if (range.size() <= pack_width) middle = partition_by_class(range);
        if (middle == range.begin || middle == range.end)
            middle = range.depth < deepest_sah_level ? partition_by_area(range) : range.begin;
        if (middle == range.begin || middle == range.end) middle = partition_at_median(range);
        return {make_range(range.begin, middle, range.depth + 1), make_range(middle, range.end, range.depth + 1)};
    }

    template <class Predicate>
    std::uint32_t partition(const Range& range, const Predicate& is_left) {
        const auto middle = std::partition(items_.begin() + range.begin, items_.begin() + range.end, is_left);
        return std::uint32_t(middle - items_.begin());
    }

    // A few items of several classes: one leaf for each class.
    std::uint32_t partition_by_class(const Range& range) {
        const int first = items_[range.begin].item_class;
        return partition(range, [&](const Item& item) { return item.item_class == first; });
    }

    std::uint32_t partition_at_median(const Range& range) {
        const std::uint32_t middle = range.begin + range.size() / 2;
        const Vec3f e = range.bounds.extent();
        const int axis = e.x > e.y ? (e.x > e.z ? 0 : 2) : (e.y > e.z ? 1 : 2);
        std::nth_element(items_.begin() + range.begin, items_.begin() + middle, items_.begin() + range.end,
                         [&](const Item& a, const Item& b) {
                             lookout_.step();
                             return std::pair(a.center(axis), a.index) < std::pair(b.center(axis), b.index);
                         });
        return middle;
    }

    struct Bin {
        Box bounds;
        Census census;
    };
    using Bins = std::array<Bin, bin_count>;

    // What a set of items costs: the leaves it needs times the area of its box (a full leaf costs what a node costs).
    float cost(const Bin& bin) const {
        int leaves = 0;
        for (std::size_t k = 0; k < most_classes; ++k)
            leaves += (bin.census.count[k] + capacity_[k] - 1) / capacity_[k];
        return float(leaves) * bin.bounds.half_area();
    }

    static int bin_of(float center, float lower, float scale) {
        return std::clamp(static_cast<int>((center - lower) * scale), 0, bin_count - 1);
    }

    struct Plane {
        float cost = infinity<float>;
        int axis = -1, bin = 0;
        float lower = 0, scale = 0;
    };

    void consider_planes(const Bins& bins, const Plane& candidate, Plane& best) const {
        std::array<float, bin_count> from_right{};
        Bin right;
        for (std::size_t k = bin_count - 1; k > 0; --k) {
            right.bounds.extend(bins[k].bounds);
            right.census.add(bins[k].census);
            from_right[k] = right.census.total() ? cost(right) : infinity<float>;
        }
        Bin left;
        for (std::size_t k = 0; k + 1 < bin_count; ++k) {
            left.bounds.extend(bins[k].bounds);
            left.census.add(bins[k].census);
            if (left.census.total() == 0) continue;
            const float both = cost(left) + from_right[k + 1];
            if (both < best.cost) best = candidate, best.cost = both, best.bin = int(k);
        }
    }

    // The cheapest of the planes between bins by the surface area heuristic; range.begin if there is none.
    std::uint32_t partition_by_area(const Range& range) {
        Box centers;
        visit_items(range, [&](const Item& item) { centers.extend({item.center(0), item.center(1), item.center(2)}); });
        std::array<Bins, 3> bins;
        Vec3f scale;
        for (int axis = 0; axis < 3; ++axis) {
            scale[axis] = float(bin_count) / (centers.upper[axis] - centers.lower[axis]);
            if (!(scale[axis] < infinity<float>)) scale[axis] = 0;
        }
        visit_items(range, [&](const Item& item) {
            for (int axis = 0; axis < 3; ++axis) {
                const int k = bin_of(item.center(axis), centers.lower[axis], scale[axis]);
                Bin& bin = bins[std::size_t(axis)][std::size_t(k)];
                bin.bounds.extend(item.bounds);
                bin.census.add(item.item_class);
            }
        });
        Plane best;
        for (int axis = 0; axis < 3; ++axis)
            if (scale[axis] > 0)
                consider_planes(bins[std::size_t(axis)], {infinity<float>, axis, 0, centers.lower[axis], scale[axis]},
                                best);
        if (best.axis < 0) return range.begin;
        return partition(range, [&](const Item& item) {
            return bin_of(item.center(best.axis), best.lower, best.scale) <= best.bin;
        });
    }

    const Bvh::Leaves& leaves_;
    LargeArray<BvhNode>& nodes_;
    Lookout& lookout_;
    std::vector<Item> items_;
    std::array<int, most_classes> capacity_{};
};

}  // namespace

Bvh::Bvh(std::span<const Box> boxes, const Leaves& leaves, Lookout& lookout) {
    if (boxes.empty()) return;
    Builder(boxes, leaves, nodes_, lookout).build();
    nodes_.shrink_to_fit();
}

float Bvh::cost() const {
    double area = 0;
    for (const BvhNode& node : nodes_)
        for (std::size_t k = 0; k < pack_width; ++k) {
            const Vec3d size{double(node.plane[3][k]) - node.plane[0][k], double(node.plane[4][k]) - node.plane[1][k],
                             double(node.plane[5][k]) - node.plane[2][k]};
            if (size.x >= 0) area += size.x * size.y + size.y * size.z + size.z * size.x;
        }
    return float(area);
}

// Nodes are opened, nearest to the root first, until their children no longer fit.
void Bvh::find_frontier(const SlabBundle& bundle, Frontier& frontier) const {
    constexpr int most = Frontier::capacity * pack_width;
    struct Part {
        const BvhNode* node;
        int slot;
    };
    Part parts[most];
    int count = 0, next = 0;
    const auto open = [&](const BvhNode& node) {
        const auto plane = [&node](std::uint32_t i) { return Pack<float>::load(node.plane[i]); };
        const BoxInterval<Pack<float>> inside = slab_interval(bundle, plane);
        std::uint32_t crossed = bits(inside.near <= inside.far);
        if (count + std::popcount(crossed) > most) return false;
        while (crossed != 0) parts[count++] = {&node, bvh::take_lowest(crossed)};
        return true;
    };
    frontier.count = 0;
    if (nodes_.empty() || !open(nodes_[0])) return;
    while (next < count) {
        const std::uint32_t child = parts[next].node->child[parts[next].slot];
        const Part last = parts[count - 1];
        if (child & leaf_bit) {
            ++next;
            continue;
        }
        const Part opened = parts[next];
        parts[next] = last;  // its place is taken by the last one
        --count;
        if (open(nodes_[child])) continue;
        parts[count++] = parts[next];
        parts[next++] = opened;
    }
    for (int i = 0; i < count; ++i) {
        if (i % pack_width == 0) frontier.nodes[frontier.count++] = Builder::empty_node(no_parent);
        BvhNode& node = frontier.nodes[frontier.count - 1];
        const auto k = std::size_t(i % pack_width), slot = std::size_t(parts[i].slot);
        for (std::size_t plane = 0; plane < 6; ++plane) node.plane[plane][k] = parts[i].node->plane[plane][slot];
        node.child[k] = parts[i].node->child[slot];
    }
}

void Bvh::refit(std::uint32_t slot, const Box& leaf_box) {
    Box box = leaf_box;
    while (slot != no_parent) {
        BvhNode& node = nodes_[slot / pack_width];
        Builder::set_child(node, slot % pack_width, box);
        box = {};
        for (std::size_t k = 0; k < pack_width; ++k)
            box.extend(Box{{node.plane[0][k], node.plane[1][k], node.plane[2][k]},
                           {node.plane[3][k], node.plane[4][k], node.plane[5][k]}});
        slot = node.parent;
    }
}

}  // namespace raybound
