// What a surface sends toward the viewer by itself, and the rays it asks for, at one point or at several side by side:
// the base tracer's formulas in the base tracer's order, whatever decides about shadows.
#pragma once

#include "raybound/trace/shading.h"

namespace raybound {

// A hit, ready for light: N is turned toward the viewer V.
template <class T>
struct LitPoint {
    Vec3<T> point, normal, view, diffuse;
};

// What one light would add, before anything is asked about shadows. `irradiance` and `shines` mean something where the
// light faces, `factor` where it shines, too.
template <class T>
struct LightTerm {
    Vec3<T> direction, irradiance, factor;
    Mask<T> faces, shines;  // the light is in front of the surface; the point is within its reach
    Mask<T> weighs;         // faces, shines, and a ray to it has a weight above 0
};

// (Inlined, as its results would otherwise go through memory: measured, 3 % of the base tracer's instructions.)
template <class T>
[[gnu::always_inline]] inline LightTerm<T> light_term(const Light& light, const Material& material,
                                                      const LitPoint<T>& at, const T& n_dot_v) {
    const WayToLight<T> way = way_to_light(light, at.point);
    const T n_dot_l = dot(at.normal, way.direction);
    LightTerm<T> term{way.direction, {}, {}, n_dot_l > T(0), Mask<T>(false), Mask<T>(false)};
    if (none(term.faces)) return term;
    term.irradiance = irradiance(light, at.point, way.squared);
    term.shines = max_component(term.irradiance) > T(0);
    if (none(term.faces & term.shines)) return term;
    term.factor = saturate(reflectance(at.diffuse, material, at.normal, way.direction, at.view, n_dot_l, n_dot_v));
    term.weighs = term.faces & term.shines & (max_component(term.factor) > T(0));
    return term;
}

// `outside` is the index of refraction outside of the solid, where the ray enters it.
// The rays that a surface below the largest depth sends on, and their weights. A direction means something where its
// weight is above 0.
template <class T>
struct SecondaryRays {
    Vec3<T> reflect, transmit;     // weights
    Vec3<T> reflected, refracted;  // directions
    Mask<T> total;                 // total internal reflection: the transmit weight joins the reflected ray
};

template <class T>
[[gnu::always_inline]] inline SecondaryRays<T> secondary_rays(const Material& material, const Vec3<T>& direction,
                                                              const Vec3<T>& normal, const Mask<T>& entering,
                                                              const T& outside) {
    SecondaryRays<T> rays{Vec3<T>(material.reflect), Vec3<T>(material.transmit), Vec3<T>{}, Vec3<T>{}, Mask<T>(false)};
    if (max_component(material.transmit) > 0) {
        const T ior(material.ior);
        const Refraction<T> refraction = refract(direction, normal, select(entering, outside / ior, ior));
        rays.refracted = refraction.direction;
        rays.total = refraction.total;
        rays.reflect = select(rays.total, saturate(rays.reflect + rays.transmit), rays.reflect);
        rays.transmit = select(rays.total, Vec3<T>{}, rays.transmit);
    }
    if (!none(max_component(rays.reflect) > T(0))) rays.reflected = reflected_direction(direction, normal);
    return rays;
}

}  // namespace raybound
