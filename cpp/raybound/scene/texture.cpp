#include "raybound/scene/texture.h"

#include <stdexcept>

#include "raybound/geometry/lanes.h"
#include "raybound/shapes/shape.h"

namespace raybound {

namespace {

// The coordinate brought into [0, 1] before it is turned into texels, so that no integer can overflow.
template <class T>
T wrapped(T x, Wrap wrap) {
    using std::floor;
    const T safe = select(abs(x) < T(0x1p40), x, T(0));
    switch (wrap) {
        case Wrap::repeat:
            return safe - floor(safe);
        case Wrap::clamp:
            return minimum(maximum(safe, T(0)), T(1));
        default: {
            const T half = safe * T(0.5), phase = (half - floor(half)) * T(2);
            return select(phase > T(1), T(2) - phase, phase);
        }
    }
}

template <class T, class Tap>
Tap tap(T x, int size, Wrap wrap) {
    const T position = wrapped(x, wrap) * T(size) - T(0.5);
    using std::floor;
    const T base = floor(position);
    using I = Index<T>;
    const I i(base), end(size);
    const auto inside = [&](const I& k) {
        if (wrap == Wrap::repeat) return select(k < I(0), I(k + end), select(k >= end, I(k - end), k));
        return select(k < I(0), I(0), select(k >= end, I(end - 1), k));
    };
    return {inside(i), inside(i + 1), position - base};
}

}  // namespace

Texture::Texture(std::span<const Vec3f> texels, int width, int height, float scale_u, float scale_v, Wrap wrap)
    : texels_(texels.begin(), texels.end()),
      width_(width),
      height_(height),
      scale_u_(scale_u),
      scale_v_(scale_v),
      wrap_(wrap) {
    if (width < 1 || height < 1)
        throw std::invalid_argument("Texture: image must have at least one texel, got " + std::to_string(width) + "x" +
                                    std::to_string(height));
    for (const float s : {scale_u, scale_v})
        if (!(std::abs(s) <= 0x1p30f) || s == 0)
            throw std::invalid_argument("Texture: scale must be finite and not zero, got " + format(s));
    for (const Vec3f& c : texels_)
        if (!(c.x >= 0 && c.y >= 0 && c.z >= 0 && is_finite(c)))
            throw std::invalid_argument("Texture: texels must be finite and >= 0, got " + format(c));
}

template <class T>
Vec3<T> Texture::texels(const Index<T>& x, const Index<T>& y) const {
    if constexpr (std::is_same_v<T, Scalar<T>>) {
        return Vec3<T>(texel(x, y));
    } else {
        return side_by_side<Scalar<T>>([&](int lane) { return texel(x[lane], y[lane]); });
    }
}

template <class T>
Texture::Tap<T> Texture::tap_u(const UV<T>& uv) const {
    return tap<T, Tap<T>>(uv.u * T(scale_u_), width_, wrap_);
}
template <class T>
Texture::Tap<T> Texture::tap_v(const UV<T>& uv) const {
    return tap<T, Tap<T>>(uv.v * T(scale_v_), height_, wrap_);
}

// (A tap's two texels in a row are mostly in one line of the cache.)
void Texture::prefetch(const UV<Pack<float>>& uv) const {
    const auto u = tap_u(uv).first;
    const auto v = tap_v(uv);
    for (int lane = 0; lane < pack_width; ++lane)
        for (const int row : {v.first[lane], v.second[lane]}) __builtin_prefetch(&texel(u[lane], row));
}

template <class T>
Vec3<T> Texture::lookup(const UV<T>& uv) const {
    const Tap<T> u = tap_u(uv), v = tap_v(uv);
    const T u1 = u.weight, u0 = T(1) - u1, v1 = v.weight, v0 = T(1) - v1;
    const Vec3<T> below = texels<T>(u.first, v.first) * u0 + texels<T>(u.second, v.first) * u1;
    const Vec3<T> above = texels<T>(u.first, v.second) * u0 + texels<T>(u.second, v.second) * u1;
    return below * v0 + above * v1;
}

template Vec3<float> Texture::lookup(const UV<float>&) const;
template Vec3<double> Texture::lookup(const UV<double>&) const;
template Vec3<Pack<float>> Texture::lookup(const UV<Pack<float>>&) const;

}  // namespace raybound
