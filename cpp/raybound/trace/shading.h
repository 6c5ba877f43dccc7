// The local shading model (thesis 4.3.2) and the directions of secondary rays: the formulas of light, written once.
#pragma once

#include "raybound/scene/material.h"

namespace raybound {

template <class T>
inline const T largest = T(std::numeric_limits<Scalar<T>>::max());

// Sums and products of radiance may exceed the range of T; the largest number stands for "beyond": no infinity, and so
// no NaN, enters a picture.
template <class T>
inline Vec3<T> saturate(const Vec3<T>& c) {
    return {minimum(c.x, largest<T>), minimum(c.y, largest<T>), minimum(c.z, largest<T>)};
}

// Ward's lobe exp(-tan^2(alpha) / sigma^2), alpha the angle between N and H = L + V (thesis eq. 4.2). The tangent is
// taken from the cross product: 1 - 1/(N.H)^2 is the same number, but cancels where the lobe is bright.
template <class T>
inline T ward_lobe(const Vec3<T>& n, const Vec3<T>& h, T sigma) {
    const Vec3<T> sine = cross(n, h);
    return exp(-(dot(sine, sine) / square(dot(n, h) * sigma)));
}

// exp(...) sqrt(N.L / N.V) / (4 sigma^2): the specular term without rho_s; 0 where rounding leaves N.V <= 0. The root
// is kept finite, so that a lobe that has vanished makes it 0.
template <class T>
inline T ward_specular(const Vec3<T>& n, const Vec3<T>& l, const Vec3<T>& v, T n_dot_l, T n_dot_v, T sigma) {
    const T lobe = ward_lobe(n, l + v, sigma);
    const T value = lobe * minimum(sqrt(n_dot_l / n_dot_v), largest<T>) / (T(4) * square(sigma));
    return select(n_dot_v > T(0), minimum(value, largest<T>), T(0));
}

// rho_d (N.L) + rho_s specular (thesis eq. 4.1 and 4.2; Ward's 1/pi is folded into the light).
template <class T>
inline Vec3<T> reflectance(const Vec3<T>& diffuse, const Material& material, const Vec3<T>& n, const Vec3<T>& l,
                           const Vec3<T>& v, T n_dot_l, T n_dot_v) {
    Vec3<T> value = diffuse * n_dot_l;
    if (material.specular == Vec3f{}) return value;
    return value + Vec3<T>(material.specular) * ward_specular(n, l, v, n_dot_l, n_dot_v, T(material.roughness));
}

// What arrives from a light at p, before anything is asked about shadows.
template <class T>
struct Incoming {
    Vec3<T> direction;   // L, a unit vector
    Vec3<T> irradiance;  // E: zero outside a spotlight's cone
};

// Is p within a spotlight's cone? In the wide type: in float the cosine of a narrow cone has no digits left.
template <class T>
inline Mask<T> inside_cone(const Light& light, const Vec3<T>& p) {
    using W = Wide<T>;
    const Vec3<W> way = Vec3<W>(p) - Vec3<W>(light.position);
    return Mask<T>(dot(way, Vec3<W>(light.direction)) >= W(light.cos_cutoff) * length(way));
}

// The way to a light: its direction, and the square of its length (1 for directional lights).
template <class T>
struct WayToLight {
    Vec3<T> direction;
    T squared;
};

template <class T>
inline WayToLight<T> way_to_light(const Light& light, const Vec3<T>& p) {
    if (light.kind == LightKind::directional) return {-Vec3<T>(light.direction), T(1)};
    const Vec3<T> to_light = Vec3<T>(light.position) - p;
    const T squared = dot(to_light, to_light);
    return {to_light * rsqrt(squared), squared};
}

template <class T>
inline Vec3<T> irradiance(const Light& light, const Vec3<T>& p, const T& squared) {
    Vec3<T> e(light.intensity);
    if (light.kind == LightKind::directional) return e;
    if (light.falloff) e = saturate(Vec3<T>{e.x / squared, e.y / squared, e.z / squared});
    if (light.kind == LightKind::spot) e = select(inside_cone(light, p), e, Vec3<T>{});
    return select(squared > T(0), e, Vec3<T>{});
}

template <class T>
inline Incoming<T> incoming(const Light& light, const Vec3<T>& p) {
    const WayToLight<T> way = way_to_light(light, p);
    return {way.direction, irradiance(light, p, way.squared)};
}

template <class T>
inline Vec3<T> reflected_direction(const Vec3<T>& d, const Vec3<T>& n) {
    return d - n * (T(2) * dot(d, n));
}

// Snell's law for the normal turned toward the viewer: eta is the ratio of the indices before and behind the surface.
template <class T>
struct Refraction {
    Vec3<T> direction;
    Mask<T> total;  // total internal reflection: there is no direction
};

template <class T>
inline Refraction<T> refract(const Vec3<T>& d, const Vec3<T>& n, T eta) {
    const T cosine = -dot(d, n);
    const T k = T(1) - square(eta) * (T(1) - square(cosine));
    const Vec3<T> t = d * eta + n * (eta * cosine - sqrt(maximum(T(0), k)));
    return {normalize(t), k < T(0)};
}

}  // namespace raybound
