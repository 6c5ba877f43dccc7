// The base ray tracer: Whitted's, with Ward's shading (thesis 4.2.1, figure 4-5; 7.1). It defines the right answer.
#pragma once

#include <atomic>

#include "raybound/trace/ray_tree.h"
#include "raybound/trace/search.h"

namespace raybound {

// Searches of the scene by kind.
struct RayCounts {
    std::uint64_t eye = 0, shadow = 0, reflected = 0, refracted = 0;

    RayCounts& operator+=(const RayCounts& o) {
        eye += o.eye, shadow += o.shadow, reflected += o.reflected, refracted += o.refracted;
        return *this;
    }
};

struct TraceSettings {
    int max_depth = 5;
    Acceleration acceleration = Acceleration::bvh;
    const std::atomic<bool>* cancelled = nullptr;  // looked at for every ray: a cancelled trace returns at once
};

template <class T>
struct EyeSample {
    Vec3<T> radiance;
    T t;                  // along the ray; infinite for the background
    std::int32_t object;  // -1 for the background
};

// One for each thread (aligned, so that their counters share no cache line).
template <class T>
class alignas(64) Tracer {
  public:
    Tracer(const Snapshot& scene, const TraceSettings& settings)
        : scene_(scene), settings_(settings), last_blockers_(scene.lights().size(), Departure::none) {}

    // The radiance of an eye ray with a unit direction, where `eye` tells what its origin lies in; the search for what
    // it hits may begin at `from`.
    EyeSample<T> sample(const Vec3<T>& origin, const Vec3<T>& direction, const Departure& eye,
                        const Bvh::Frontier* from = nullptr);

    // The same with its ray tree.
    RayTreeNode ray_tree(const Vec3<T>& origin, const Vec3<T>& direction, const Departure& eye);

    const RayCounts& counts() const { return counts_; }

  private:
    struct Shadable;

    template <class Record>
    Vec3<T> radiance(const WideRay<T>& ray, const Departure& departed, int depth, Record record, EyeSample<T>* first,
                     const Bvh::Frontier* from = nullptr);
    template <class Record>
    Vec3<T> shade(const WideRay<T>& wide, const Nearest<T>& nearest, int depth, Record record, T* t);
    template <class Record>
    Vec3<T> direct_light(const Shadable& at, Record record);
    template <class Record>
    Vec3<T> add_secondary(const Vec3<T>& local, const Ray<T>& ray, const Shadable& at, int depth, Record record);
    bool is_lit(const Shadable& at, std::size_t light, std::int32_t* blocker);

    const Snapshot& scene_;
    TraceSettings settings_;
    RayCounts counts_;
    LargeArray<std::uint32_t> last_blockers_;  // by light; in cache lines of their own
};

}  // namespace raybound
