// Rows of runs, or of a dataset's days, one after the other.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/line_reader.hpp"
#include "pirsim/columns.hpp"
#include "pirsim/control.hpp"

namespace pirsim::control {

/// A table that pirsim wrote, compressed or not; measured rows have no people. What a dataset's room doesn't have is
/// empty there, and reads as no motion and nobody. A dataset's room is its row's replicate, the day its trial.
class RowFile {
 public:
  /// Reads the first line. Throws Error: io, input.
  explicit RowFile(const std::filesystem::path& file);

  [[nodiscard]] const ColumnOwners& columns() const noexcept { return owners_; }
  [[nodiscard]] People people() const noexcept { return people_ ? People::known : People::unknown; }
  /// False at the end. Throws Error(input), with line and column.
  [[nodiscard]] bool next(Sample& row);

 private:
  struct Fault;
  [[nodiscard]] bool split();
  template <typename Number>
  [[nodiscard]] Number number(std::size_t column, Number if_empty) const;

  io::LineReader lines_;
  ColumnOwners owners_;
  std::vector<std::string> names_;
  std::vector<std::size_t> sensors_, areas_, doors_;  ///< columns
  std::optional<std::size_t> run_, trial_, time_s_, clock_, people_;
  std::vector<std::string_view> fields_;
  std::vector<std::string> unquoted_;
};

}  // namespace pirsim::control
