#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/disk/compression.hpp"
#include "files/disk/file.hpp"
#include "files/read/csv_reader.hpp"
#include "files/read/reader_parts.hpp"
#include "files/read/stamps.hpp"
#include "files/read/state_words.hpp"
#include "files/read/yaml.hpp"
#include "model/core/text.hpp"
#include "model/schema/clock.hpp"
#include "model/schema/columns.hpp"
#include "model/schema/fields.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/occupancy.hpp"

// The tables behind an occupancy. Each reader fills what was read of the file, or tells faults with their place in it,
// each kind once.

namespace pirsim::io {
namespace {

/// A study's rows have many runs, and then time begins anew.
void require_one_run(const CsvTable& table, const TimeColumn& time, RepeatedFaults& faults) {
  for (const std::string_view name : {std::string_view("replicate"), std::string_view("trial"), room_column.name,
                                      day_column.name, std::string_view("entity_id")}) {
    const auto column = table.column(name);
    if (!column || (name == day_column.name && time.is_clock())) continue;  // a clock goes on from day to day
    for (std::size_t row = 1; row < table.n_rows(); ++row) {
      if (table.text(row, *column) == table.text(0, *column)) continue;
      faults.add("runs", table.where(row, *column),
                 (name == "entity_id" ? "rows of more than one entity" : "rows of more than one run") +
                     (": keep those of one " + std::string(name)));
      return;
    }
  }
}

/// By either name; both are a fault.
std::optional<std::size_t> column_called(const CsvTable& table, std::string_view name, std::string_view other,
                                         Diagnostics& faults) {
  const auto by_name = table.column(name), by_other = table.column(other);
  if (by_name && by_other)
    faults.error(table.header_place(), "columns '" + std::string(name) + "' and '" + std::string(other) +
                                           "' mean the same: give one of them");
  return by_name ? by_name : by_other;
}

/// Columns of a person, and of where they are on the floor, if the table has them.
struct PersonColumns {
  PersonColumns(const CsvTable& table, Diagnostics& faults)
      : id(column_called(table, "person", "id", faults)),
        x(column_called(table, "x_m", "x", faults)),
        z(column_called(table, "z_m", "z", faults)) {
    if (!id) id = table.required_column("person", faults);
  }
  std::optional<std::size_t> id, x, z;
};

/// False, which is told, for a row of nobody.
bool names_somebody(const CsvTable& table, std::size_t row, const PersonColumns& columns, RepeatedFaults& faults) {
  if (!table.text(row, *columns.id).empty()) return true;
  faults.add("nobody", table.where(row, *columns.id), table.names()[*columns.id] + ": expected a name");
  return false;
}

/// None where the table doesn't say, and after a fault, which is told.
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

/// Data whose first moment is a clock's count from there.
template <typename Shift>
std::string begin_of(const TimeColumn& time, double first_s, const Shift& shift) {
  if (!time.is_clock()) return {};
  const RunClock begin{static_cast<std::int64_t>(std::floor(first_s))};
  shift(-static_cast<double>(begin.begin_s));
  return begin.text(0.0);
}

/// Numbers of people at moments.
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
    if (counts_.times_s.empty()) return;
    counts_.begin = begin_of(time, counts_.times_s.front(), [&](double by_s) {
      for (double& seconds : counts_.times_s) seconds += by_s;
    });
  }

 private:
  std::optional<std::size_t> find_people() const {
    if (!counts_.column.empty()) return table_.required_column(counts_.column, faults_);
    for (const char* name : {"people", "count", "occupancy", "Room_Occupancy_Count", "state"}) {
      if (const auto column = table_.column(name)) return column;
    }
    if (!counts_.areas.empty()) return std::nullopt;  // all are in areas
    faults_.error(table_.header_place(),
                  "which column tells the number of people? Say `people: COLUMN` in the script; there are " +
                      joined(table_.names(), ", "));
    return std::nullopt;
  }

