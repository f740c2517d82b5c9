// Short texts on pictures.
#pragma once

#include <string_view>

#include "io/png.hpp"

namespace pirsim::io {

/// Writes `text` with the middle of its lower edge at a pixel, in a plain font with a light rim. Characters beyond
/// ASCII appear as '?'; what lies outside the picture is cut off.
void write_text(Pixels& picture, const Vec2& bottom, std::string_view text, double size_px, const Vec3& colour);

}  // namespace pirsim::io
