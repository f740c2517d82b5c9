// Pictures as PNG files.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/geometry.hpp"

namespace pirsim::io {

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< (height x width x 3), row by row from the top left, sRGB
};

/// The bytes of a PNG file; rgb as in Pixels. Throws Error(usage) if the sizes don't match.
[[nodiscard]] std::string to_png(int width, int height, std::span<const std::uint8_t> rgb);
/// Writes a PNG file, atomically; Error(io) if it can't be written, Error(usage) if the sizes don't match.
void write_png(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> rgb);

// Lines on a picture, with smooth edges.

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

// The font of texts on pictures, which is built in. Private to io.

namespace pirsim::io::detail {

[[nodiscard]] std::string_view font_file() noexcept;  ///< third_party/dejavu/DejaVuSans.ttf

}  // namespace pirsim::io::detail

// Short texts on pictures.

namespace pirsim::io {

/// Writes UTF-8 with the middle of its lower edge at a pixel, in DejaVu Sans with a light rim. size_px: from a line to
/// the next one that touches it. Characters that the font hasn't got appear as '?'; what lies outside the picture is
/// cut off.
void write_text(Pixels& picture, const Vec2& bottom, std::string_view text, double size_px, const Vec3& colour);

/// A text as write_text() takes it.
struct Lettering {
  Vec2 bottom{0.0};
  std::string text;
  Vec3 colour{0.0};
};
/// Width and height of a text in pixels.
[[nodiscard]] Vec2 text_extent(std::string_view text, double size_px);

[[nodiscard]] PixelBox box_of(const Lettering& text, double size_px);
/// With a pixel between them.
[[nodiscard]] bool overlap(const PixelBox& a, const PixelBox& b);
/// These texts apart from each other and from what is taken: one that would cover an earlier one moves up or down, to
/// the nearest free place. Where there is none within ten lines it stays.
[[nodiscard]] std::vector<Lettering> set_apart(std::vector<Lettering> texts, double size_px,
                                               std::span<const PixelBox> taken = {});

}  // namespace pirsim::io
