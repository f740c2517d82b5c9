#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/text.hpp"
#include "io/files/compression.hpp"
#include "io/files/input.hpp"
#include "io/read/csv_reader.hpp"
#include "io/read/reader_parts.hpp"
#include "io/read/time_column.hpp"
#include "io/read/yaml_map.hpp"
#include "schema/clock.hpp"
#include "schema/occupancy_runs.hpp"

namespace pirsim::io {
namespace {

/// Of rows of one run: a study's rows have many, and then time begins anew.
void require_one_run(const CsvTable& table, RepeatedFaults& faults) {
  for (const char* name : {"replicate", "trial"}) {
    const auto column = table.column(name);
    if (!column) continue;
    for (std::size_t row = 1; row < table.n_rows(); ++row) {
      if (table.text(row, *column) == table.text(0, *column)) continue;
      faults.add("runs", table.where(row, *column),
                 "rows of more than one run: keep those of one " + std::string(name));
      return;
    }
  }
}

class CountsReader {
 public:
  CountsReader(const CsvTable& table, CountsSpec& counts, Diagnostics& faults)
      : table_(table), counts_(counts), faults_(faults) {}

  void read() {
    const TimeColumn time(table_, counts_.time, faults_);
    const auto column = find_people();
    if (!time.is_found() || !column) return;
    require_one_run(table_, repeated_);
    for (std::size_t row = 0; row < table_.n_rows() && counts_.times_s.size() < limits::occupancy_rows; ++row) {
      Diagnostics found;
      const auto seconds = time.seconds(row, found);
      const auto people = people_in(row, *column, found);
      repeated_.add("time or number", found);
      if (seconds && people) add(*seconds, *people, time.where(row), table_.where(row, *column));
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

  void add(double seconds, int people, const Where& time, const Where& where) {
    if (!counts_.times_s.empty()) {
      if (seconds == counts_.times_s.back() && people == counts_.people.back()) return;
      if (seconds == counts_.times_s.back()) {
        return repeated_.add("twice", where,
                             "another number for the same time: " + std::to_string(people) + " after " +
                                 std::to_string(counts_.people.back()));
      }
      if (seconds < counts_.times_s.back())
        return repeated_.add("backwards", time, "time runs backwards: this row is earlier than the one before");
    }
    if (counts_.people.empty() || people > most_) most_ = people, counts_.most = where;
    counts_.times_s.push_back(seconds);
    counts_.people.push_back(people);
  }

  const CsvTable& table_;
  CountsSpec& counts_;
  Diagnostics& faults_;
  RepeatedFaults repeated_;
  int most_ = 0;
};

/// The table, or none after a fault.
std::optional<CsvTable> read_table(const std::string& file, const std::filesystem::path& folder, const Where& where,
                                   std::vector<InputFile>& files, Diagnostics& faults) {
  const std::filesystem::path path = folder / file;
  std::error_code ignored;
  if (const auto status = std::filesystem::status(path, ignored);
      !std::filesystem::exists(status) || std::filesystem::is_directory(status)) {
    faults.error(where, "occupancy: there is no file '" + path.string() + "'");
    return std::nullopt;
  }
  try {
    Input input = read_input(path);
    files.push_back(input.file());
    return CsvTable::parse(decompressed(std::move(input), max_text_file_bytes), path.string());
  } catch (const Error& fault) {
    for (const Issue& issue : fault.issues()) faults.error(issue.where, issue.message);
  }
  return std::nullopt;
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
  if (map.child("counts")) {
    CountsSpec& counts = spec.counts.emplace();
    counts.file = map.required_text("counts");
    counts.time = map.text("time");
    counts.column = map.text("people");
    if (const auto table = read_table(counts.file, folder_, map.where("counts"), files_, found))
      CountsReader(*table, counts, found).read();
  }
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
