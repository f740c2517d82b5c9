// Objects of JSON as rows of a table.
#pragma once

#include <cstddef>
#include <deque>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pirsim::io {

/// The state that a value tells.
[[nodiscard]] std::string state_text(const nlohmann::json& value);
/// As a field of a table.
[[nodiscard]] std::string quoted_field(const std::string& text);

/// Rows are objects that stand in an array, or alone in a line: Home Assistant's history, Node-RED's lines. Nested
/// objects are columns with a point, "payload.occupancy"; the key of an array, as {"binary_sensor.hall": [{...}]}, is
/// the column `name`.
class JsonRows {
 public:
  explicit JsonRows(std::string file) : file_(std::move(file)) {}

  /// The text of one document, or of several, one a line. False: the document goes on in the next line. Throws
  /// Error(input) for what is no table.
  [[nodiscard]] bool add(std::string_view text, int line);
  /// The columns of the rows so far, as a line of a table of tabs; later rows have no others.
  [[nodiscard]] std::string header();
  [[nodiscard]] std::size_t size() const noexcept { return rows_.size(); }
  /// The next row as a line of that table.
  [[nodiscard]] std::string next();

 private:
  using Row = std::vector<std::pair<std::string, std::string>>;  ///< by column
  struct Level {
    bool is_array = false, has_rows = false;
    std::string key{};  ///< of an array: under which it stands; of an object: the last one
    Row names{};        ///< of the sensor, which the first row of an array alone may have
  };
  void take(const nlohmann::json& object);

  std::string file_;
  std::vector<Level> levels_;
  std::deque<Row> rows_;
  std::vector<std::string> columns_;
};

}  // namespace pirsim::io
