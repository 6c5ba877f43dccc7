// Textures: linear RGB texels, looked up bilinearly.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "raybound/geometry/large_array.h"
#include "raybound/shapes/surface.h"

namespace raybound {

// What lies outside of [0, 1]. `chart`: it repeats, but not across an end of the face's chart.
enum class Wrap : std::uint8_t { chart, repeat, clamp, mirror };

class Texture {
  public:
    // Texels row by row, the row at v = 0 (the bottom) first. Throws std::invalid_argument for empty or negative or
    // non-finite texels and scales of zero.
    Texture(std::span<const Vec3f> texels, int width, int height, UV<float> scale, Wrap wrap_u, Wrap wrap_v);

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t bytes() const { return texels_.size() * sizeof(Vec3f); }

    // The colour at (u,v), scaled first. Texel centres lie at (i + 1/2) / size. `around`: the face's chart goes around
    // (goes_around), its ends are at v = 0 and v = 1.
    template <class T>
    Vec3<T> lookup(const UV<T>& uv, bool around) const;

    // Begins to fetch from memory what a lookup will need.
    void prefetch(const UV<Pack<float>>& uv, bool around) const;

  private:
    const Vec3f& texel(int x, int y) const { return texels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]; }
    // The two texels around a coordinate and the weight of the second.
    template <class T>
    struct Tap {
        Index<T> first, second;
        T weight;
    };
    template <class T>
    Tap<T> tap_u(const UV<T>& uv) const;
    template <class T>
    Tap<T> tap_v(const UV<T>& uv, bool around) const;
    template <class T>
    Vec3<T> texels(const Index<T>& x, const Index<T>& y) const;

    LargeArray<Vec3f> texels_;
    int width_, height_;
    UV<float> scale_;
    Wrap wrap_u_, wrap_v_;
    float first_v_, last_v_;  // of a chart that goes around, scaled: the middles of the texels at its ends
};

using TexturePointer = std::shared_ptr<const Texture>;

}  // namespace raybound
