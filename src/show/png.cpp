#include "show/png.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "files/disk/file.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {
void Canvas::blend(int x, int y, const Vec3& colour, double opacity) {
  const double share = std::clamp(opacity, 0.0, 1.0);
  const auto at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_->width) + static_cast<std::size_t>(x));
  for (int channel = 0; channel < 3; ++channel) {
    std::uint8_t& value = picture_->rgb[at + static_cast<std::size_t>(channel)];
    value = static_cast<std::uint8_t>(std::lround(glm::mix(static_cast<double>(value), colour[channel], share)));
  }
}

void Canvas::line(const Vec2& a, const Vec2& b, const Vec3& colour, double width_px) {
  const double length = glm::distance(a, b), reach = 0.5 * width_px + 0.5;
  const Vec2 along = length > 0.0 ? (b - a) / length : Vec2(1.0, 0.0);
  each_near(glm::min(a, b), glm::max(a, b), reach, [&](int x, int y, const Vec2& centre) {
    const double t = std::clamp(glm::dot(centre - a, along), 0.0, length);
    blend(x, y, colour, reach - glm::distance(centre, a + t * along));
  });
}

}  // namespace pirsim::io

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

namespace pirsim::io {
namespace {

constexpr double below_baseline = 0.24;  // share of a line: what g and y have there

/// The characters of UTF-8; '?' for bytes that are none.
std::vector<int> characters_of(std::string_view text) {
  std::vector<int> characters;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const unsigned lead = byte(i++);
    const int following = lead < 0x80U ? 0 : lead >> 5U == 6U ? 1 : lead >> 4U == 14U ? 2 : lead >> 3U == 30U ? 3 : -1;
    unsigned value = following <= 0 ? lead : lead & (0x3FU >> static_cast<unsigned>(following));
    int read = 0;
    for (; read < following && i < text.size() && (byte(i) & 0xC0U) == 0x80U; ++read)
      value = value << 6U | (byte(i++) & 0x3FU);
    characters.push_back(read == following ? static_cast<int>(value) : '?');
  }
  return characters;
}

/// The built-in font at one size.
class Font {
 public:
  explicit Font(double size_px) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(detail::font_file().data());
    stbtt_InitFont(&info_, bytes, 0);
    scale_ = stbtt_ScaleForMappingEmToPixels(&info_, static_cast<float>(size_px));
  }

  /// Calls draw(glyph, x of its origin) for each glyph; returns the width.
  template <typename Draw>
  double lay_out(std::string_view text, Draw draw) const {
    double x = 0.0;
    for (const int character : characters_of(text)) {
      int glyph = stbtt_FindGlyphIndex(&info_, character);
      if (glyph == 0) glyph = stbtt_FindGlyphIndex(&info_, '?');
      int advance = 0, bearing = 0;
      stbtt_GetGlyphHMetrics(&info_, glyph, &advance, &bearing);
      draw(glyph, x);
      x += static_cast<double>(scale_) * advance;
    }
    return x;
  }

  /// Calls paint(x, y, how much of the pixel is covered) for a glyph whose origin is at a point of the baseline.
  template <typename Paint>
  void paint(int glyph, const Vec2& origin, Paint paint) const {
    const Vec2 whole(std::floor(origin.x), std::floor(origin.y)), shift = origin - whole;
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    stbtt_GetGlyphBitmapBoxSubpixel(&info_, glyph, scale_, scale_, static_cast<float>(shift.x),
                                    static_cast<float>(shift.y), &x0, &y0, &x1, &y1);
    const int width = x1 - x0, height = y1 - y0;
    if (width <= 0 || height <= 0) return;
    std::vector<std::uint8_t> cover(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    stbtt_MakeGlyphBitmapSubpixel(&info_, cover.data(), width, height, width, scale_, scale_,
                                  static_cast<float>(shift.x), static_cast<float>(shift.y), glyph);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto value =
            cover[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
        paint(static_cast<int>(whole.x) + x0 + x, static_cast<int>(whole.y) + y0 + y, value / 255.0);
      }
    }
  }

 private:
  stbtt_fontinfo info_{};
  float scale_ = 0.0F;
};

/// How much of each pixel of a part of a picture is covered.
class Mask {
 public:
  Mask(int left, int top, int width, int height)
      : left_(left),
        top_(top),
        width_(width),
        height_(height),
        cover_(static_cast<std::size_t>(std::max(0, width)) * static_cast<std::size_t>(std::max(0, height))) {}

