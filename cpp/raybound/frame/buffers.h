// The pixels of a frame.
#pragma once

#include <cstdint>
#include <memory>

#include "raybound/geometry/large_array.h"
#include "raybound/geometry/vector.h"

namespace raybound {

enum class Path : std::uint8_t { traced, partial, exact, interpolated, reprojected, extrapolated, background };
enum class Reason : std::uint8_t {
    none,
    silhouette,
    occluder,
    shadow,
    self_shadow,
    reflection,
    refraction,
    tir,
    error_bound,
    cost,
    unsupported
};

// A pixel that has not been computed has an infinite error bound.
struct FrameBuffers {
    FrameBuffers(int width_, int height_)
        : width(width_),
          height(height_),
          image(pixels()),
          error_bound(pixels(), infinity<float>),
          path(pixels(), std::uint8_t(Path::traced)),
          reason(pixels(), std::uint8_t(Reason::none)),
          object_id(pixels(), -1),
          depth(pixels(), infinity<float>) {}

    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
    std::size_t index(int x, int y) const { return std::size_t(y) * std::size_t(width) + std::size_t(x); }

    int width, height;
    LargeArray<Vec3f> image;
    LargeArray<float> error_bound;
    LargeArray<std::uint8_t> path, reason;
    LargeArray<std::int32_t> object_id;
    LargeArray<float> depth;
};

}  // namespace raybound
