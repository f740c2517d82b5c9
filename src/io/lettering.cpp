#include "io/lettering.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_easy_font.h>
#pragma GCC diagnostic pop

namespace pirsim::io {
namespace {

constexpr double font_height = 8.0;  // of a capital with its descent, in the font's own units

/// As stb_easy_font writes it: the corners of an axis-parallel rectangle.
struct Quad {
  struct Corner {
    float x, y, z;
    std::array<unsigned char, 4> colour;
  };
  std::array<Corner, 4> corners;
};

void blend_rectangle(Pixels& picture, const Vec2& lower, const Vec2& upper, const Vec3& colour, double opacity) {
  const auto clamped = [](double v, int limit) {
    return static_cast<int>(std::clamp(std::round(v), 0.0, static_cast<double>(limit)));
  };
  for (int y = clamped(lower.y, picture.height); y < clamped(upper.y, picture.height); ++y) {
    for (int x = clamped(lower.x, picture.width); x < clamped(upper.x, picture.width); ++x) {
      const std::size_t at =
          3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x));
      for (int channel = 0; channel < 3; ++channel) {
        std::uint8_t& value = picture.rgb[at + static_cast<std::size_t>(channel)];
        value = static_cast<std::uint8_t>(std::lround((1.0 - opacity) * value + opacity * colour[channel]));
      }
    }
  }
}

/// The font's characters.
std::string in_ascii(std::string_view text) {
  std::string plain(text);
  for (char& c : plain) {
    if (c < ' ' || c > '~') c = '?';
  }
  return plain;
}

/// Whether two texts of these extents cover each other, with a pixel between them.
bool overlap(const Vec2& a, const Vec2& extent_a, const Vec2& b, const Vec2& extent_b) {
  return std::abs(a.x - b.x) < 0.5 * (extent_a.x + extent_b.x) + 1.0 && a.y - extent_a.y < b.y + 1.0 &&
         b.y - extent_b.y < a.y + 1.0;
}

}  // namespace

void write_text(Pixels& picture, const Vec2& bottom, std::string_view text, double size_px, const Vec3& colour) {
  std::string plain = in_ascii(text);
  constexpr std::size_t most_quads_of_character = 16;
  std::vector<Quad> quads(plain.size() * most_quads_of_character);
  const int n = stb_easy_font_print(0.0F, 0.0F, plain.data(), nullptr, quads.data(),
                                    static_cast<int>(quads.size() * sizeof(Quad)));
  quads.resize(static_cast<std::size_t>(n));
  const double scale = size_px / font_height;
  const Vec2 origin = bottom - scale * Vec2(0.5 * stb_easy_font_width(plain.data()), font_height);
  const auto draw = [&](const Vec3& ink, double rim_px, double opacity) {
    for (const Quad& quad : quads) {
      const auto corner = [&](std::size_t i) { return origin + scale * Vec2(quad.corners[i].x, quad.corners[i].y); };
      blend_rectangle(picture, corner(0) - rim_px, corner(2) + rim_px, ink, opacity);
    }
  };
  constexpr double rim = 0.75;  // of the font's units
  draw(Vec3(255.0), rim * scale, 0.8);
  draw(colour, 0.0, 1.0);
}

Vec2 text_extent(std::string_view text, double size_px) {
  std::string plain = in_ascii(text);
  return size_px * Vec2(stb_easy_font_width(plain.data()) / font_height, 1.0);
}

std::vector<Lettering> set_apart(std::vector<Lettering> texts, double size_px) {
  constexpr int most_lines = 10, steps_per_line = 4;
  std::vector<Vec2> extents;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    extents.push_back(text_extent(texts[i].text, size_px));
    const auto is_free = [&](const Vec2& at) {
      for (std::size_t k = 0; k < i; ++k) {
        if (overlap(texts[k].bottom, extents[k], at, extents[i])) return false;
      }
      return true;
    };
    const double step = size_px / steps_per_line;
    const Vec2 wanted = texts[i].bottom;
    for (int n = 0; n <= 2 * most_lines * steps_per_line; ++n) {
      const Vec2 at = wanted + Vec2(0.0, step * ((n + 1) / 2) * (n % 2 == 0 ? 1.0 : -1.0));
      if (!is_free(at)) continue;
      texts[i].bottom = at;
      break;
    }
  }
  return texts;
}

}  // namespace pirsim::io
