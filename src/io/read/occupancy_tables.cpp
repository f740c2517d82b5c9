#include "io/read/occupancy_tables.hpp"

#include <algorithm>

#include "core/text.hpp"
#include "io/read/yaml_map.hpp"
#include "schema/columns.hpp"
#include "schema/fields.hpp"
#include "schema/limits.hpp"

namespace pirsim::io {

void require_one_run(const CsvTable& table, const TimeColumn& time, RepeatedFaults& faults) {
  for (const std::string_view name :
       {std::string_view("replicate"), std::string_view("trial"), room_column.name, day_column.name}) {
    const auto column = table.column(name);
    if (!column || (name == day_column.name && time.is_clock())) continue;  // a clock goes on from day to day
    for (std::size_t row = 1; row < table.n_rows(); ++row) {
      if (table.text(row, *column) == table.text(0, *column)) continue;
      faults.add("runs", table.where(row, *column),
                 "rows of more than one run: keep those of one " + std::string(name));
      return;
    }
  }
}

std::optional<std::size_t> column_called(const CsvTable& table, std::string_view name, std::string_view other,
                                         Diagnostics& faults) {
  const auto by_name = table.column(name), by_other = table.column(other);
  if (by_name && by_other)
    faults.error(table.header_place(), "columns '" + std::string(name) + "' and '" + std::string(other) +
                                           "' mean the same: give one of them");
  return by_name ? by_name : by_other;
}

PersonColumns::PersonColumns(const CsvTable& table, Diagnostics& faults)
    : id(column_called(table, "person", "id", faults)),
      x(column_called(table, "x_m", "x", faults)),
      z(column_called(table, "z_m", "z", faults)) {
  if (!id) id = table.required_column("person", faults);
}

bool names_somebody(const CsvTable& table, std::size_t row, const PersonColumns& columns, RepeatedFaults& faults) {
  if (!table.text(row, *columns.id).empty()) return true;
  faults.add("nobody", table.where(row, *columns.id), table.names()[*columns.id] + ": expected a name");
  return false;
}

std::optional<Vec2> point_in(const CsvTable& table, std::size_t row, const PersonColumns& columns,
                             Diagnostics& faults) {
  if (!columns.x || !columns.z) return std::nullopt;
  Vec2 point(0.0);
  for (const int i : {0, 1}) {
    const std::size_t column = i == 0 ? *columns.x : *columns.z;
    const auto number = table.number(row, column, faults);
    if (!number || !accepted::on_floor_m.holds(*number)) {
      if (!faults.has_errors())
        faults.error(table.where(row, column),
                     "expected metres, " + accepted::on_floor_m.text() + ", got '" + table.text(row, column) + "'");
      return std::nullopt;
    }
    point[i] = *number;
  }
  return point;
}

namespace {

class CountsReader {
 public:
  CountsReader(const CsvTable& table, CountsSpec& counts, Diagnostics& faults)
      : table_(table), counts_(counts), faults_(faults) {}

  void read() {
    const TimeColumn time(table_, counts_.time, faults_);
    const auto column = find_people();
    if (!time.is_found() || (!column && counts_.areas.empty())) return;
    std::vector<std::size_t> of_areas;
    for (const AreaCountsSpec& area : counts_.areas) {
      if (const auto found = table_.required_column(area.column, faults_)) of_areas.push_back(*found);
    }
    if (of_areas.size() < counts_.areas.size()) return;
    require_one_run(table_, time, repeated_);
    for (std::size_t row = 0; row < table_.n_rows() && counts_.times_s.size() < limits::occupancy_rows; ++row) {
      Diagnostics found;
      const auto seconds = time.seconds(row, found);
      const auto reading = reading_in(row, column, of_areas, found);
      repeated_.add("time or number", found);
      if (seconds && reading) add(*seconds, *reading, time.where(row), table_.where(row, column.value_or(0)));
    }
    if (table_.n_rows() > limits::occupancy_rows)
      faults_.error(table_.header_place(), too_many(limits::occupancy_rows, "readings"));
    repeated_.tell(faults_);
    if (counts_.times_s.empty() && !faults_.has_errors())
      faults_.error(table_.header_place(), "expected at least one reading");
    if (!time.is_clock() || counts_.times_s.empty()) return;
    const RunClock begin{std::llround(counts_.times_s.front())};
    counts_.begin = begin.text(0.0);
    for (double& seconds : counts_.times_s) seconds -= static_cast<double>(begin.begin_s);
  }

