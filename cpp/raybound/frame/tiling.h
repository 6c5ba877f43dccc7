// A picture in tiles, the items of the work queue.
#pragma once

#include <algorithm>

#include "raybound/frame/buffers.h"

namespace raybound {

inline constexpr int tile_size = 32;  // TUNED: 16 to 64 measure alike on two cores

struct Tile {
    int x0, y0, x1, y1;
};

// Sets of tiles over the picture; their sides are multiples of the stride, so that blocks do not straddle tiles.
class Tiling {
  public:
    Tiling(const FrameBuffers& buffers, int stride)
        : side_((tile_size + stride - 1) / stride * stride),
          width_(buffers.width),
          height_(buffers.height),
          columns_((width_ + side_ - 1) / side_) {}

    int count() const { return columns_ * ((height_ + side_ - 1) / side_); }
    Tile tile(int item) const {
        const int x = item % columns_ * side_, y = item / columns_ * side_;
        return {x, y, std::min(x + side_, width_), std::min(y + side_, height_)};
    }

  private:
    int side_, width_, height_, columns_;
};

}  // namespace raybound
