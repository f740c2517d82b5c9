#include "io/log/log_words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/files/atomic_file.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {
namespace {

constexpr std::array on_words{"on",  "true",     "yes",    "motion",   "motion detected", "motion_detected",
                              "det", "detected", "active", "occupied", "moving"};
constexpr std::array off_words{"off",          "false",    "no",     "clear",        "no motion",  "no_motion",
                               "not detected", "inactive", "vacant", "not_detected", "unoccupied", "idle"};
constexpr std::array unknown_words{"", "unavailable", "unknown", "none", "null", "nan", "na", "n/a", "<na>", "-", "?"};

std::string small(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  std::string result(text);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

template <typename Words>
bool is_one_of(const Words& words, std::string_view text) {
  return std::ranges::any_of(words, [&](std::string_view word) { return word == text; });
}

constexpr std::size_t longest_state = 24;

std::optional<double> number_of(std::string text) {
  if (const std::size_t comma = text.find(','); comma != std::string::npos) text[comma] = '.';
  const auto value = parse_number<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

bool begins_with_one_of(const std::vector<std::string>& words, const auto& beginnings) {
  return std::ranges::any_of(words, [&](const std::string& word) {
    return std::ranges::any_of(beginnings, [&](std::string_view beginning) { return word.starts_with(beginning); });
  });
}

}  // namespace

std::optional<std::int32_t> read_state(std::string_view text) {
  if (text == "0" || text == "OFF" || text == "off") return log_state::off;
  if (text == "1" || text == "ON" || text == "on") return log_state::on;
  if (text.size() > longest_state) return std::nullopt;
  const std::string word = small(text);
  if (is_one_of(on_words, word)) return log_state::on;
  if (is_one_of(off_words, word)) return log_state::off;
  if (is_one_of(unknown_words, word)) return log_state::unknown;
  const auto number = number_of(word);
  if (number == 0.0) return log_state::off;
  if (number == 1.0) return log_state::on;
  return std::nullopt;
}

bool is_empty_cell(std::string_view text) {
  if (text.empty()) return true;
  if (text.size() > longest_state) return false;
  const std::string word = small(text);
  return word.empty() || word == "nan" || word == "null" || word == "<na>";
}

std::optional<std::int32_t> read_count(std::string_view text) {
  constexpr double most = 1e6;  // assumed: a stadium has fewer
  if (text.size() > longest_state) return std::nullopt;
  const std::string word = small(text);
  if (is_one_of(unknown_words, word)) return log_state::unknown_count;
  if (const auto number = number_of(word);
      number && *number >= 0.0 && *number <= most && *number == std::floor(*number))
    return static_cast<std::int32_t>(*number);
  const auto state = read_state(word);
  return state && *state != log_state::unknown ? state : std::nullopt;
}

std::vector<std::string> words_of_name(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  bool is_small = false;
  for (const char letter : name) {
    const bool is_capital = letter >= 'A' && letter <= 'Z';
    const char c = is_capital ? static_cast<char>(letter - 'A' + 'a') : letter;
    const bool is_part = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80U;
    if ((!is_part || (is_capital && is_small)) && !word.empty()) words.push_back(std::exchange(word, {}));
    if (is_part) word += c;
    is_small = letter >= 'a' && letter <= 'z';
  }
  if (!word.empty()) words.push_back(word);
  return words;
}

NameSays what_name_says(std::string_view name) {
  constexpr std::array times{
      "time",      "timestamp",  "datetime", "date_time", "date",       "time_s",     "_time",        "ts",
      "t",         "epoch",      "unix",     "unixtime",  "when",       "time stamp", "last_changed", "last_updated",
      "unix_time", "created_at", "received", "utc",       "local_time", "time_ms",    "seconds",      "epoch_s"};
  constexpr std::array sensors{"entity_id", "entity", "sensor", "sensor_id", "sensorid", "device", "sensor_name",
                               "device_id", "name",   "id",     "object_id", "node",     "topic",  "friendly_name"};
  constexpr std::array states{"state",   "value",     "message", "status",  "event",
                              "reading", "new_state", "_value",  "payload", "val"};
  constexpr std::array motions{"pir", "motion", "movement"};
  constexpr std::array counts{"people", "persons", "occupants", "headcount"};
  constexpr std::array presences{"occupancy", "occupied", "presence"};
  constexpr std::array quantities{"light",    "lux",   "illumin", "temp",        "sound", "noise",
                                  "co2",      "humid", "slope",   "volt",        "batt",  "power",
                                  "pressure", "rssi",  "energy",  "linkquality", "lqi"};
  constexpr std::array devices{"door", "window", "switch", "lock", "hvac", "contact", "tamper"};
  const std::string word = small(name);
  if (is_one_of(times, word) || word.ends_with("_ts")) return NameSays::time;
  if (is_one_of(sensors, word)) return NameSays::sensor;
  if (is_one_of(states, word)) return NameSays::state;
  if (word == "count") return NameSays::count;
  const std::vector<std::string> words = words_of_name(name);
  if (words.size() > 1 && words.front() == "g") return NameSays::nothing;  // openHAB's gMotion, a group
  const bool counts_something = std::ranges::find(words, "count") != words.end();
  constexpr std::array countable{"occup", "presence", "person"};
  if (begins_with_one_of(words, counts) || (counts_something && begins_with_one_of(words, countable)))
    return NameSays::count;
  if (begins_with_one_of(words, motions)) return NameSays::motion;
  if (begins_with_one_of(words, presences)) return NameSays::presence;
  if (begins_with_one_of(words, quantities)) return NameSays::other_quantity;
  if (begins_with_one_of(words, devices)) return NameSays::other_device;
  return NameSays::nothing;
}

int rank_as_time(std::string_view name) {
  constexpr std::array surest{"time", "timestamp", "ts", "last_changed"};
  constexpr std::array late{"received", "created_at", "last_updated"};
  const std::string word = small(name);
  if (is_one_of(surest, word)) return 3;
  return what_name_says(name) == NameSays::time && !is_one_of(late, word) && !word.ends_with("_ts") ? 2 : 1;
}

std::string quoted_yaml(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

bool is_casas_motion(std::string_view name) {
  if (!name.starts_with('M')) return false;
  name.remove_prefix(1);
  if (name.starts_with('A')) name.remove_prefix(1);  // one that sees a whole area
  return !name.empty() && std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace pirsim::io
