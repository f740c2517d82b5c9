// What pages carry: charts as JSON for their script, and texts that are built in. Private to io.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "io/pages/charts.hpp"

namespace pirsim::io::detail {

// Charts as the JSON that io/pages/report.js draws.

using ChartJson = nlohmann::ordered_json;
/// `kind` says which chart it is.
[[nodiscard]] ChartJson to_json(const Chart& chart);

/// Plain text as HTML.
[[nodiscard]] std::string escaped(const std::string& text);

// Texts that are built into the library for pages that work without a network.

[[nodiscard]] std::string_view vega_script() noexcept;    ///< defines `vega`; made by tools/make_vega_bundle.py
[[nodiscard]] std::string_view report_script() noexcept;  ///< src/io/pages/report.js
[[nodiscard]] std::string_view palette() noexcept;        ///< src/io/pages/palette.css, the colours of all pages
[[nodiscard]] std::string_view report_style() noexcept;   ///< src/io/pages/report.css
[[nodiscard]] std::string_view three_script() noexcept;   ///< defines `three`; made by tools/vendor_three
[[nodiscard]] std::string_view view_page() noexcept;      ///< src/io/pages/view.html, a template
[[nodiscard]] std::string_view view_script() noexcept;    ///< src/io/pages/{run,time_line,room,view}.js
[[nodiscard]] std::string_view view_style() noexcept;     ///< src/io/pages/view.css

}  // namespace pirsim::io::detail
