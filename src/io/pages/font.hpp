// The font of texts on pictures, which is built in. Private to io.
#pragma once

#include <string_view>

namespace pirsim::io::detail {

[[nodiscard]] std::string_view font_file() noexcept;  ///< third_party/dejavu/DejaVuSans.ttf

}  // namespace pirsim::io::detail
