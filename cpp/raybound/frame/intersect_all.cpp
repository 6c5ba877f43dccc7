// Every crossing along a ray, by what its whole line has inside of each solid.
#include <algorithm>
#include <tuple>

#include "raybound/frame/answers.h"
#include "raybound/frame/query.h"
#include "raybound/shapes/mesh_hit.h"

namespace raybound {

namespace {

struct RayCrossing {
    Crossing<double> crossing;
    std::uint32_t primitive;
    float t;
    int level = 1;  // the order of those at one t: solids are left, then entered; one after the other in each solid
};

// What a ray crosses, ahead of where it begins.
class Crossings {
  public:
    Crossings(const Snapshot& scene, const WideRay<float>& ray, const Departure& from)
        : scene_(scene), geometry_(scene.geometry()), ray_(ray), from_(from) {}

    std::vector<RayCrossing> find() {
        if (from_.within != Departure::none) add_solid(from_.within);
        float everywhere = infinity<float>;
        const auto visit = [&](std::uint32_t index, float, bool) {
            if (index == from_.within || index == from_.gone()) return false;
            if (is_closed(geometry_, geometry_.primitives[index]))
                add_solid(index);
            else
                add_open(index);
            return false;
        };
        scene_.accelerator().traverse(geometry_, ray_.narrow, everywhere, visit, nullptr);
        std::ranges::stable_sort(found_,
                                 [&](const RayCrossing& a, const RayCrossing& b) { return order(a) < order(b); });
        return std::move(found_);
    }

  private:
    std::tuple<float, int, Rank> order(const RayCrossing& c) const {
        return {c.t, c.level, rank(geometry_, c.primitive, c.crossing.face_offset + c.crossing.face)};
    }

    // (Those of one solid come one after the other.)
    void add(std::uint32_t primitive, const Crossing<double>& crossing) {
        const auto t = float(crossing.t);
        if (!(t < infinity<float>)) return;
        const bool again = !found_.empty() && found_.back().primitive == primitive && found_.back().t == t;
        const bool closed = is_closed(geometry_, geometry_.primitives[primitive]);
        const int level = again && closed ? found_.back().level + 1 : crossing.entering || !closed ? 1 : 0;
        found_.push_back({crossing, primitive, t, level});
    }

    // The next crossing as any search finds it, and the stretches of the line that lie beyond.
    void add_solid(std::uint32_t index) {
        const Primitive& primitive = geometry_.primitives[index];
        const bool inside = index == from_.within;
        const Crossing<double> next =
            inside ? crossing_from_inside(geometry_, primitive, ray_, from_)
                   : crossing_from_outside(geometry_, primitive, ray_, from_, index == from_.left);
        if (!next.hit) return;
        add(index, next);
        bool is_in = next.entering;
        for (const Stretch& stretch : stretches_of(geometry_, primitive, ray_.wide)) {
            if (is_in && stretch.out.t >= next.t && stretch.in.t <= next.t) add(index, stretch.out), is_in = false;
            if (stretch.in.t > next.t) {
                if (is_in) add(index, after(next)), is_in = false;
                add(index, stretch.in);
                add(index, stretch.out);
            }
        }
        if (is_in) add(index, after(next));
    }

    // The way out of a stretch so short that the line has none.
    static Crossing<double> after(Crossing<double> entry) {
        entry.entering = false;
        return entry;
    }

    void add_open(std::uint32_t index) {
        const Primitive& primitive = geometry_.primitives[index];
        if (geometry_.leaves[primitive.root].kind != LeafKind::mesh) {
            const Crossing<double> only = first_crossing(geometry_, primitive, ray_);
            if (only.hit) add(index, only);
            return;
        }
        for (const Crossing<double>& crossing : mesh_crossings_ahead(geometry_, primitive.root, ray_.wide))
            add(index, crossing);
    }

    const Snapshot& scene_;
    const Geometry& geometry_;
    const WideRay<float>& ray_;
    const Departure& from_;
    std::vector<RayCrossing> found_;
};

// Follows the ray through the solids that it is inside of.
std::vector<HitRecord> records_of(const Snapshot& scene, const std::vector<RayCrossing>& crossings,
                                  const WideRay<float>& ray, const Departure& from, float scale) {
    std::vector<HitRecord> records;
    std::vector<std::uint32_t> inside;
    if (from.within != Departure::none) inside.push_back(from.within);
    std::uint32_t just_left = Departure::none;
    float left_at = -1;
    for (const RayCrossing& c : crossings) {
        Nearest<float> nearest;
        nearest.crossing = c.crossing;
        nearest.t = c.t;
        nearest.primitive = c.primitive;
        nearest.hit = true;
        nearest.within = inside.empty() ? Departure::none : inside.back();
        const bool closed = is_closed(scene.geometry(), scene.geometry().primitives[c.primitive]);
        if (closed && c.crossing.entering) {
            nearest.touching = inside.empty() && just_left != Departure::none && left_at == c.t;
            if (nearest.touching) nearest.within = just_left;
            inside.push_back(c.primitive);
        } else if (closed) {
            std::erase(inside, c.primitive);
            just_left = c.primitive, left_at = c.t;
        }
        records.push_back(hit_record(scene, nearest, ray, scale));
    }
    return records;
}

}  // namespace

AllHits intersect_all(const Snapshot& scene, const RayOrigins& origins, std::span<const Vec3f> directions,
                      const Watch& watch) {
    require_directions<float>("Scene.intersect_all", directions);
    std::vector<std::vector<HitRecord>> found(origins.size());
    answer_all(origins.size(), watch, [&](std::size_t i) {
        float scale;
        const RayStart start = origins.along(i, directions[i]);
        const WideRay<float> ray(user_ray(start.origin, directions[i], scale));
        if (!start.begins) return;
        found[i] = records_of(scene, Crossings(scene, ray, start.from).find(), ray, start.from, scale);
    });
    AllHits all;
    all.offsets = append_all(found, all.records);
    return all;
}

}  // namespace raybound
