// What a log tells, in words, and on a page: its days as time lines, and tables.
#pragma once

#include <string>

#include "pirsim/log.hpp"
#include "show/report.hpp"

namespace pirsim::io {

/// How it was read: "rows of changes, 2 sensors, no counts".
[[nodiscard]] std::string form_in_words(const Log& log);
/// Which columns or entities are its sensors, and what isn't read: "hall, desk; not read: heating".
[[nodiscard]] std::string sensors_in_words(const Log& log);
/// All that it tells, for a terminal.
[[nodiscard]] std::string to_text(const Log& log, const LogFacts& facts);
/// Days as lines, a line a sensor; of logs with very many, a line a day. Without a footer.
[[nodiscard]] Report log_report(const Log& log, const LogFacts& facts, const std::string& title);

}  // namespace pirsim::io
