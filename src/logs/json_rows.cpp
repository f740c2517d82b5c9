#include "logs/json_rows.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "logs/log_head.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {
namespace {

using Json = nlohmann::json;

/// Home Assistant's short keys of a state, which stands for itself in longer ones.
std::string long_key(const std::string& key) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> keys{
      {{"s", "state"}, {"lu", "last_updated"}, {"lc", "last_changed"}, {"a", "attributes"}}};
  const auto known = std::ranges::find(keys, key, [](const auto& pair) { return pair.first; });
  return std::string(known == keys.end() ? std::string_view(key) : known->second);
}

void flatten(const Json& object, const std::string& before, std::vector<std::pair<std::string, std::string>>& row) {
  const bool is_short = before.empty() && object.contains("lu");
  for (const auto& [key, value] : object.items()) {
    const std::string name = before + (is_short ? long_key(key) : key);
    if (value.is_object()) flatten(value, name + '.', row);
    if (value.is_primitive() && !value.is_null()) row.emplace_back(name, state_text(value));
  }
}

}  // namespace

std::string state_text(const Json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
  if (value.is_null()) return "unknown";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string quoted_field(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

void JsonRows::take(const Json& object) {
  Row row;
  flatten(object, {}, row);
  if (row.empty()) return;
  Level* parent = levels_.empty() ? nullptr : &levels_.back();
  if (parent != nullptr && !parent->key.empty()) row.emplace_back("name", parent->key);
  for (const auto& [key, text] : row) {
    const bool is_first = levels_.size() > 1 && !parent->has_rows && levels_[levels_.size() - 2].is_array;
    if (is_first && what_name_says(key) == NameSays::sensor) parent->names.emplace_back(key, text);
  }
  for (const auto& [key, text] : parent == nullptr ? Row{} : parent->names) {
    if (std::ranges::find(row, key, [](const auto& cell) { return cell.first; }) == row.end())
      row.emplace_back(key, text);
  }
  for (Level& level : levels_) level.has_rows = true;
  rows_.push_back(std::move(row));
}

bool JsonRows::add(std::string_view text, int line) {
  constexpr int deepest = 64;
  levels_.clear();
  const auto refuse = [&](const std::string& why) { throw Error(ErrorCode::input, {file_, line, 1}, why); };
  using Event = Json::parse_event_t;
  const auto see = [&](int depth, Event event, Json& value) {
    if (depth > deepest) refuse("JSON of more than " + std::to_string(deepest) + " levels is no table");
    if (event == Event::key) {
      levels_.back().key = value.get<std::string>();
      if (levels_.back().key == "resultType")
        refuse(
            "expected a table, got Prometheus' answer, which has a list of readings a sensor: save it as CSV, with "
            "the time and a column a sensor");
    } else if (event == Event::object_start || event == Event::array_start) {
      const std::string key = levels_.empty() ? std::string() : levels_.back().key;
      levels_.push_back({event == Event::array_start, false, event == Event::array_start ? key : std::string()});
    } else if (event == Event::array_end) {
      levels_.pop_back();
    } else if (event == Event::object_end) {
      const bool has_rows = levels_.back().has_rows;
      levels_.pop_back();
      if (has_rows || (!levels_.empty() && !levels_.back().is_array)) return true;
      take(value);
      return false;  // nobody needs it any more
    }
    return true;
  };
  const std::size_t n_before = rows_.size();
  try {
    const Json whole = Json::parse(text, see);
  } catch (const Json::parse_error& fault) {
    if (fault.byte <= text.size()) refuse("expected a table, or JSON, which this isn't: save the log as CSV");
    rows_.resize(n_before);
    return false;
  }
  return true;
}

std::string JsonRows::header() {
  if (rows_.empty()) {
    throw Error(ErrorCode::input, {file_, 1, 1},
                "expected a table, got JSON without a list of objects: save the log as CSV");
  }
  constexpr std::size_t widest_alone = 500;  // assumed
  if (rows_.size() == 1 && rows_.front().size() > widest_alone)
    throw Error(
        ErrorCode::input, {file_, 1, 1},
        "expected a list of objects, a row each, got one object: of a table that pandas writes, orient='records'");
  for (const Row& row : rows_) {
    for (const auto& [key, text] : row) {
      if (std::ranges::find(columns_, key) == columns_.end()) columns_.push_back(key);
    }
  }
  std::string line;
  for (const std::string& column : columns_) line += (line.empty() ? "" : "\t") + quoted_field(column);
  return line;
}

std::string JsonRows::next() {
  const Row row = std::move(rows_.front());
  rows_.pop_front();
  std::string line;
  for (const std::string& column : columns_) {
    const auto cell = std::ranges::find(row, column, [](const auto& one) { return one.first; });
    line += (&column == columns_.data() ? "" : "\t") + quoted_field(cell == row.end() ? std::string() : cell->second);
  }
  return line;
}

}  // namespace pirsim::io
