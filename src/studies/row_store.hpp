// Finished rows of a coverage map on disk, so that an interrupted study goes on where it stopped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "studies/coverage.hpp"

namespace pirsim::studies {

/// A number for everything that the counts depend on: rays as cut, squares, poses, sensing, the build.
[[nodiscard]] std::uint64_t fingerprint(const CoverageStudy& study);

/// A text file: a line with the fingerprint, then a line a row of squares with its counts and their checksum.
/// Rows of another study, and everything from the first damaged line on, are thrown away.
class RowStore {
 public:
  /// Opens or begins the file. Throws Error(io).
  RowStore(std::filesystem::path file, const CoverageStudy& study);

  /// Counts of the first rows, as found: (n x n_columns x n_sensors).
  [[nodiscard]] const std::vector<MotionCount>& found() const noexcept { return found_; }
  [[nodiscard]] std::size_t n_found_rows() const noexcept { return n_found_rows_; }
  /// The next row. It is on disk when this returns. Throws Error(io).
  void append(const std::vector<MotionCount>& counts);
  /// The study is complete: the file goes.
  void remove();

 private:
  std::filesystem::path file_;
  std::vector<MotionCount> found_;
  std::size_t n_found_rows_ = 0;
  std::ofstream stream_;
};

}  // namespace pirsim::studies
