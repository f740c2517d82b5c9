// Words of logs: states, and what columns are called. Private to io.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/read/split_fields.hpp"

namespace pirsim::io {

/// log_state of "1", "0.0", "on", "False", "motion", "unavailable", ""; none for what is no state.
[[nodiscard]] std::optional<std::int32_t> read_state(std::string_view text);
/// "", "nan", "null": a table's cell in which nothing stands.
[[nodiscard]] bool is_empty_cell(std::string_view text);
/// A whole number from 0, also as "3.0"; log_state::unknown_count for what says that nobody knows; none for any other
/// text.
[[nodiscard]] std::optional<std::int32_t> read_count(std::string_view text);

/// A name in small letters, cut at what is neither letter nor digit, and before capitals that follow small letters:
/// {"s6", "pir"},
/// {"front", "door"}.
[[nodiscard]] std::vector<std::string> words_of_name(std::string_view name);

enum class NameSays { nothing, time, sensor, state, motion, count, presence, other_quantity, other_device };
/// What a column or an entity is by its name. `time`, `sensor` and `state` are said only of whole names.
[[nodiscard]] NameSays what_name_says(std::string_view name);
/// How surely the name says that a column is the time: 3 for "timestamp", which tells when something happened; 2 for
/// "utc"; 1 for other names, also for "received", which may be later.
[[nodiscard]] int rank_as_time(std::string_view name);
/// "M003", "MA012": how CASAS calls motion sensors.
[[nodiscard]] bool is_casas_motion(std::string_view name);

/// A text that YAML takes for nothing else.
[[nodiscard]] std::string quoted_yaml(const std::string& text);

}  // namespace pirsim::io
