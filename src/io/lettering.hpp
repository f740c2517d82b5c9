// Short texts on pictures.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/png.hpp"

namespace pirsim::io {

/// Writes `text` with the middle of its lower edge at a pixel, in a plain font with a light rim. Characters beyond
/// ASCII appear as '?'; what lies outside the picture is cut off.
void write_text(Pixels& picture, const Vec2& bottom, std::string_view text, double size_px, const Vec3& colour);

/// A text as write_text() takes it.
struct Lettering {
  Vec2 bottom{0.0};
  std::string text;
  Vec3 colour{0.0};
};
/// Width and height of a text in pixels.
[[nodiscard]] Vec2 text_extent(std::string_view text, double size_px);
/// The same texts, apart from each other: one that would cover an earlier one moves up or down, to the nearest free
/// place. Where there is none within ten lines it stays.
[[nodiscard]] std::vector<Lettering> set_apart(std::vector<Lettering> texts, double size_px);

}  // namespace pirsim::io
