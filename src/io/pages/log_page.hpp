// A log on a page: its days as time lines, and what it tells.
#pragma once

#include "io/pages/report.hpp"
#include "pirsim/log_facts.hpp"

namespace pirsim::io {

/// Days as lines, a line a sensor; of logs with very many, a line a day. Without a footer.
[[nodiscard]] Report log_report(const Log& log, const LogFacts& facts, const std::string& title);

}  // namespace pirsim::io
