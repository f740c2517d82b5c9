// What a log tells, in words and tables.
#pragma once

#include <string>
#include <vector>

#include "pirsim/log_facts.hpp"
#include "show/report.hpp"

namespace pirsim::io {

/// "readings every 30 s, 2 sensors, people: Room_Occupancy_Count, up to 3; 2017-12-22T10:49:11 to ..., 10129 rows"
[[nodiscard]] std::string log_in_words(const Log& log);
/// How it was read: "rows of changes, 2 sensors, no counts".
[[nodiscard]] std::string form_in_words(const Log& log);

/// A row a sensor: share of motion, pulses, pauses, false triggers.
[[nodiscard]] Table sensor_table(const Log& log, const LogFacts& facts);
/// A row a pair, of those most alike.
[[nodiscard]] Table pair_table(const LogFacts& facts, std::size_t most);
/// A row a gap.
[[nodiscard]] Table gap_table(const Log& log, const LogFacts& facts);
/// What the tables' columns mean, and what isn't in them.
[[nodiscard]] std::vector<std::string> log_notes(const Log& log, const LogFacts& facts);

/// Of all of it, for a terminal.
[[nodiscard]] std::string to_text(const Log& log, const LogFacts& facts);

// A log on a page: its days as time lines, and what it tells.

/// Days as lines, a line a sensor; of logs with very many, a line a day. Without a footer.
[[nodiscard]] Report log_report(const Log& log, const LogFacts& facts, const std::string& title);

}  // namespace pirsim::io
