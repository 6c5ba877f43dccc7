#include "raybound/scene/texture.h"

#include <stdexcept>

#include "raybound/geometry/lanes.h"
#include "raybound/shapes/shape.h"

namespace raybound {

namespace {

// So that no integer can overflow.
template <class T>
T safe(T x) {
    return select(abs(x) < T(0x1p40), x, T(0));
}

// The coordinate brought into [0, 1] before it is turned into texels.
template <class T>
T wrapped(T x, Wrap wrap) {
    using std::floor;
    switch (wrap) {
        case Wrap::chart:
        case Wrap::repeat:
            return x - floor(x);
        case Wrap::clamp:
            return minimum(maximum(x, T(0)), T(1));
        default: {
            const T half = x * T(0.5), phase = (half - floor(half)) * T(2);
            return select(phase > T(1), T(2) - phase, phase);
        }
    }
}

// Among texels, whose middles lie at whole numbers.
template <class T>
T position(T x, int size, Wrap wrap) {
    return wrapped(x, wrap) * T(size) - T(0.5);
}

// The same in both types of coordinates that are looked up.
template <class Wanted>
bool always(float x, int size, const Wanted& wanted) {
    return wanted(double(position(x, size, Wrap::chart))) && wanted(position(double(x), size, Wrap::chart));
}

// The middle of the first texel of a repeated texture that begins at `end`, and that of the last of one that stops
// there: rounded so that their neighbours beyond the end have no weight. Beyond 2^20 a float has no room for that.
constexpr float most_repeats = 0x1p20f;
float first_middle(float end, int size) {
    float x = end + 0.5f / float(size);
    while (std::abs(end) < most_repeats && !always(x, size, [](double p) { return p >= 0; })) x = next_float_up(x);
    return x;
}
float last_middle(float end, int size) {
    float x = minimum(end - 0.5f / float(size), next_float_down(end));
    while (std::abs(end) < most_repeats && !always(x, size, [=](double p) { return p <= size - 1; }))
        x = next_float_down(x);
    return x;
}

template <class T, class Tap>
Tap tap(T x, int size, Wrap wrap) {
    const T position = raybound::position(x, size, wrap);
    using std::floor;
    const T base = floor(position);
    using I = Index<T>;
    const I i(base), end(size);
    const auto inside = [&](const I& k) {
        if (wrap == Wrap::repeat || wrap == Wrap::chart)
            return select(k < I(0), I(k + end), select(k >= end, I(k - end), k));
        return select(k < I(0), I(0), select(k >= end, I(end - 1), k));
    };
    return {inside(i), inside(i + 1), position - base};
}

}  // namespace

Texture::Texture(std::span<const Vec3f> texels, int width, int height, UV<float> scale, Wrap wrap_u, Wrap wrap_v)
    : texels_(texels.begin(), texels.end()),
      width_(width),
      height_(height),
      scale_(scale),
      wrap_u_(wrap_u),
      wrap_v_(wrap_v) {
    if (width < 1 || height < 1)
        throw std::invalid_argument("Texture: image must have at least one texel, got " + std::to_string(width) + "x" +
                                    std::to_string(height));
    for (const float s : {scale.u, scale.v})
        if (!(std::abs(s) <= 0x1p30f) || s == 0)
            throw std::invalid_argument("Texture: scale must be finite and not zero, got " + format(s));
    for (const Vec3f& c : texels_)
        if (!(c.x >= 0 && c.y >= 0 && c.z >= 0 && is_finite(c)))
            throw std::invalid_argument("Texture: texels must be finite and >= 0, got " + format(c));
    first_v_ = first_middle(minimum(scale.v, 0.0f), height);
    last_v_ = last_middle(maximum(scale.v, 0.0f), height);
    if (first_v_ > last_v_) first_v_ = last_v_ = scale.v * 0.5f;  // less than a texel from end to end
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
    return tap<T, Tap<T>>(safe(uv.u * T(scale_.u)), width_, wrap_u_);
}
template <class T>
Texture::Tap<T> Texture::tap_v(const UV<T>& uv, bool around) const {
    const T x = safe(uv.v * T(scale_.v));
    const bool ends = around && wrap_v_ == Wrap::chart;
    return tap<T, Tap<T>>(ends ? minimum(maximum(x, T(first_v_)), T(last_v_)) : x, height_, wrap_v_);
}

// (A tap's two texels in a row are mostly in one line of the cache.)
void Texture::prefetch(const UV<Pack<float>>& uv, bool around) const {
    const auto u = tap_u(uv).first;
    const auto v = tap_v(uv, around);
    for (int lane = 0; lane < pack_width; ++lane)
        for (const int row : {v.first[lane], v.second[lane]}) __builtin_prefetch(&texel(u[lane], row));
}

template <class T>
Vec3<T> Texture::lookup(const UV<T>& uv, bool around) const {
    const Tap<T> u = tap_u(uv), v = tap_v(uv, around);
    const T u1 = u.weight, u0 = T(1) - u1, v1 = v.weight, v0 = T(1) - v1;
    const Vec3<T> below = texels<T>(u.first, v.first) * u0 + texels<T>(u.second, v.first) * u1;
    const Vec3<T> above = texels<T>(u.first, v.second) * u0 + texels<T>(u.second, v.second) * u1;
    return below * v0 + above * v1;
}

template Vec3<float> Texture::lookup(const UV<float>&, bool) const;
template Vec3<double> Texture::lookup(const UV<double>&, bool) const;
template Vec3<Pack<float>> Texture::lookup(const UV<Pack<float>>&, bool) const;

}  // namespace raybound
