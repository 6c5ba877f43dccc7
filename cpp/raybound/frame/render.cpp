#include "raybound/frame/render.h"

#include <algorithm>
#include <array>

#include "raybound/frame/stopwatch.h"
#include "raybound/frame/tiling.h"
#include "raybound/frame/user_rays.h"

namespace raybound {

namespace {

// A pixel whose trace was cut short by a cancellation is not stored.
template <class T>
void trace_pixel(Tracer<T>& tracer, const Camera& camera, FrameBuffers& buffers, int x, int y, const Vec3f& direction,
                 const Departure& eye, const Bvh::Frontier* from, const std::atomic<bool>& cancelled) {
    const std::size_t at = buffers.index(x, y);
    if (buffers.error_bound[at] == 0) return;
    const EyeSample<T> sample = tracer.sample(Vec3<T>(camera.eye()), Vec3<T>(direction), eye, from);
    if (cancelled) return;
    buffers.image[at] = Vec3f(sample.radiance);
    buffers.path[at] = std::uint8_t(sample.object < 0 ? Path::background : Path::traced);
    buffers.object_id[at] = sample.object;
    buffers.depth[at] = float(sample.t);
    buffers.error_bound[at] = 0;
}

void copy_pixel(FrameBuffers& buffers, std::size_t from, std::size_t to) {
    if (buffers.error_bound[to] == 0) return;
    buffers.image[to] = buffers.image[from];
    buffers.path[to] = std::uint8_t(Path::extrapolated);
    buffers.object_id[to] = buffers.object_id[from];
    buffers.depth[to] = buffers.depth[from];
}

// The rays of a few pixels side by side, whose searches begin where the tree parts for them.
constexpr int block_size = 8;  // TUNED: 4 to 16 measure alike

template <class T>
void render_block(Tracer<T>& tracer, const Snapshot& scene, const Camera& camera, const Departure& eye,
                  FrameBuffers& buffers, const Tile& block, const std::atomic<bool>& cancelled) {
    std::array<Vec3f, block_size * block_size> directions;
    SlabBundle bundle(camera.eye());
    auto next = directions.begin();
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x) {
            *next = camera.direction<float>(x, y);
            bundle.add(SlabRay<float>(make_ray(camera.eye(), *next++)).reciprocal);
        }
    Bvh::Frontier frontier;
    scene.accelerator().bvh().find_frontier(bundle, frontier);
    next = directions.begin();
    for (int y = block.y0; y < block.y1; ++y)
        for (int x = block.x0; x < block.x1; ++x) {
            trace_pixel(tracer, camera, buffers, x, y, *next++, eye, &frontier, cancelled);
            if (cancelled) return;
        }
}

template <class T>
void render_blocks(Tracer<T>& tracer, const Snapshot& scene, const Camera& camera, const Departure& eye,
                   FrameBuffers& buffers, const Tile& tile, const std::atomic<bool>& cancelled) {
    for (int y = tile.y0; y < tile.y1; y += block_size)
        for (int x = tile.x0; x < tile.x1; x += block_size) {
            const Tile block{x, y, std::min(x + block_size, tile.x1), std::min(y + block_size, tile.y1)};
            render_block(tracer, scene, camera, eye, buffers, block, cancelled);
            if (cancelled) return;
        }
}

// One pixel of each block of stride x stride is traced, and copied to the others.
template <class T>
void render_strided(Tracer<T>& tracer, const Camera& camera, const Departure& eye, FrameBuffers& buffers,
                    const Tile& tile, int stride, const std::atomic<bool>& cancelled) {
    for (int y = tile.y0; y < tile.y1; y += stride)
        for (int x = tile.x0; x < tile.x1; x += stride) {
            trace_pixel(tracer, camera, buffers, x, y, camera.direction<float>(x, y), eye, nullptr, cancelled);
            if (cancelled) return;
            const std::size_t at = buffers.index(x, y);
            for (int j = y; j < std::min(y + stride, tile.y1); ++j)
                for (int i = x; i < std::min(x + stride, tile.x1); ++i) copy_pixel(buffers, at, buffers.index(i, j));
        }
}

template <class T>
std::vector<Tracer<T>> make_tracers(const Snapshot& scene, const RenderSettings& settings,
                                    const std::atomic<bool>& cancelled) {
    const TraceSettings trace{settings.max_depth, settings.acceleration, &cancelled};
    return std::vector<Tracer<T>>(std::size_t(thread_count(settings.threads)), Tracer<T>(scene, trace));
}

template <class T>
RayCounts total(const std::vector<Tracer<T>>& tracers) {
    RayCounts sum;
    for (const auto& tracer : tracers) sum += tracer.counts();
    return sum;
}

template <class T>
RenderStatistics render_with(const Snapshot& scene, const Camera& camera, FrameBuffers& buffers,
                             const RenderSettings& settings, const Watch& watch) {
    std::atomic<bool> cancelled = false;
    auto tracers = make_tracers<T>(scene, settings, cancelled);
    const Tiling tiling(buffers, settings.stride);
    const Departure eye = departure_at(scene, camera.eye());
    const Stopwatch watch_time;
    RenderStatistics statistics;
    statistics.threads = run_work(
        tiling.count(), int(tracers.size()), cancelled,
        [&](int item, int worker) {
            Tracer<T>& tracer = tracers[std::size_t(worker)];
            const Tile tile = tiling.tile(item);
            if (settings.stride == 1 && std::is_same_v<T, float>)
                render_blocks(tracer, scene, camera, eye, buffers, tile, cancelled);
            else
                render_strided(tracer, camera, eye, buffers, tile, settings.stride, cancelled);
        },
        watch);
    statistics.seconds = watch_time.seconds();
    statistics.rays = total(tracers);
    return statistics;
}

}  // namespace

RenderStatistics render(const Snapshot& scene, const Camera& camera, FrameBuffers& buffers,
                        const RenderSettings& settings, const Watch& watch) {
    if (settings.precision == Precision::float64) return render_with<double>(scene, camera, buffers, settings, watch);
    return render_with<float>(scene, camera, buffers, settings, watch);
}

}  // namespace raybound
