// Sums of a study's rows from the bytes of its file, where there is no process that still has the runs.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/summary.hpp"

namespace pirsim::studies {

/// Takes a row file (docs/formats/rows.md) piece by piece, from its header on, and counts each run into a Summary.
/// Needs memory for the counts alone.
class RowTally {
 public:
  /// trials: ids of the study, in order. measured: as Summary takes them.
  RowTally(std::vector<std::string> trials, SummarySpec spec, std::vector<MeasuredCell> measured);

  /// Throws Error(input) where the bytes aren't rows of this study.
  void add(std::string_view bytes);
  /// After the last piece. Throws Error(input) if there was no header, or the last line has no end.
  [[nodiscard]] const Summary& finish();

 private:
  void end_line();
  void take_header();
  void end_run();

  std::vector<std::string> trials_;
  SummarySpec spec_;
  std::vector<MeasuredCell> measured_;
  std::optional<Summary> summary_;  ///< once the header is known
  std::optional<RunCounts> counts_;
  Sample row_;
  std::string replicate_;  ///< of the run whose rows come in; empty before the first
  std::string trial_;
  std::vector<std::string> fields_{1};  ///< of the line so far
  std::size_t n_lines_ = 0;
  enum class Quotes { none, open, closed } quotes_ = Quotes::none;  ///< of the field so far
};

}  // namespace pirsim::studies
