#include "raybound/scene/material.h"

#include <stdexcept>

#include "raybound/shapes/shape.h"

namespace raybound {

namespace {

[[noreturn]] void refuse(const std::string& message) { throw std::invalid_argument(message); }

Vec3d unit_direction(const char* object, const Vec3f& direction) {
    require_finite(object, "direction", direction);
    const double size = length(Vec3d(direction));
    if (!(size >= double(least_size)))
        refuse(std::string(object) + ": direction must not be zero, got " + format(direction));
    return Vec3d(direction) * (1 / size);
}

}  // namespace

void require_colour(const char* object, const char* argument, const Vec3f& c) {
    require_finite(object, argument, c);
    if (!(c.x >= 0 && c.y >= 0 && c.z >= 0))
        refuse(std::string(object) + ": " + argument + " must be >= 0, got " + format(c));
}

MaterialPointer make_material(const Material& m) {
    require_colour("Material", "diffuse", m.diffuse);
    require_colour("Material", "specular", m.specular);
    require_colour("Material", "reflect", m.reflect);
    require_colour("Material", "transmit", m.transmit);
    require_finite("Material", "roughness", m.roughness);
    require_finite("Material", "ior", m.ior);
    if (!(m.roughness >= 1e-4f))
        refuse("Material: roughness must be >= 0.0001 (the Ward lobe's peak grows with 1/roughness**2), got " +
               format(m.roughness));
    if (!(m.ior >= 1e-3f && m.ior <= 1e3f)) refuse("Material: ior must be within 0.001 and 1000, got " + format(m.ior));
    return std::make_shared<const Material>(m);
}

LightPointer make_directional_light(const Vec3f& direction, const Vec3f& radiance) {
    require_colour("DirectionalLight", "radiance", radiance);
    Light light;
    light.kind = LightKind::directional;
    light.direction = unit_direction("DirectionalLight", direction);
    light.intensity = radiance;
    return std::make_shared<const Light>(light);
}

LightPointer make_point_light(const Vec3f& position, const Vec3f& intensity, bool falloff) {
    require_finite("PointLight", "position", position);
    require_colour("PointLight", "intensity", intensity);
    Light light;
    light.position = position;
    light.intensity = intensity;
    light.falloff = falloff;
    return std::make_shared<const Light>(light);
}

LightPointer make_spot_light(const Vec3f& position, const Vec3f& direction, float cutoff, const Vec3f& intensity,
                             bool falloff) {
    require_finite("SpotLight", "position", position);
    require_colour("SpotLight", "intensity", intensity);
    if (!(cutoff > 0 && cutoff <= 180))
        refuse("SpotLight: cutoff must be within 0 and 180 degrees, got " + format(cutoff));
    Light light;
    light.kind = LightKind::spot;
    light.position = position;
    light.direction = unit_direction("SpotLight", direction);
    light.intensity = intensity;
    // At 180 degrees every direction is inside, one whose cosine rounds below -1 too.
    light.cos_cutoff = cutoff == 180 ? -2 : std::cos(double(cutoff) * (elementary::pi / 180));
    light.falloff = falloff;
    return std::make_shared<const Light>(light);
}

}  // namespace raybound
