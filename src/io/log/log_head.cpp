#include "io/log/log_head.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <string_view>

#include "core/text.hpp"
#include "io/log/log_proof.hpp"
#include "io/log/stamp.hpp"
#include "io/read/split_fields.hpp"
#include "schema/limits.hpp"

namespace pirsim::io {
namespace {

/// A first line of names has no time and no value in it, or names the time beside sensors that are numbers. "UTC"
/// beside a date names nothing.
bool is_header(const std::vector<std::string>& fields) {
  const auto is_value = [](const std::string& field) {
    return parse_stamp(field, LogMap::Dates::found) || order_of_date(field);
  };
  const auto is_moment = [&](const std::string& field) { return is_value(field) && !is_number(field); };
  const auto is_time = [](const std::string& field) { return what_name_says(field) == NameSays::time; };
  return std::ranges::none_of(fields, is_value) ||
         (std::ranges::any_of(fields, is_time) && std::ranges::none_of(fields, is_moment));
}

std::vector<std::string> fields_of(const HeadLine& line, char separator, const std::string& file) {
  std::vector<std::string_view> fields;
  std::vector<std::string> unquoted;
  if (!split_fields(line.text, separator, fields, unquoted))
    throw Error(ErrorCode::input, {file, line.line, 1}, "a quote that isn't closed, or text behind one that is");
  if (fields.size() > limits::log_columns) {
    throw Error(ErrorCode::input, {file, line.line, 1}, "more than " + std::to_string(limits::log_columns) + " fields");
  }
  const auto trimmed = [](std::string_view field) {
    while (field.starts_with(' ')) field.remove_prefix(1);
    while (field.ends_with(' ')) field.remove_suffix(1);
    return std::string(field);
  };
  std::vector<std::string> result;
  std::ranges::transform(fields, std::back_inserter(result), trimmed);
  return result;
}

void check_names(const HeadTable& table) {
  std::set<std::string> known;
  for (std::size_t i = 0; i < table.n_columns(); ++i) {
    const std::string& name = table.names[i];
    const Where where{table.file, table.header_line, 1};
    if (!known.insert(name).second) throw Error(ErrorCode::input, where, "column '" + name + "' appears twice");
    if (const std::string found = invisible_character(name, Lines::many); !found.empty())
      throw Error(ErrorCode::input, where, "the name of column " + std::to_string(i + 1) + " contains " + found);
  }
}

}  // namespace

char separator_of(const std::string& line) {
  constexpr std::array separators{',', ';', '\t'};
  const auto n = [&](char c) { return std::ranges::count(line, c); };
  const char most = *std::ranges::max_element(separators, {}, n);
  return n(most) == 0 ? ' ' : most;
}

bool is_number(const std::string& text) {
  const auto stamp = parse_stamp(text, LogMap::Dates::found);
  return stamp && stamp->kind == Stamp::Kind::number;
}

std::size_t HeadTable::count(std::size_t column, const std::function<bool(const std::string&)>& holds) const {
  return static_cast<std::size_t>(std::ranges::count_if(rows, [&](const auto& row) { return holds(row[column]); }));
}

std::size_t HeadTable::n_values(std::size_t column) const {
  std::set<std::string_view> values;
  for (const auto& row : rows) values.insert(row[column]);
  return values.size();
}

std::size_t HeadTable::named(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) refuse("there is no column '" + name + "'" + near_or_all(name, names));
  return static_cast<std::size_t>(found - names.begin());
}

std::string HeadTable::columns_in_words() const {
  constexpr std::size_t most = 12;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < std::min(most, n_columns()); ++i)
    texts.push_back(shortened(names[i]) + " ('" + (rows.empty() ? "" : rows.front()[i]) + "')");
  return "; the columns and their first values: " + joined(texts, ", ") + (n_columns() > most ? ", ..." : "");
}

void HeadTable::refuse(const std::string& why) const {
  throw Error(ErrorCode::input, {file, std::max(header_line, 1), 1}, why);
}

void HeadTable::refuse_with(const std::string& why, const std::vector<std::string>& maps) const {
  refuse(with_maps(why, maps) + columns_in_words());
}

HeadTable table_of(const std::vector<HeadLine>& head, char separator, const std::string& file) {
  HeadTable table;
  table.file = file;
  for (const HeadLine& line : head) table.rows.push_back(fields_of(line, separator, file));
  const std::size_t n = table.rows.front().size();
  if (is_header(table.rows.front())) {
    table.header_line = head.front().line;
    table.names = table.rows.front();
    table.rows.erase(table.rows.begin());
  } else {
    table.names.resize(n);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (table.names[i].empty()) table.names[i] = "column " + std::to_string(i + 1);
  }
  check_names(table);
  // What isn't a row of this table is told when it is read.
  const auto is_other = [&](const auto& row) { return row.size() != n; };
  if (table.header_line > 0 && !table.rows.empty() && std::ranges::all_of(table.rows, is_other)) {
    throw Error(ErrorCode::input, {file, head[1].line, 1},
                "expected " + counted(n, "field") + ", got " + std::to_string(table.rows.front().size()));
  }
  if (table.header_line > 0) std::erase_if(table.rows, is_other);
  for (auto& row : table.rows) row.resize(n);
  return table;
}

}  // namespace pirsim::io
