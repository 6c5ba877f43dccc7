// The pinhole camera: pixel (0,0) is top left, x grows to the right, rays pass through pixel centres.
#pragma once

#include <algorithm>
#include <array>

#include "raybound/geometry/matrix.h"

namespace raybound {

class Camera {
  public:
    // Throws std::invalid_argument: eye and target must differ, up must not be parallel to the view, 0 < fov < 180.
    Camera(const Vec3f& eye, const Vec3f& target, const Vec3f& up, float fov, int width, int height);

    const Vec3f& eye() const { return eye_; }
    const Vec3f& target() const { return target_; }
    const Vec3f& up() const { return up_; }
    float fov() const { return fov_; }  // vertical, degrees
    int width() const { return width_; }
    int height() const { return height_; }

    // What all rays follow from: cameras of the same numbers have the same rays.
    std::array<float, 12> numbers() const {
        return {eye_.x, eye_.y, eye_.z, target_.x, target_.y,     target_.z,
                up_.x,  up_.y,  up_.z,  fov_,      float(width_), float(height_)};
    }

    // The unit direction of the ray through the centre of pixel (x, y), as a function of float operations alone:
    // normalize((forward + right * sx) + upward * sy).
    template <class T>
    Vec3<T> direction(int x, int y) const {
        return direction_through(T(x), T(y));
    }
    // The same for the numbers of pixels as T has them: for several side by side.
    template <class T>
    Vec3<T> direction_through(const T& x, const T& y) const {
        const T sx = (x + T(0.5f)) * T(step_x_) - T(half_width_);
        const T sy = T(half_height_) - (y + T(0.5f)) * T(step_y_);
        return normalize(Vec3<T>(forward_) + Vec3<T>(right_) * sx + Vec3<T>(upward_) * sy);
    }

    // How fast the width of a pixel grows with the distance, at the middle of the picture.
    double pixel_angle() const { return std::max(double(step_x_), double(step_y_)); }

    Camera orbit(double azimuth, double elevation) const;  // around the target; degrees
    Camera dolly(double distance) const;                   // toward the target; scene units
    Camera pan(double right, double up) const;             // sideways, eye and target alike
    Camera look(double yaw, double pitch) const;           // turn in place; degrees, yaw to the left, pitch upward

  private:
    Camera moved(const Vec3d& eye, const Vec3d& target) const;

    Vec3f eye_, target_, up_;
    float fov_;
    int width_, height_;
    Vec3f forward_, right_, upward_;  // an orthonormal basis, rounded from double once
    float half_width_, half_height_, step_x_, step_y_;
};

}  // namespace raybound
