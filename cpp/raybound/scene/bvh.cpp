#include "raybound/scene/bvh.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace raybound {

namespace {

constexpr int bin_count = 16;
constexpr int deepest_sah_level = 40;  // below it the median splits: so the depth stays under 40 + 32 levels of two

struct Range {
    std::uint32_t begin, end;
    Box bounds;
    int depth;
    std::uint32_t size() const { return end - begin; }
};

class Builder {
  public:
    Builder(std::span<const Box> boxes, std::vector<BvhNode>& nodes)
        : boxes_(boxes), nodes_(nodes), order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        for (const Box& box : boxes) centers_.push_back(box.center());
    }

    void build() {
        Range all{0, std::uint32_t(order_.size()), {}, 0};
        all.bounds = bounds_of(all.begin, all.end);
        build_node(all);
    }

  private:
    Box bounds_of(std::uint32_t begin, std::uint32_t end) const {
        Box box;
        for (std::uint32_t i = begin; i < end; ++i) box.extend(boxes_[order_[i]]);
        return box;
    }

    // A node of four: split the range, then the largest part, until there are four parts or none can be split.
    std::uint32_t build_node(const Range& range) {
        std::vector<Range> parts{range};
        while (parts.size() < 4) {
            auto widest = parts.end();
            for (auto it = parts.begin(); it != parts.end(); ++it)
                if (it->size() > 1 && (widest == parts.end() || it->bounds.half_area() > widest->bounds.half_area()))
                    widest = it;
            if (widest == parts.end()) break;
            const auto [left, right] = split(*widest);
            *widest = left;
            parts.push_back(right);
        }
        const auto index = std::uint32_t(nodes_.size());
        nodes_.push_back(empty_node());
        for (std::size_t k = 0; k < parts.size(); ++k) {
            const std::uint32_t child =
                parts[k].size() == 1 ? order_[parts[k].begin] | Bvh::primitive_bit : build_node(parts[k]);
            set_child(nodes_[index], k, parts[k].bounds, child);
        }
        return index;
    }

    static BvhNode empty_node() {
        BvhNode node;
        for (std::size_t k = 0; k < 4; ++k) set_child(node, k, Box{}, Bvh::primitive_bit);
        return node;
    }

    static void set_child(BvhNode& node, std::size_t k, const Box& box, std::uint32_t child) {
        for (int axis = 0; axis < 3; ++axis) {
            node.lower[axis][k] = box.lower[axis];
            node.upper[axis][k] = box.upper[axis];
        }
        node.child[k] = child;
    }

    std::pair<Range, Range> split(const Range& range) {
        std::uint32_t middle = range.depth < deepest_sah_level ? partition_by_area(range) : range.begin;
        if (middle == range.begin || middle == range.end) middle = partition_at_median(range);
        return {{range.begin, middle, bounds_of(range.begin, middle), range.depth + 1},
                {middle, range.end, bounds_of(middle, range.end), range.depth + 1}};
    }

    std::uint32_t partition_at_median(const Range& range) {
        const std::uint32_t middle = range.begin + range.size() / 2;
        const Vec3f e = range.bounds.extent();
        const int axis = e.x > e.y ? (e.x > e.z ? 0 : 2) : (e.y > e.z ? 1 : 2);
        std::nth_element(
            order_.begin() + range.begin, order_.begin() + middle, order_.begin() + range.end,
            [&](auto a, auto b) { return std::pair(centers_[a][axis], a) < std::pair(centers_[b][axis], b); });
        return middle;
    }

    struct Bin {
        Box bounds;
        int count = 0;
    };

    int bin_of(std::uint32_t primitive, int axis, const Box& centers) const {
        const float extent = centers.upper[axis] - centers.lower[axis];
        const float x = (centers_[primitive][axis] - centers.lower[axis]) / extent * float(bin_count);
        return std::clamp(static_cast<int>(x), 0, bin_count - 1);
    }

    // The cheapest of the 3 x 15 planes between bins by the surface area heuristic; range.begin if there is none.
    std::uint32_t partition_by_area(const Range& range) {
        Box centers;
        for (std::uint32_t i = range.begin; i < range.end; ++i) centers.extend(centers_[order_[i]]);
        float best = infinity<float>;
        int best_axis = -1, best_bin = 0;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(centers.upper[axis] > centers.lower[axis])) continue;
            std::array<Bin, bin_count> bins;
            for (std::uint32_t i = range.begin; i < range.end; ++i) {
                Bin& bin = bins[std::size_t(bin_of(order_[i], axis, centers))];
                bin.bounds.extend(boxes_[order_[i]]);
                ++bin.count;
            }
            std::array<float, bin_count> from_right{};
            Bin right;
            for (std::size_t k = bin_count - 1; k > 0; --k) {
                right.bounds.extend(bins[k].bounds);
                right.count += bins[k].count;
                from_right[k] = right.count ? float(right.count) * right.bounds.half_area() : infinity<float>;
            }
            Bin left;
            for (std::size_t k = 0; k + 1 < bin_count; ++k) {
                left.bounds.extend(bins[k].bounds);
                left.count += bins[k].count;
                if (left.count == 0) continue;
                const float cost = float(left.count) * left.bounds.half_area() + from_right[k + 1];
                if (cost < best) best = cost, best_axis = axis, best_bin = int(k);
            }
        }
        if (best_axis < 0) return range.begin;
        const auto middle = std::partition(order_.begin() + range.begin, order_.begin() + range.end,
                                           [&](auto p) { return bin_of(p, best_axis, centers) <= best_bin; });
        return std::uint32_t(middle - order_.begin());
    }

    std::span<const Box> boxes_;
    std::vector<BvhNode>& nodes_;
    std::vector<std::uint32_t> order_;
    std::vector<Vec3f> centers_;
};

}  // namespace

Bvh::Bvh(std::span<const Box> boxes) {
    if (boxes.empty()) return;
    nodes_.reserve(boxes.size() / 2 + 1);
    Builder(boxes, nodes_).build();
}

}  // namespace raybound