  /// None where it isn't known.
  std::optional<int> people_in(std::size_t row, std::size_t column, Diagnostics& faults) const {
    if (std::ranges::find(unknown_words, small_letters(table_.text(row, column))) != unknown_words.end())
      return std::nullopt;
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

/// Rows as `--occupants` writes them, to stays.
class PlacesReader {
 public:
  PlacesReader(const CsvTable& table, PlacesSpec& places, Diagnostics& faults)
      : table_(table), places_(places), faults_(faults), columns_(table, faults) {}

  void read() {
    const TimeColumn time(table_, {}, faults_);
    seat_ = table_.column("seat") ? table_.column("seat") : table_.required_column("place", faults_);
    activity_ = table_.column("activity");
    require_one_run(table_, time, repeated_);
    if (!time.is_found() || !seat_ || !columns_.id) return repeated_.tell(faults_);
    if (table_.n_rows() > limits::occupancy_rows)
      return faults_.error(table_.header_place(), too_many(limits::occupancy_rows, "rows"));
    for (std::size_t row = 0; row < table_.n_rows(); ++row) {
      Diagnostics found;
      const auto seconds = time.seconds(row, found);
      const auto point = point_in(table_, row, columns_, found);
      repeated_.add("time or place", found);
      if (seconds) add_row({*seconds, row, point}, time.where(row));
    }
    repeated_.tell(faults_);
    if (rows_.empty() && !faults_.has_errors()) faults_.error(table_.header_place(), "expected at least one row");
    if (faults_.has_errors()) return;
    for (const auto& [person, rows] : rows_) add_stays(person, rows);
    places_.begin = begin_of(time, first_s_, [&](double by_s) {
      for (StaySpec& stay : places_.stays) stay.from_s += by_s, stay.to_s += by_s;
    });
  }

 private:
  struct Row {
    double seconds;
    std::size_t row;
    std::optional<Vec2> point;
  };

  void add_row(const Row& row, const Where& where) {
    if (has_rows_ && row.seconds < last_s_)
      return repeated_.add("backwards", where, "time runs backwards: this row is earlier than the one before");
    if (has_rows_ && row.seconds > last_s_) step_s_ = std::min(step_s_, row.seconds - last_s_);
    if (!has_rows_) first_s_ = row.seconds;
    has_rows_ = true;
    last_s_ = row.seconds;
    if (!names_somebody(table_, row.row, columns_, repeated_)) return;
    const std::string& person = table_.text(row.row, *columns_.id);
    std::vector<Row>& own = rows_[person];
    if (!own.empty() && own.back().seconds == row.seconds)
      return repeated_.add("twice", where,
                           "'" + person + "' has another row of this time: nobody is in two places at once");
    own.push_back(row);
  }

  [[nodiscard]] const std::string& seat_of(const Row& row) const { return table_.text(row.row, *seat_); }
  /// Off the seat, or on the way off it.
  [[nodiscard]] bool is_up(const Row& row) const {
    constexpr std::array<std::string_view, 4> up{"rising", "turning", "standing", "walking"};
    return activity_ && std::ranges::find(up, table_.text(row.row, *activity_)) != up.end();
  }

  void add_stays(const std::string& person, const std::vector<Row>& rows) {
    for (std::size_t begin = 0; begin < rows.size();) {
      std::size_t end = begin + 1;
      const bool rests = is_at_rest(rows, begin);
      const auto goes_on = [&](std::size_t i) {
        return follows(rows, i) && seat_of(rows[i]) == seat_of(rows[begin]) &&
               (!seat_of(rows[begin]).empty() || is_at_rest(rows, i) == rests);
      };
      while (end < rows.size() && goes_on(end)) ++end;
      StaySpec stay;
      stay.person = person;
      stay.seat = seat_of(rows[begin]);
      std::size_t last = end - 1;
      while (!stay.seat.empty() && last > begin && is_up(rows[last])) --last;
      // What a row tells has begun since the row before.
      stay.from_s = rows[begin].seconds - (std::isfinite(step_s_) ? step_s_ : 0.0);
      stay.to_s = rows[last].seconds;
      if (rows[begin].point && rows[last].point) stay.points = {*rows[begin].point, *rows[last].point};
      stay.then = end < rows.size() && follows(rows, end) ? AfterStay::goes_on : AfterStay::leaves;
      stay.where = table_.where(rows[begin].row, *seat_);
      places_.stays.push_back(std::move(stay));
      begin = end;
    }
  }
  /// Is the row of the same visit as the one before?
  [[nodiscard]] bool follows(const std::vector<Row>& rows, std::size_t i) const {
    return rows[i].seconds - rows[i - 1].seconds < 1.5 * step_s_;
  }
  /// On foot, and in the same place as in the next rows or in the ones before.
  [[nodiscard]] bool is_at_rest(const std::vector<Row>& rows, std::size_t i) const {
    constexpr double still_m = 0.02;
    constexpr std::size_t still_rows = 3;  // assumed: less is a halt on the way (2-5)
    const auto still = [&](std::size_t from) {
      if (from + still_rows > rows.size()) return false;
      for (std::size_t k = from; k < from + still_rows; ++k) {
        if (!rows[k].point || !seat_of(rows[k]).empty() || (k > from && !follows(rows, k))) return false;
        if (glm::distance(*rows[k].point, *rows[from].point) > still_m) return false;
      }
      return true;
    };
    for (std::size_t back = 0; back < still_rows && back <= i; ++back) {
      if (still(i - back)) return true;
    }
    return false;
  }

  const CsvTable& table_;
  PlacesSpec& places_;
  Diagnostics& faults_;
  RepeatedFaults repeated_;
  PersonColumns columns_;
  std::optional<std::size_t> seat_, activity_;
  std::map<std::string, std::vector<Row>> rows_;
  bool has_rows_ = false;
  double first_s_ = 0.0, last_s_ = 0.0;
  double step_s_ = std::numeric_limits<double>::infinity();
};

/// Rows of tracked people.
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

template <typename Part>
void read_table(const std::string& file, const detail::FilesBeside& beside, const Where& where,
                std::vector<InputFile>& files, Diagnostics& faults, Part& part) {
  const NamedFile named = beside.find(file, DataKind::measured);
  if (!named.fault.empty()) return faults.error(where, "occupancy: " + named.fault);
  try {
    Input input = read_input(named.path);
    files.push_back(input.file());
    const CsvTable table = CsvTable::parse(decompressed(std::move(input), max_text_file_bytes), named.path.string());
    if constexpr (std::same_as<Part, CountsSpec>) CountsReader(table, part, faults).read();
    if constexpr (std::same_as<Part, PlacesSpec>) PlacesReader(table, part, faults).read();
    if constexpr (std::same_as<Part, PositionsSpec>) PositionsReader(table, part, faults).read();
  } catch (const Error& fault) {
    for (const Issue& issue : fault.issues()) faults.error(issue.where, issue.message);
  }
}

/// `areas: {kitchen: people_kitchen}`; their numbers come with the table.
void read_areas(YamlMap& map, CountsSpec& counts) {
  const auto node = map.child("areas");
  if (!node) return;
  const std::vector<YamlKey> keys = node->keys();
  const std::vector<YamlNode> columns = node->items();
  if (keys.empty())
    map.faults().error(node->where(), map.label("areas") + ": expected each area's column, {kitchen: people_kitchen}");
  for (std::size_t i = 0; i < keys.size(); ++i)
    counts.areas.push_back({keys[i].name, columns[i].text(map.faults(), map.label("areas") + '.' + keys[i].name), {}});
}

}  // namespace

namespace detail {

std::optional<OccupancySpec> OccupancyReader::read(const std::optional<YamlNode>& node, const std::string& begin,
                                                   Diagnostics& faults) {
  if (!node) return std::nullopt;
  Diagnostics found;
  YamlMap map(*node, found, "occupancy");
  OccupancySpec spec;
  spec.where = node->where();
  read_fields(map, spec);
  const auto file_of = [&](const std::string& key, auto& part, const auto& also) {
    if (!map.child(key)) return;
    part.emplace().file = map.required_text(key);
    also();
    read_table(part->file, beside_, map.where(key), files_, found, *part);
  };
  file_of("counts", spec.counts, [&] {
    spec.counts->time = map.text("time");
    spec.counts->column = map.text("people");
    read_areas(map, *spec.counts);
  });
  file_of("places", spec.places, [] {});
  file_of("positions", spec.positions, [] {});
  map.finish();
  if (!found.has_errors()) {
    check_together(spec, begin, [&](std::string_view field, const std::string& message) {
      if (field.ends_with("_h")) field.remove_suffix(2);
      found.error(map.where(std::string(field)), "occupancy: " + message);
    });
  }
  for (const Issue& issue : found.issues()) faults.error(issue.where, issue.message);
  return spec;
}

}  // namespace detail
}  // namespace pirsim::io
