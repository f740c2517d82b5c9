// A reference table on disk: a folder with the key of what it depends on and chunks of finished worlds. Private to
// reconcile.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pirsim/reconcile/reference_table.hpp"

namespace pirsim::reconcile {

/// Datasets of some worlds that follow each other.
struct TableChunk {
  std::vector<TableRow> rows;
  stats::Matrix<float> statistics;
  std::uint32_t n_left_out = 0;
};

class TableStore {
 public:
  /// An empty folder name keeps nothing. Throws Error(input) if the folder holds a table with another key.
  TableStore(std::filesystem::path folder, const std::string& key);
  /// None if the chunk isn't there. Throws Error(input) if it is damaged.
  [[nodiscard]] std::optional<TableChunk> find(std::uint32_t number) const;
  void keep(std::uint32_t number, const TableChunk& chunk) const;

 private:
  [[nodiscard]] std::filesystem::path file(std::uint32_t number) const;
  std::filesystem::path folder_;
};

}  // namespace pirsim::reconcile
