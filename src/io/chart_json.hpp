// Charts as the JSON that io/page/report.js draws. Private to io.
#pragma once

#include <nlohmann/json.hpp>

#include "io/charts.hpp"

namespace pirsim::io::detail {

using ChartJson = nlohmann::ordered_json;
/// `kind` says which chart it is.
[[nodiscard]] ChartJson to_json(const Chart& chart);

}  // namespace pirsim::io::detail
