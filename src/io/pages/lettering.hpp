// Short texts on pictures.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/pages/canvas.hpp"

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
