#include "raybound/frame/render.h"
#include "raybound/frame/stopwatch.h"
#include "raybound/frame/tiling.h"
#include "raybound/geometry/lanes.h"
#include "raybound/shapes/lanes.h"

namespace raybound {

namespace {

constexpr int block_size = 8;
static_assert(block_size * block_size == batch_size && tile_size % block_size == 0);

// What was searched for, as pixels tell it.
Reason reason_of(Searched searched) {
    switch (searched) {
        case Searched::no:
            return Reason::none;
        case Searched::eye:
            return Reason::silhouette;
        case Searched::shadow:
            return Reason::shadow;
        case Searched::reflection:
            return Reason::reflection;
        case Searched::refraction:
            return Reason::refraction;
        case Searched::cost:
            return Reason::cost;
        case Searched::unsupported:
            return Reason::unsupported;
    }
    return Reason::none;
}

Path path_of(Searched searched, std::int32_t object) {
    if (object < 0) return Path::background;
    if (searched == Searched::no) return Path::exact;
    return searched == Searched::eye ? Path::traced : Path::partial;
}

// What a worker needs for one block, apart from its tracer.
struct BlockRays {
    RayBatch rays;
    BatchRadiance seen;
    std::array<std::size_t, batch_size> pixel;
};

// Four by two pixels to a pack: neighbours in both directions.
constexpr int pack_columns = 4, pack_rows = 2;
static_assert(pack_columns * pack_rows == pack_width);

void add_pack(const Camera& camera, const Departure& eye, const FrameBuffers& buffers, const Tile& block, int x, int y,
              BlockRays& to) {
    float column[pack_width], row[pack_width];
    std::size_t at[pack_width];
    std::uint32_t wanted = 0;
    for (int lane = 0; lane < pack_width; ++lane) {
        const int i = x + lane % pack_columns, j = y + lane / pack_columns;
        column[lane] = float(i);
        row[lane] = float(j);
        at[lane] = buffers.index(i, j);
        if (i < block.x1 && j < block.y1 && buffers.error_bound[at[lane]] != 0) wanted |= 1u << lane;
    }
    const Vec3<FloatPack> directions = flushed(camera.direction_through(FloatPack::load(column), FloatPack::load(row)));
    if (wanted == 0xffu && to.rays.count % pack_width == 0) {
        std::ranges::copy(at, to.pixel.begin() + to.rays.count);
        return to.rays.add_pack(Vec3<FloatPack>(camera.eye()), directions, eye);
    }
    for_each_lane(wanted, [&](int lane) {
        to.pixel[std::size_t(to.rays.count)] = at[lane];
        to.rays.add(camera.eye(), lane_of(directions, lane), 0, eye);
    });
}

// Blocks of a tile four by four, each four of them together: their rays begin in the same cells.
constexpr int blocks_of_tile = (tile_size / block_size) * (tile_size / block_size);
static_assert(blocks_of_tile == 16);
Tile block_of(const Tile& tile, int k) {
    const int column = (k & 1) | (k >> 1 & 2), row = (k >> 1 & 1) | (k >> 2 & 2);
    const int x = tile.x0 + column * block_size, y = tile.y0 + row * block_size;
    return {x, y, std::min(x + block_size, tile.x1), std::min(y + block_size, tile.y1)};
}

// Blocks row by row over the whole picture.
int blocks_across(int pixels) { return (pixels + block_size - 1) / block_size; }
int number_of(const Camera& camera, const Tile& block) {
    return block.y0 / block_size * blocks_across(camera.width()) + block.x0 / block_size;
}

void render_block(ExactTracer& tracer, const Camera& camera, const Departure& eye, FrameBuffers& buffers,
                  ImageBlocks& blocks, const Tile& block, const std::atomic<bool>& cancelled, BlockRays& work) {
    RayBatch& rays = work.rays;
    rays.count = 0;
    for (int y = block.y0; y < block.y1; y += pack_rows)
        for (int x = block.x0; x < block.x1; x += pack_columns) add_pack(camera, eye, buffers, block, x, y, work);
    if (rays.count == 0) return;
    rays.pad();
    const BatchRadiance& seen = work.seen;
    const bool whole = rays.count == (block.x1 - block.x0) * (block.y1 - block.y0);
    const int number = number_of(camera, block);
    tracer.trace_eye(rays, whole ? blocks.kept(number) : ImageBlocks::Kept{}, work.seen);
    if (cancelled) return;
    if (whole) blocks.keep(number, tracer.written());
    for (int k = 0; k < rays.count; ++k) {
        const std::size_t at = work.pixel[std::size_t(k)];
        buffers.image[at] = seen.radiance[k];
        buffers.path[at] = std::uint8_t(path_of(seen.searched[k], seen.object[k]));
        buffers.reason[at] = std::uint8_t(reason_of(seen.searched[k]));
        buffers.object_id[at] = seen.object[k];
        buffers.depth[at] = seen.t[k];
        buffers.error_bound[at] = 0;
    }
}

}  // namespace

RenderStatistics render_exactly(const Snapshot& scene, const Camera& camera, FrameBuffers& buffers, Cells& cells,
                                const RenderSettings& settings, const Watch& watch) {
    std::atomic<bool> cancelled = false;
    const ExactSettings exact{settings.max_depth, camera.pixel_angle(), {}, &cancelled};
    std::vector<ExactTracer> tracers;
    const int threads = thread_count(settings.threads);
    for (int k = 0; k < threads; ++k) tracers.emplace_back(scene, cells, exact);
    std::vector<BlockRays> work(static_cast<std::size_t>(threads));
    const Tiling tiling(buffers, 1);
    const Departure eye = departure_at(scene, camera.eye());
    cells.blocks().begin_view(camera.numbers(), blocks_across(camera.width()) * blocks_across(camera.height()));
    const Stopwatch time;
    RenderStatistics statistics;
    statistics.threads = run_work(
        tiling.count(), threads, cancelled,
        [&](int item, int worker) {
            const Tile tile = tiling.tile(item);
            tracers[std::size_t(worker)].begin_tile();
            for (int k = 0; k < blocks_of_tile; ++k) {
                const Tile block = block_of(tile, k);
                if (block.x0 >= tile.x1 || block.y0 >= tile.y1) continue;
                render_block(tracers[std::size_t(worker)], camera, eye, buffers, cells.blocks(), block, cancelled,
                             work[std::size_t(worker)]);
                if (cancelled) return;
            }
        },
        watch);
    statistics.seconds = time.seconds();
    for (const ExactTracer& tracer : tracers) {
        statistics.rays += tracer.counts().rays;
        statistics.tests += tracer.counts().tests;
        statistics.cells += tracer.counts().cells;
    }
    return statistics;
}

}  // namespace raybound
