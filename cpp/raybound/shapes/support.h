// Support functions: how far a convex solid reaches in a direction, and the point of it that does. What tells convex
// sets apart (Gilbert, Johnson and Keerthi 1988).
#pragma once

#include "raybound/shapes/geometry.h"

namespace raybound {

// A convex set around what a leaf holds, in the world: the leaf itself, or the box that a quadric is clipped to.
// Meshes have none but their primitive's bounds.
class ConvexHull {
  public:
    ConvexHull(const Geometry& geometry, const Leaf& leaf);

    bool is_known() const { return known_; }
    bool is_exact() const { return exact_; }  // the leaf itself

    // A point of the solid's inside.
    const Vec3d& center() const { return center_; }

    // How many times longer an error of the leaf's own coordinates may be in the world than where it was made: the
    // condition of its frame (1 without one), and of a cone's slope.
    double condition() const { return condition_; }

    // The point of the hull farthest along n; its error is a few roundings of its coordinates.
    Vec3d support(const Vec3d& n) const;

  private:
    Vec3d local_support(const Vec3d& n) const;

    const Geometry& geometry_;
    const Leaf& leaf_;
    const Frame* frame_ = nullptr;
    Mat3<double> to_world_;  // of directions from the frame's coordinates
    Vec3d center_;
    double condition_ = 1;
    bool known_ = true, exact_ = true;
};

}  // namespace raybound
