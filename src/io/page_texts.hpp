// Texts that are built into the library for pages that work without a network. Private to io.
#pragma once

#include <string_view>

namespace pirsim::io::detail {

[[nodiscard]] std::string_view vega_script() noexcept;    ///< defines `vega`; made by tools/make_vega_bundle.py
[[nodiscard]] std::string_view report_script() noexcept;  ///< src/io/page/report.js
[[nodiscard]] std::string_view report_style() noexcept;   ///< src/io/page/report.css

}  // namespace pirsim::io::detail
