// Runs as the log of a smart home, in the form of CASAS' datasets.
#pragma once

#include <iosfwd>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "pirsim/sample.hpp"

namespace pirsim::io {

/// `date time sensor ON|OFF` or `date time door_<id> OPEN|CLOSE`, a line a change, at the end of the row that shows it;
/// a run begins with every sensor off and every door shut, and ends so. Where a run has occupants, the first line after
/// somebody begins an activity has `<person>_<activity> begin` behind it, the last one before its end `... end`; a line
/// with two such labels stands twice. What no sensor noticed has no labels, nor have mere movements (walking, sitting
/// down). An activity goes on from one run to the next.
class CasasWriter {
 public:
  CasasWriter(std::ostream& out, std::vector<std::string> sensors, std::vector<std::string> doors)
      : out_(out), sensors_(std::move(sensors)), doors_(std::move(doors)) {}

  /// Of a run, in order of time, with a clock; runs in the order of their dates. Writes what came before.
  void add(std::span<const Sample> rows, std::span<const OccupantRow> occupants);
  /// Writes the rest.
  void finish();

 private:
  struct Line {
    std::size_t row;
    std::string text;
    std::vector<std::string> ends{}, begins{};
  };
  /// Of an activity that lasted to the end of the run.
  struct Open {
    std::string activity;
    Line* last_line = nullptr;  ///< that is labelled as its end, if it doesn't go on
    std::size_t run = 0;        ///< that the line is of, by number of those added
  };

  [[nodiscard]] std::vector<Line> lines_of(std::span<const Sample> rows) const;
  void label(std::span<const Sample> rows, std::span<const OccupantRow> occupants, std::vector<Line>& lines);
  void end(const std::string& person, const Open& what);
  void write(const std::vector<Line>& lines);

  std::ostream& out_;
  std::vector<std::string> sensors_, doors_;
  std::vector<Line> lines_;  ///< of the last run, whose ends depend on the next
  std::size_t n_runs_ = 0;
  std::map<std::string, Open> open_;
};

}  // namespace pirsim::io
