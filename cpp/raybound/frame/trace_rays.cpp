// Any rays, by the base tracer: what they see, and the trees of rays that it takes.
#include <cstring>

#include "raybound/frame/answers.h"
#include "raybound/frame/render.h"

namespace raybound {

namespace {

void make_unit_vectors(const std::string& who, std::vector<Vec3f>& directions) {
    require_directions<float>(who, std::span<const Vec3f>(directions));
    for (Vec3f& direction : directions) make_unit(direction);
}

// Calls trace(i, tracer) for every ray, on several threads.
template <class Trace>
RenderStatistics trace_all(const Snapshot& scene, std::size_t count, const RenderSettings& settings, const Watch& watch,
                           const Trace& trace) {
    constexpr std::size_t chunk = 256;
    std::atomic<bool> cancelled = false;
    const int threads = thread_count(settings.threads);
    std::vector<Tracer<float>> tracers(std::size_t(threads),
                                       Tracer<float>(scene, {settings.max_depth, settings.acceleration, &cancelled}));
    const auto work = [&](int item, int worker) {
        const std::size_t begin = std::size_t(item) * chunk;
        for (std::size_t i = begin; i < std::min(count, begin + chunk) && !cancelled; ++i)
            trace(i, tracers[std::size_t(worker)]);
    };
    RenderStatistics statistics;
    statistics.threads = run_work(int((count + chunk - 1) / chunk), threads, cancelled, work, watch);
    for (const Tracer<float>& tracer : tracers) statistics.rays += tracer.counts();
    return statistics;
}

void store(const Vec3d& v, float (&out)[3]) {
    for (int i = 0; i < 3; ++i) out[i] = float(v[i]);
}

// A tree's segments, each before those that come from it. One that meets nothing has its direction for a point.
void add_segments(const RayTreeNode& node, std::int32_t ray, std::int32_t parent, std::int32_t depth,
                  std::vector<PathRecord>& to) {
    PathRecord record;
    std::memset(static_cast<void*>(&record), 0, sizeof record);
    record.ray = ray;
    record.parent = parent;
    record.kind = std::uint8_t(node.kind);
    record.depth = depth;
    store(node.origin, record.origin);
    store(node.hit ? node.point : node.direction, record.point);
    record.t = node.hit ? float(node.t) : infinity<float>;
    record.object_id = node.hit ? node.object : -1;
    record.face_id = node.hit ? node.face : -1;
    store(node.weight, record.weight);
    const auto here = std::int32_t(to.size());
    to.push_back(record);
    for (const RayTreeNode& child : node.children) add_segments(child, ray, here, depth + 1, to);
}

}  // namespace

TracedRays trace_rays(const Snapshot& scene, const RayOrigins& origins, std::vector<Vec3f> directions,
                      const RenderSettings& settings, const Watch& watch) {
    make_unit_vectors("Renderer.trace", directions);
    TracedRays result{std::vector<Vec3f>(origins.size(), Vec3f(scene.background())),
                      std::vector<std::int32_t>(origins.size(), -1),
                      std::vector<float>(origins.size(), infinity<float>),
                      {}};
    result.statistics = trace_all(scene, origins.size(), settings, watch, [&](std::size_t i, Tracer<float>& tracer) {
        const RayStart start = origins.along(i, directions[i]);
        if (!start.begins) return;
        const EyeSample<float> sample = tracer.sample(start.origin, directions[i], start.from);
        result.radiance[i] = sample.radiance;
        result.object_id[i] = sample.object;
        result.t[i] = sample.t;
    });
    return result;
}

std::vector<PathRecord> trace_paths(const Snapshot& scene, const RayOrigins& origins, std::vector<Vec3f> directions,
                                    const RenderSettings& settings, const Watch& watch) {
    make_unit_vectors("Renderer.paths", directions);
    std::vector<std::vector<PathRecord>> trees(origins.size());
    trace_all(scene, origins.size(), settings, watch, [&](std::size_t i, Tracer<float>& tracer) {
        const RayStart start = origins.along(i, directions[i]);
        if (!start.begins) return;
        add_segments(tracer.ray_tree(start.origin, directions[i], start.from), std::int32_t(i), -1, 1, trees[i]);
    });
    std::vector<PathRecord> all;
    for (const std::vector<PathRecord>& tree : trees) {
        const auto first = std::int32_t(all.size());
        for (PathRecord record : tree) {
            if (record.parent >= 0) record.parent += first;
            all.push_back(record);
        }
    }
    return all;
}

}  // namespace raybound