  void cover(int x, int y, double share) {
    if (x < left_ || y < top_ || x >= left_ + width_ || y >= top_ + height_) return;
    double& value = cover_[index(x, y)];
    value = std::max(value, share);
  }
  /// Grown by a disc.
  [[nodiscard]] Mask grown(double radius_px) const {
    Mask result(left_, top_, width_, height_);
    const int reach = static_cast<int>(std::ceil(radius_px));
    each([&](int x, int y, double share) {
      if (share <= 0.0) return;
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          result.cover(x + dx, y + dy, share * std::clamp(radius_px + 0.5 - std::sqrt(dx * dx + dy * dy), 0.0, 1.0));
        }
      }
    });
    return result;
  }
  template <typename Use>
  void each(Use use) const {
    for (int y = top_; y < top_ + height_; ++y) {
      for (int x = left_; x < left_ + width_; ++x) use(x, y, cover_[index(x, y)]);
    }
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - top_) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x - left_);
  }
  int left_, top_, width_, height_;
  std::vector<double> cover_;
};

}  // namespace

void write_text(Pixels& picture, const Vec2& bottom, std::string_view text, double size_px, const Vec3& colour) {
  const Font font(size_px);
  const double width = font.lay_out(text, [](int, double) {}), rim = std::max(1.5, 0.18 * size_px);
  const Vec2 origin = bottom - Vec2(0.5 * width, below_baseline * size_px);
  // Accents and long tails reach beyond the line.
  const auto pixel = [](double v, int limit) {
    return static_cast<int>(std::clamp(std::floor(v), 0.0, static_cast<double>(limit)));
  };
  const int left = pixel(origin.x - size_px, picture.width), right = pixel(origin.x + width + size_px, picture.width);
  const int top = pixel(bottom.y - 2.0 * size_px, picture.height), end = pixel(bottom.y + size_px, picture.height);
  if (left >= right || top >= end) return;
  Mask ink(left, top, right - left, end - top);
  font.lay_out(text, [&](int glyph, double x) {
    font.paint(glyph, origin + Vec2(x, 0.0), [&](int px, int py, double share) { ink.cover(px, py, share); });
  });
  Canvas canvas(picture);
  ink.grown(rim).each([&](int x, int y, double share) { canvas.blend(x, y, Vec3(255.0), 0.85 * share); });
  ink.each([&](int x, int y, double share) { canvas.blend(x, y, colour, share); });
}

Vec2 text_extent(std::string_view text, double size_px) {
  return {Font(size_px).lay_out(text, [](int, double) {}), size_px};
}

PixelBox box_of(const Lettering& text, double size_px) {
  const Vec2 extent = text_extent(text.text, size_px);
  return {text.bottom - Vec2(0.5 * extent.x, extent.y), text.bottom + Vec2(0.5 * extent.x, 0.0)};
}

bool overlap(const PixelBox& a, const PixelBox& b) {
  return a.lower.x < b.upper.x + 1.0 && b.lower.x < a.upper.x + 1.0 && a.lower.y < b.upper.y + 1.0 &&
         b.lower.y < a.upper.y + 1.0;
}

std::vector<Lettering> set_apart(std::vector<Lettering> texts, double size_px, std::span<const PixelBox> taken) {
  constexpr int most_lines = 10, steps_per_line = 4;
  std::vector<PixelBox> boxes(taken.begin(), taken.end());
  for (Lettering& text : texts) {
    const double step = size_px / steps_per_line;
    for (int n = 0; n <= 2 * most_lines * steps_per_line; ++n) {
      Lettering moved = text;
      moved.bottom.y += step * ((n + 1) / 2) * (n % 2 == 0 ? 1.0 : -1.0);
      const PixelBox box = box_of(moved, size_px);
      if (std::ranges::any_of(boxes, [&](const PixelBox& other) { return overlap(box, other); })) continue;
      text.bottom = moved.bottom;
      break;
    }
    boxes.push_back(box_of(text, size_px));
  }
  return texts;
}

}  // namespace pirsim::io

// Static, because tinygltf brings another copy.
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace pirsim::io {
namespace {

constexpr int channels = 3;

void append_chunk(void* text, void* data, int size) {
  static_cast<std::string*>(text)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

}  // namespace

std::string to_png(int width, int height, std::span<const std::uint8_t> rgb) {
  const std::int64_t bytes = std::int64_t{width} * height * channels;
  if (width < 1 || height < 1 || bytes > std::numeric_limits<int>::max() || std::cmp_not_equal(bytes, rgb.size())) {
    throw Error(ErrorCode::usage, "the picture's width, height and pixels don't match");
  }
  std::string png;
  if (stbi_write_png_to_func(append_chunk, &png, width, height, channels, rgb.data(), width * channels) == 0) {
    throw Error(ErrorCode::internal, "the picture can't be encoded");
  }
  return png;
}

void write_png(const std::filesystem::path& path, int width, int height, std::span<const std::uint8_t> rgb) {
  write_text_file(path, to_png(width, height, rgb));
}

}  // namespace pirsim::io
