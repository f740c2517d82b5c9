// Lines on a picture, with smooth edges.
#pragma once

#include <algorithm>

#include "io/pages/png.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::io {

/// A part of a picture in pixels.
struct PixelBox {
  Vec2 lower{0.0}, upper{0.0};
};

/// Draws on a picture that outlives it; what lies outside of the picture, or of the box, is cut off. Points are in
/// pixels from the top left corner, the middle of the first pixel is at (0.5, 0.5). Colours are sRGB from 0 to 255.
class Canvas {
 public:
  explicit Canvas(Pixels& picture, const PixelBox& box = {Vec2(0.0), Vec2(1e9)}) noexcept
      : picture_(&picture), box_(box) {}

  /// opacity: from 0 to 1; beyond it is cut off.
  void blend(int x, int y, const Vec3& colour, double opacity);
  void line(const Vec2& a, const Vec2& b, const Vec3& colour, double width_px);

  /// Calls paint(x, y, centre of the pixel) for all pixels in a box grown by `margin`.
  template <typename Paint>
  void each_near(const Vec2& lower, const Vec2& upper, double margin, Paint paint) {
    const auto first = [&](double v, double least) { return static_cast<int>(std::clamp(v - margin, least, 1e9)); };
    const auto last = [&](double v, double most, int size) {
      return static_cast<int>(std::clamp(v + margin, -1.0, std::min(most, static_cast<double>(size)) - 1.0));
    };
    for (int y = first(lower.y, box_.lower.y); y <= last(upper.y, box_.upper.y, picture_->height); ++y) {
      for (int x = first(lower.x, box_.lower.x); x <= last(upper.x, box_.upper.x, picture_->width); ++x)
        paint(x, y, Vec2(x + 0.5, y + 0.5));
    }
  }

 private:
  Pixels* picture_;
  PixelBox box_;
};

}  // namespace pirsim::io
