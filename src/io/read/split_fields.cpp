#include "io/read/split_fields.hpp"

#include <algorithm>

namespace pirsim::io {
namespace {

bool split_at_spaces(std::string_view line, std::vector<std::string_view>& fields) {
  const std::string_view spaces = " \t";
  while (true) {
    const std::size_t begin = line.find_first_not_of(spaces);
    if (begin == std::string_view::npos) return true;
    const std::size_t end = std::min(line.find_first_of(spaces, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

/// After a quote: what stands in quotes, and the line behind them; false if they aren't closed.
bool take_quoted(std::string_view& line, std::string& text) {
  text.clear();
  while (!line.empty()) {
    const char c = line.front();
    line.remove_prefix(1);
    if (c != '"') {
      text += c;
    } else if (line.starts_with('"')) {
      text += '"';
      line.remove_prefix(1);
    } else {
      return true;
    }
  }
  return false;
}

}  // namespace

bool split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields,
                  std::vector<std::string>& unquoted) {
  fields.clear();
  if (separator == ' ') return split_at_spaces(line, fields);
  std::size_t n_quoted = 0;
  if (const auto quotes = static_cast<std::size_t>(std::ranges::count(line, '"')); unquoted.size() < quotes)
    unquoted.resize(quotes);  // before any field points into it
  while (true) {
    if (line.starts_with('"')) {
      line.remove_prefix(1);
      std::string& text = unquoted[n_quoted++];
      if (!take_quoted(line, text)) return false;
      if (!line.empty() && line.front() != separator) return false;
      fields.emplace_back(text);
    } else {
      const std::size_t end = std::min(line.find(separator), line.size());
      fields.push_back(line.substr(0, end));
      line.remove_prefix(end);
    }
    if (line.empty()) return true;
    line.remove_prefix(1);
  }
}

}  // namespace pirsim::io