 private:
  std::optional<std::size_t> find_people() const {
    if (!counts_.column.empty()) return table_.required_column(counts_.column, faults_);
    for (const char* name : {"people", "count", "occupancy", "Room_Occupancy_Count"}) {
      if (const auto column = table_.column(name)) return column;
    }
    if (!counts_.areas.empty()) return std::nullopt;  // all are in areas
    std::string names;
    for (const std::string& name : table_.names()) names += (names.empty() ? "" : ", ") + name;
    faults_.error(table_.header_place(),
                  "which column tells the number of people? Say `people: COLUMN` in the script; "
                  "there are " +
                      names);
    return std::nullopt;
  }

  /// None where it isn't known.
  std::optional<int> people_in(std::size_t row, std::size_t column, Diagnostics& faults) const {
    const auto number = table_.number(row, column, faults);
    if (!number) return std::nullopt;
    const auto most = static_cast<double>(accepted::people_of_counts.max);
    if (*number == std::floor(*number) && *number >= 0.0 && *number <= most) return static_cast<int>(*number);
    faults.error(table_.where(row, column), "expected a number of people, 0 to " + shortest_number(most) + ", got '" +
                                                table_.text(row, column) + "'");
    return std::nullopt;
  }

  struct ReadCounts {
    int people = 0;
    std::vector<int> of_areas;
    bool operator==(const ReadCounts&) const = default;
  };
  /// None where one of them isn't known.
  std::optional<ReadCounts> reading_in(std::size_t row, const std::optional<std::size_t>& column,
                                       const std::vector<std::size_t>& of_areas, Diagnostics& faults) const {
    ReadCounts read;
    for (const std::size_t area : of_areas) {
      const auto people = people_in(row, area, faults);
      if (!people) return std::nullopt;
      read.of_areas.push_back(*people);
      read.people += *people;
    }
    if (!column) return read;
    const auto people = people_in(row, *column, faults);
    if (!people) return std::nullopt;
    if (*people >= read.people) return ReadCounts{*people, std::move(read.of_areas)};
    faults.error(table_.where(row, *column),
                 std::to_string(read.people) + " people are in areas, but only " + std::to_string(*people) + " in all");
    return std::nullopt;
  }

  void add(double seconds, const ReadCounts& read, const Where& time, const Where& where) {
    const int people = read.people;
    if (!counts_.times_s.empty()) {
      if (seconds == counts_.times_s.back() && read == last_) return;
      if (seconds == counts_.times_s.back()) {
        return repeated_.add("twice", where,
                             people == last_.people ? "other numbers of areas for the same time"
                                                    : "another number for the same time: " + std::to_string(people) +
                                                          " after " + std::to_string(last_.people));
      }
      if (seconds < counts_.times_s.back())
        return repeated_.add("backwards", time, "time runs backwards: this row is earlier than the one before");
    }
    if (counts_.people.empty() || people > most_) most_ = people, counts_.most = where;
    counts_.times_s.push_back(seconds);
    counts_.people.push_back(people);
    for (std::size_t i = 0; i < read.of_areas.size(); ++i) counts_.areas[i].people.push_back(read.of_areas[i]);
    last_ = read;
  }

  const CsvTable& table_;
  CountsSpec& counts_;
  Diagnostics& faults_;
  RepeatedFaults repeated_;
  int most_ = 0;
  ReadCounts last_;
};

}  // namespace

void read_counts(const CsvTable& table, CountsSpec& counts, Diagnostics& faults) {
  CountsReader(table, counts, faults).read();
}

}  // namespace pirsim::io
