#include "raybound/frame/camera.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "raybound/geometry/rotation.h"
#include "raybound/shapes/shape.h"

namespace raybound {

namespace {

constexpr double radians = elementary::pi / 180;
constexpr std::int64_t most_pixels = std::int64_t(1) << 27;  // 4.4 GB of buffers

struct Basis {
    Vec3d forward, right, upward;
};

Basis basis(const Vec3f& eye, const Vec3f& target, const Vec3f& up) {
    const Vec3d forward = normalize(Vec3d(target) - Vec3d(eye));
    const Vec3d right = normalize(cross(forward, normalize(Vec3d(up))));
    return {forward, right, cross(right, forward)};
}

}  // namespace

Camera::Camera(const Vec3f& eye, const Vec3f& target, const Vec3f& up, float fov, int width, int height)
    : eye_(eye), target_(target), up_(up), fov_(fov), width_(width), height_(height) {
    require_finite("Camera", "eye", eye);
    require_finite("Camera", "target", target);
    require_finite("Camera", "up", up);
    const auto refuse = [](const std::string& message) { throw std::invalid_argument("Camera: " + message); };
    if (!(length(Vec3d(target) - Vec3d(eye)) >= double(least_size)))
        refuse("target must differ from eye, got " + format(eye) + " twice");
    if (!(length(Vec3d(up)) >= double(least_size))) refuse("up must not be zero, got " + format(up));
    const double sine = length(cross(normalize(Vec3d(target) - Vec3d(eye)), normalize(Vec3d(up))));
    if (!(sine > 1e-6)) refuse("up must not be parallel to the view, got up " + format(up));
    if (!(fov >= 1e-3f && fov <= 179.9f)) refuse("fov must be within 0.001 and 179.9 degrees, got " + format(fov));
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    if (std::min(width, height) < 1 || std::max(width, height) > 65536)
        refuse("width and height must be within 1 and 65536, got " + size);
    if (std::int64_t(width) * height > most_pixels) refuse("width * height must be at most 2**27, got " + size);
    const Basis b = basis(eye, target, up);
    forward_ = Vec3f(b.forward);
    right_ = Vec3f(b.right);
    upward_ = Vec3f(b.upward);
    const double half_height = std::tan(double(fov) * 0.5 * radians), half_width = half_height * width / height;
    half_height_ = float(half_height);
    half_width_ = float(half_width);
    step_x_ = float(2 * half_width / width);
    step_y_ = float(2 * half_height / height);
}

Camera Camera::moved(const Vec3d& eye, const Vec3d& target) const {
    return {Vec3f(eye), Vec3f(target), up_, fov_, width_, height_};
}

Camera Camera::orbit(double azimuth, double elevation) const {
    const Basis b = basis(eye_, target_, up_);
    const Vec3d arm = Vec3d(eye_) - Vec3d(target_);
    return moved(Vec3d(target_) + rotated(rotated(arm, b.right, -elevation), normalize(Vec3d(up_)), azimuth),
                 Vec3d(target_));
}

Camera Camera::dolly(double distance) const {
    const Vec3d step = basis(eye_, target_, up_).forward * distance;
    return moved(Vec3d(eye_) + step, Vec3d(target_) + step);
}

Camera Camera::pan(double right, double up) const {
    const Basis b = basis(eye_, target_, up_);
    const Vec3d step = b.right * right + b.upward * up;
    return moved(Vec3d(eye_) + step, Vec3d(target_) + step);
}

Camera Camera::look(double yaw, double pitch) const {
    const Basis b = basis(eye_, target_, up_);
    const Vec3d arm = rotated(rotated(Vec3d(target_) - Vec3d(eye_), b.right, pitch), normalize(Vec3d(up_)), yaw);
    return moved(Vec3d(eye_), Vec3d(eye_) + arm);
}

}  // namespace raybound
