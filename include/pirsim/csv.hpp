// Tables as CSV (RFC 4180): comma, LF, quotes only where needed, numbers in their shortest exact form.
#pragma once

#include <algorithm>
#include <array>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/columns.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {

/// A field as CSV writes it: quoted if it holds a comma, a quote or a line break.
[[nodiscard]] std::string csv_field(std::string_view text);
/// Shortest decimal that reads back as the same double: "1", "0.02".
[[nodiscard]] std::string csv_number(double value);

/// Adds it to a line.
void add_csv(std::string& line, const Cell& cell, int decimals);

/// The one writer of tables. The stream outlives it, and tells about write errors by its state.
template <typename Row>
class TableWriter {
 public:
  /// Writes the header line: all columns of this list, none of which is repeated. The list outlives the writer.
  TableWriter(std::ostream& out, std::span<const Column<Row>> columns) : out_(out) {
    for (const Column<Row>& column : columns) add(column, 0, column.name);
    end_line();
  }
  /// The columns of columns_of<Row>() that are called so. A name that none of them has belongs to an area or a door, by
  /// how it begins, or to a sensor: the first such to the first sensor.
  explicit TableWriter(std::ostream& out, const std::vector<std::string>& names = column_names<Row>()) : out_(out) {
    const std::span<const Column<Row>> columns = columns_of<Row>();
    std::array<std::size_t, 3> n_of{};  // by owner
    for (const std::string& name : names) {
      const auto single = std::ranges::find_if(
          columns, [&](const auto& column) { return column.each == nullptr && column.name == name; });
      const Each of = owner_of(name);
      const auto repeated =
          std::ranges::find_if(columns, [&](const auto& column) { return column.each != nullptr && column.of == of; });
      if (single != columns.end()) {
        add(*single, 0, name);
      } else if (repeated != columns.end()) {
        add(*repeated, n_of[static_cast<std::size_t>(of)]++, name);
      } else {
        throw Error(ErrorCode::internal, "the table has no column '" + name + "'");
      }
    }
    end_line();
  }

  void write(const Row& row) {
    line_.clear();
    for (const Field& field : fields_) {
      const Column<Row>& column = *field.column;
      add_csv(line_, column.each == nullptr ? column.value(row) : column.each(row, field.item), column.decimals);
      line_ += ',';
    }
    end_line();
  }

 private:
  struct Field {
    const Column<Row>* column;
    std::size_t item;
  };

  void add(const Column<Row>& column, std::size_t item, std::string_view name) {
    fields_.push_back({&column, item});
    line_ += csv_field(name);
    line_ += ',';
  }
  void end_line() {
    line_.back() = '\n';
    out_ << line_;
  }

  std::ostream& out_;
  std::vector<Field> fields_;
  std::string line_;
};

/// Of a study's rows; takes Model::columns().
using CsvWriter = TableWriter<Sample>;

}  // namespace pirsim::io
