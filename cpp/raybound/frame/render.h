// Rendering with the base tracer, by tiles, on several threads.
#pragma once

#include "raybound/certify/exact_tracer.h"
#include "raybound/frame/buffers.h"
#include "raybound/frame/camera.h"
#include "raybound/frame/hit_record.h"
#include "raybound/frame/work_queue.h"
#include "raybound/trace/tracer.h"

namespace raybound {

enum class Precision { float32, float64 };

struct RenderSettings {
    int max_depth = 5;
    int threads = 0;
    int stride = 1;
    Precision precision = Precision::float32;
    Acceleration acceleration = Acceleration::bvh;
};

struct RenderStatistics {
    RayCounts rays;
    std::uint64_t tests = 0;  // of candidates, instead of searches
    CellCounts cells;
    double seconds = 0;
    int threads = 0;
};

// Traces the pixels whose coordinates are multiples of the stride and whose bound is not yet 0. With a stride above 1
// the others of each block take its corner's colour, marked as extrapolated. With double precision the same float rays
// are traced by the double kernels, for comparison.
RenderStatistics render(const Snapshot& scene, const Camera& camera, FrameBuffers& buffers,
                        const RenderSettings& settings, const Watch& watch);

// The same bytes from certified lists (certify/exact_tracer.h), which `cells` keeps for other frames of the scene: it
// must have begun this frame. No stride, and float32.
RenderStatistics render_exactly(const Snapshot& scene, const Camera& camera, FrameBuffers& buffers, Cells& cells,
                                const RenderSettings& settings, const Watch& watch);

// Any rays, by the same tracer. Directions are made unit vectors in float first (throws std::invalid_argument for
// zero).
struct TracedRays {
    std::vector<Vec3f> radiance;
    std::vector<std::int32_t> object_id;
    std::vector<float> t;
    RenderStatistics statistics;
};
TracedRays trace_rays(const Snapshot& scene, const RayOrigins& origins, std::vector<Vec3f> directions,
                      const RenderSettings& settings, const Watch& watch);

// The ray trees of any rays, one segment after the other: each tree in order of depth first, reflected rays before
// refracted ones.
struct PathRecord {
    std::int32_t ray, parent;  // the number of the ray, and of the segment that it comes from, or -1
    std::uint8_t kind;         // RayKind
    std::int32_t depth;        // 1 for the first segment
    float origin[3], point[3], t;
    std::int32_t object_id, face_id;
    float weight[3];  // of what it sees in the first one's radiance
};
std::vector<PathRecord> trace_paths(const Snapshot& scene, const RayOrigins& origins, std::vector<Vec3f> directions,
                                    const RenderSettings& settings, const Watch& watch);

}  // namespace raybound
