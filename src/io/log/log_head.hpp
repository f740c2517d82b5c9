// The first lines of a log as a table. Private to io.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/log/log_words.hpp"

namespace pirsim::io {

struct HeadLine {
  std::string text;
  int line = 0;
};

/// Every row has as many fields as the first line, the missing ones being empty; spaces around fields are left out.
struct HeadTable {
  std::string file;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> names;  ///< "column 3" where none is told
  int header_line = 0;             ///< 0: the first line is a row

  [[nodiscard]] std::size_t n_columns() const { return names.size(); }
  /// Of the rows' fields in this column.
  [[nodiscard]] std::size_t count(std::size_t column, const std::function<bool(const std::string&)>& holds) const;
  [[nodiscard]] bool is_mostly(std::size_t column, const std::function<bool(const std::string&)>& holds) const {
    return !rows.empty() && 2 * count(column, holds) >= rows.size();
  }
  [[nodiscard]] NameSays says(std::size_t column) const { return what_name_says(names[column]); }
  [[nodiscard]] std::size_t n_values(std::size_t column) const;  ///< different ones
  /// The column of that name; otherwise refuses.
  [[nodiscard]] std::size_t named(const std::string& name) const;
  /// The columns with their first values, for messages.
  [[nodiscard]] std::string columns_in_words() const;
  // Throw Error(input): with the columns, and with the maps that settle it.
  [[noreturn]] void refuse(const std::string& why) const;
  [[noreturn]] void refuse_with(const std::string& why, const std::vector<std::string>& maps) const;
};

[[nodiscard]] char separator_of(const std::string& line);
/// Throws Error(input).
[[nodiscard]] HeadTable table_of(const std::vector<HeadLine>& head, char separator, const std::string& file);

[[nodiscard]] bool is_number(const std::string& text);

}  // namespace pirsim::io
