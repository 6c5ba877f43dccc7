// Materials (Ward isotropic, with Whitted's reflection and transmission) and lights: immutable values.
#pragma once

#include "raybound/scene/texture.h"

namespace raybound {

struct Material {
    Vec3f diffuse{0.5f, 0.5f, 0.5f};
    TexturePointer texture;  // replaces `diffuse`
    Vec3f specular, reflect, transmit;
    float roughness = 0.2f, ior = 1.5f;
};
using MaterialPointer = std::shared_ptr<const Material>;

// Colours are finite and not negative; throws std::invalid_argument that names object and argument.
void require_colour(const char* object, const char* argument, const Vec3f& colour);

// Throws std::invalid_argument that names the argument.
MaterialPointer make_material(const Material& material);

enum class LightKind : std::uint8_t { directional, point, spot };

struct Light {
    LightKind kind = LightKind::point;
    Vec3f position;
    Vec3d direction;  // a unit vector, the way the light travels
    Vec3f intensity;  // radiance for directional lights
    double cos_cutoff = -1;
    bool falloff = false;
};
using LightPointer = std::shared_ptr<const Light>;

LightPointer make_directional_light(const Vec3f& direction, const Vec3f& radiance);
LightPointer make_point_light(const Vec3f& position, const Vec3f& intensity, bool falloff);
LightPointer make_spot_light(const Vec3f& position, const Vec3f& direction, float cutoff, const Vec3f& intensity,
                             bool falloff);

}  // namespace raybound
