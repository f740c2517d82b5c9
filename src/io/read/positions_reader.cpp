#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "io/read/occupancy_tables.hpp"
#include "io/read/yaml_map.hpp"
#include "schema/limits.hpp"

namespace pirsim::io {
namespace {

class PositionsReader {
 public:
  PositionsReader(const CsvTable& table, PositionsSpec& positions, Diagnostics& faults)
      : table_(table), positions_(positions), faults_(faults), columns_(table, faults) {}

  void read() {
    const TimeColumn time(table_, {}, faults_);
    const auto heading = column_called(table_, "heading", "heading_deg", faults_);
    if (!columns_.x) static_cast<void>(table_.required_column("x", faults_));
    if (!columns_.z) static_cast<void>(table_.required_column("z", faults_));
    require_one_run(table_, time, repeated_);
    if (!time.is_found() || !columns_.id || faults_.has_errors()) return repeated_.tell(faults_);
    if (table_.n_rows() > limits::occupancy_rows)
      return faults_.error(table_.header_place(), too_many(limits::occupancy_rows, "rows"));
    double first_s = std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < table_.n_rows(); ++row) {
      Diagnostics found;
      const auto seconds = time.seconds(row, found);
      const auto point = point_in(table_, row, columns_, found);
      const auto facing = heading ? table_.number(row, *heading, found) : std::nullopt;
      if (heading && !facing && !found.has_errors())
        found.error(table_.where(row, *heading), "heading: expected degrees, 0 facing -Z and positive turning left");
      repeated_.add("time, place or heading", found);
      if (!seconds || !point || found.has_errors()) continue;
      first_s = std::min(first_s, *seconds);
      add(row, time.where(row), *seconds, *point, facing);
    }
    repeated_.tell(faults_);
    if (positions_.tracks.empty() && !faults_.has_errors())
      faults_.error(table_.header_place(), "expected at least one row");
    if (faults_.has_errors()) return;
    positions_.begin = begin_of(time, first_s, [&](double by_s) {
      for (TrackSpec& track : positions_.tracks) {
        for (double& seconds : track.times_s) seconds += by_s;
      }
    });
  }

 private:
  void add(std::size_t row, const Where& where, double seconds, const Vec2& point, std::optional<double> heading_deg) {
    const std::string& person = table_.text(row, *columns_.id);
    if (!names_somebody(table_, row, columns_, repeated_)) return;
    const auto [known, is_new] = known_.try_emplace(person, positions_.tracks.size());
    if (is_new) {
      TrackSpec& track = positions_.tracks.emplace_back();
      track.person = person;
      track.where = where;
    }
    TrackSpec& track = positions_.tracks[known->second];
    if (!track.times_s.empty() && seconds <= track.times_s.back()) {
      return repeated_.add("backwards", where,
                           "time runs backwards: this row of '" + person + "' isn't later than the one before");
    }
    track.times_s.push_back(seconds);
    track.points.push_back(point);
    if (heading_deg) track.headings_deg.push_back(*heading_deg);
  }

  const CsvTable& table_;
  PositionsSpec& positions_;
  Diagnostics& faults_;
  RepeatedFaults repeated_;
  PersonColumns columns_;
  std::map<std::string, std::size_t> known_;
};

}  // namespace

void read_positions(const CsvTable& table, PositionsSpec& positions, Diagnostics& faults) {
  PositionsReader(table, positions, faults).read();
}

}  // namespace pirsim::io
