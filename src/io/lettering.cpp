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

}  // namespace

void write_text(Pixels& picture, const Vec2& bottom, std::string_view text, double size_px, const Vec3& colour) {
  std::string plain(text);
  for (char& c : plain) {
    if (c < ' ' || c > '~') c = '?';
  }
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

}  // namespace pirsim::io
