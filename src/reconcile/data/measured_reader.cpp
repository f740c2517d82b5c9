#include "reconcile/data/measured_reader.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "core/digest.hpp"
#include "core/text.hpp"
#include "pirsim/csv.hpp"
#include "reconcile/data/measured_log.hpp"
#include "schema/columns.hpp"
#include "schema/limits.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::size_t fewest_rows = 30;  ///< of the main parts together
constexpr double most_missing_rows = 3600.0;
constexpr std::size_t fewest_cells = 5;  ///< of sums

std::string plural(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// Those that a run's rows, or a dataset's, may have beside the sensors'.
std::vector<ColumnInfo> row_columns() {
  std::vector<ColumnInfo> columns;
  const auto add = [&](const auto& column) {
    const bool known = std::ranges::find(columns, column.name, &ColumnInfo::name) != columns.end();
    if (column.each == nullptr && !known) columns.push_back(column);
  };
  std::ranges::for_each(columns_of<Sample>(), add);
  std::ranges::for_each(columns_of<DayLine>(), add);
  return columns;
}

}  // namespace

MeasuredReader::MeasuredReader(std::string_view text, const std::string& file, const StudyFrame& frame)
    : frame_(frame.of_whole_runs()), asked_(frame), file_(file), table_(io::CsvTable::parse(text, file)) {
  measured_.file = file;
  measured_.digest = sha256(text);
}

Measured MeasuredReader::read() {
  replicate_ = table_.column("replicate");
  if (!replicate_) replicate_ = table_.column("day");  // each day of a dataset is a run of its script
  phase_ = table_.column("phase");
  time_ = table_.column("time_s");
  const bool has_sums = table_.column("sensor").has_value();
  columns_ = has_sums ? std::vector<ColumnInfo>(sum_columns().begin(), sum_columns().end()) : row_columns();
  trial_ = column_of("trial");
  if (!trial_ && frame_.trials.size() > 1) {
    static_cast<void>(table_.required_column("trial", faults_));
    faults_.throw_if_errors();
  }
  if (has_sums) {
    read_sums();
  } else {
    read_rows();
  }
  repeated_.tell(faults_);
  faults_.throw_if_errors();
  if (asked_.units.empty()) number_runs();
  refuse_too_little();
  measured_.runs = in_units(asked_, std::move(measured_.runs));
  return std::move(measured_);
}

std::optional<std::size_t> MeasuredReader::find(const std::vector<std::string>& names, const std::string& what,
                                                std::size_t row, std::size_t column) {
  const std::string& name = table_.text(row, column);
  const auto known = std::ranges::find(names, name);
  if (known != names.end()) return static_cast<std::size_t>(known - names.begin());
  if (unknown_names_.insert(name).second)  // each is told once
    faults_.error(table_.where(row, column), what + " '" + name + "' is not in the study" + near_or_all(name, names));
  return std::nullopt;
}

std::optional<std::size_t> MeasuredReader::trial_of(std::size_t row) {
  if (!trial_) return 0;
  return find(frame_.trials, "trial", row, *trial_);
}

int MeasuredReader::replicate_of(std::size_t row) {
  if (!replicate_) return 1;
  Diagnostics found;
  const int replicate = table_.integer(row, *replicate_, found).value_or(1);
  repeated_.add("replicate", found);
  return replicate;
}

std::optional<double> MeasuredReader::number(std::size_t row, std::size_t column) {
  Diagnostics found;
  const std::optional<double> value = table_.number(row, column, found);
  repeated_.add("number " + std::to_string(column), found);
  return value;
}

/// Before anything is made of them: each is simulated as often as there are datasets in the reference table.
void MeasuredReader::refuse_too_many(const RunKey& run, std::size_t row) {
  std::set<int>& replicates = replicates_[run.first];
  replicates.insert(run.second);
  if (replicates.size() <= limits::measured_replicates) return;
  throw Error(ErrorCode::input, table_.where(row, *replicate_),
              "more than " + std::to_string(limits::measured_replicates) + " replicates of trial '" +
                  frame_.trials[run.first] + "': measured data can't have more");
}

void MeasuredReader::read_sums() {
  measured_.kind = Measured::Kind::sums;
  const std::size_t sensor = *table_.column("sensor");
  std::optional<std::size_t> seconds = column_of("seconds");
  if (!seconds) seconds = table_.required_column("seconds", faults_);
  // A missing column that is misspelt would be told a second time, as unknown.
  faults_.throw_if_errors();
  refuse_unknown_columns({});
  faults_.throw_if_errors();
  std::set<std::pair<RunKey, std::size_t>> seen;
  std::size_t missing = 0;
  for (std::size_t row = 0; row < table_.n_rows(); ++row) {
    const auto trial = trial_of(row);
    const auto which = find(frame_.sensors, "sensor", row, sensor);
    const int replicate = replicate_of(row);
    const auto value = number(row, *seconds);
    if (!trial || !which) continue;
    refuse_too_many({*trial, replicate}, row);
    if (!seen.insert({{*trial, replicate}, *which}).second)
      repeated_.add("twice", table_.where(row, sensor), "this trial and sensor appear twice");
    if (value && *value < 0.0)
      repeated_.add("negative", table_.where(row, *seconds), "seconds with motion can't be negative");
    if (!value) {
      ++missing;
      continue;
    }
    measured_.sums.push_back({*trial, *which, replicate, *value});
  }
  if (missing > 0) {
    measured_.notes.push_back({DataNote::What::sums_empty, missing});
  }
  std::set<std::pair<std::size_t, std::size_t>> cells;
  std::set<std::size_t> trials;
  for (const auto& [run, which] : seen) {
    cells.insert({run.first, which});
    trials.insert(run.first);
  }
  const std::size_t absent = trials.size() * frame_.sensors.size() - cells.size();
  if (absent > 0) {
    measured_.notes.push_back({DataNote::What::cells_absent, absent});
  }
}

std::vector<std::optional<std::size_t>> MeasuredReader::sensor_columns() {
  std::vector<std::optional<std::size_t>> columns;
  std::vector<std::string> absent;
  for (const std::string& sensor : frame_.sensors) {
    columns.push_back(table_.column(sensor));
    if (!columns.back()) absent.push_back(sensor);
  }
  if (absent.size() == frame_.sensors.size()) {
    faults_.error({file_, 1, 1}, "none of the columns is a sensor of the scene (" + joined(frame_.sensors, ", ") +
                                     "): is this the data of another scene?");
  } else if (!absent.empty()) {
    measured_.notes.push_back({DataNote::What::sensors_absent, absent.size(), absent});
  }
  return columns;
}

/// By its name or its alias. The columns of the table are known by then.
std::optional<std::size_t> MeasuredReader::column_of(std::string_view name) {
  const ColumnInfo& column = *std::ranges::find(columns_, name, &ColumnInfo::name);
  const auto named = table_.column(column.name), by_alias = table_.column(column.alias);
  if (named && by_alias) {
    faults_.error({file_, 1, 1}, "columns '" + std::string(column.name) + "' and '" + std::string(column.alias) +
                                     "' mean the same: give one of them");
  }
  return named ? named : by_alias;
}

void MeasuredReader::refuse_unknown_columns(const std::vector<std::string>& sensors) {
  std::vector<std::string> known;
  for (const ColumnInfo& column : columns_) {
    known.emplace_back(column.name);
    if (!column.alias.empty()) known.emplace_back(column.alias);
  }
  known.insert(known.end(), sensors.begin(), sensors.end());
  for (const std::string& name : table_.names()) {
    if (std::ranges::find(known, name) != known.end() || owner_of(name) != Each::sensor) continue;
    faults_.error({file_, 1, 1}, "unknown column '" + name + "'" + near_or_all(name, known));
  }
}

void MeasuredReader::read_rows() {
  if (!time_) static_cast<void>(table_.required_column("time_s", faults_));
  const auto columns = sensor_columns();
  if (!faults_.has_errors()) refuse_unknown_columns(frame_.sensors);
  faults_.throw_if_errors();

  local_time_ = table_.column("time");
  people_ = table_.column("people");
  counted_.assign(asked_.units.of_row.size(), -1);
  std::map<RunKey, std::vector<Row>> runs;
  for (std::size_t row = 0; row < table_.n_rows(); ++row) {
    const auto place = asked_.units.empty() ? place_of(row) : place_in_days(row);
    if (!place) continue;
    const auto& [run, time_s] = *place;
    refuse_too_many(run, row);
    runs[run].push_back({row, time_s});
    note_people(row, run, time_s);
  }
  repeated_.tell(faults_);
  faults_.throw_if_errors();
  for (auto& [key, rows] : runs) add_run(key, std::move(rows), columns);
  if (people_) reconcile::note_people(asked_, counted_, LogMap::People::count, measured_.notes);
  if (outside_ > 0) measured_.notes.push_back({DataNote::What::days_absent, outside_});
  measured_.tells_phases = phase_.has_value();
  if (!phase_ && !frame_.counted_phases.empty()) {
    measured_.notes.push_back({DataNote::What::phases_unknown, frame_.counted_phases.size(), frame_.counted_phases});
  }
  if (inserted_rows_ > 0) {
    measured_.notes.push_back({DataNote::What::rows_missing, inserted_rows_});
  }
  if (unknown_bits_ > 0) {
    measured_.notes.push_back({DataNote::What::readings_empty, unknown_bits_});
  }
  if (unread_runs_ > 0) {
    measured_.notes.push_back({DataNote::What::runs_unread, unread_runs_, frame_.counted_phases});
  }
}

std::optional<std::pair<MeasuredReader::RunKey, double>> MeasuredReader::place_of(std::size_t row) {
  const auto trial = trial_of(row);
  const auto time = number(row, *time_);
  if (!time && table_.text(row, *time_).empty())
    repeated_.add("no time", table_.where(row, *time_), "time_s: expected a number");
  if (!trial || !time) return std::nullopt;
  return std::pair{RunKey{*trial, replicate_of(row)}, *time};
}

/// By its local time if it has one, or else by its number and second.
std::optional<std::pair<MeasuredReader::RunKey, double>> MeasuredReader::place_in_days(std::size_t row) {
  const Units& units = asked_.units;
  const auto lasts_s = static_cast<double>(units.n_rows) * frame_.window_s;
  if (!local_time_ || units.begins_s.empty()) {
    auto place = place_of(row);
    if (!place) return std::nullopt;
    const int day = place->first.second;
    if (day < 1 || day > asked_.n_days()) {
      repeated_.add("day", replicate_ ? table_.where(row, *replicate_) : Where{file_, 1, 1},
                    "run " + std::to_string(day) + ", but the script's occupancy has " +
                        plural(units.n_days, "day", "days") + ": a column 'time' tells which day a row is of");
      return std::nullopt;
    }
    if (place->second > lasts_s + 0.5 * frame_.window_s) return ++outside_, std::nullopt;
    return place;
  }
  const std::optional<RunClock> clock = clock_from(table_.text(row, *local_time_));
  if (!clock) {
    repeated_.add("local time", table_.where(row, *local_time_), "time: expected a local time, 2026-03-02T07:00:30");
    return std::nullopt;
  }
  for (std::size_t day = 0; day < units.n_days; ++day) {
    const auto time_s = static_cast<double>(clock->begin_s - units.begins_s[day]);
    if (time_s <= 0.0 || time_s > lasts_s) continue;
    const double windows = time_s / frame_.window_s;
    if (std::abs(windows - std::round(windows)) > 1e-3) {
      repeated_.add("grid", table_.where(row, *local_time_),
                    "this row ends within a window of the script, whose run begins at " +
                        RunClock{units.begins_s[day]}.text(0.0) +
                        ": give the log itself, or a script whose from or "
                        "begin lies on the rows' grid");
      return std::nullopt;
    }
    return std::pair{RunKey{0, static_cast<int>(day) + 1}, time_s};
  }
  ++outside_;
  return std::nullopt;
}

void MeasuredReader::note_people(std::size_t row, const RunKey& run, double time_s) {
  if (!people_ || asked_.units.empty()) return;
  Diagnostics found;
  const std::optional<int> people = table_.integer(row, *people_, found);
  repeated_.add("people", found);
  const std::size_t place = first_place(time_s);
  if (people && place < asked_.units.n_rows)
    counted_[static_cast<std::size_t>(run.second - 1) * asked_.units.n_rows + place] = *people;
}

bool MeasuredReader::check_times(const std::vector<Row>& rows) {
  std::map<double, std::size_t> steps;  // how often rows are so far apart
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double step = rows[i].time_s - rows[i - 1].time_s;
    if (step <= 0.0) {
      repeated_.add(
          "order", table_.where(rows[i].line, *time_),
          "time_s doesn't grow: " + io::csv_number(rows[i].time_s) + " after " + io::csv_number(rows[i - 1].time_s));
      return false;
    }
    ++steps[std::round(step * 1e6) / 1e6];
  }
  const double first_s = rows.front().time_s;
  if (frame_.counted_phases.empty() && !(first_s >= 0.0 && first_s <= most_missing_rows * frame_.window_s)) {
    repeated_.add("begin", table_.where(rows.front().line, *time_),
                  "time_s counts from the beginning of the trial; this one " + std::string("begins with ") +
                      io::csv_number(rows.front().time_s));
    return false;
  }
  if (steps.empty()) return true;
  const auto usual = std::ranges::max_element(steps, {}, &std::pair<const double, std::size_t>::second);
  if (std::abs(usual->first - frame_.window_s) > 1e-6 * frame_.window_s) {
    repeated_.add("window", table_.where(rows.front().line, *time_),
                  "rows are " + io::csv_number(usual->first) + " s apart, the script's window is " +
                      io::csv_number(frame_.window_s) + " s");
    return false;
  }
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double windows = (rows[i].time_s - rows[i - 1].time_s) / frame_.window_s;
    if (windows > most_missing_rows) {
      repeated_.add(
          "gap", table_.where(rows[i].line, *time_),
          "this row comes " + io::csv_number(std::round(windows)) + " windows after the one before: too long a gap");
      return false;
    }
    if (std::abs(windows - std::round(windows)) < 1e-3) continue;
    repeated_.add("off", table_.where(rows[i].line, *time_),
                  "this row isn't a whole number of windows after the one before");
    return false;
  }
  return true;
}

std::vector<std::uint8_t> MeasuredReader::bits_of(std::size_t row,
                                                  const std::vector<std::optional<std::size_t>>& columns) {
  std::vector<std::uint8_t> bits;
  for (const auto& column : columns) {
    bits.push_back(unknown_bit);
    if (!column) continue;
    const std::string& text = table_.text(row, *column);
    if (text == "0" || text == "0.0") {  // with the point, as tables are written that had a missing value once
      bits.back() = 0;
    } else if (text == "1" || text == "1.0") {
      bits.back() = 1;
    } else if (text.empty()) {
      ++unknown_bits_;
    } else {
      repeated_.add("bit", table_.where(row, *column),
                    table_.names()[*column] + ": expected 0 or 1, got '" + text + "'");
    }
  }
  return bits;
}

void MeasuredReader::mark_main(Series& series, const std::vector<Row>& rows, const std::vector<std::size_t>& places) {
  const std::size_t n_rows = places.back() + 1;
  series.main_end = n_rows;
  if (!phase_ || frame_.counted_phases.empty()) return;
  bool begun = false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string& phase = table_.text(rows[i].line, *phase_);
    if (std::ranges::find(frame_.counted_phases, phase) == frame_.counted_phases.end()) continue;
    if (!begun) series.main_begin = places[i];
    begun = true;
    series.main_end = places[i] + 1;
  }
  if (!begun) series.main_end = 0;
}

/// Where the first row lies in its run. If phases are counted, they tell where the main part begins, not the clock.
std::size_t MeasuredReader::first_place(double time_s) const {
  if (!frame_.counted_phases.empty()) return 0;
  return static_cast<std::size_t>(std::max(0L, std::lround(time_s / frame_.window_s) - 1));
}

/// Before gaps are filled, which a small file may have many of.
void MeasuredReader::refuse_too_long(const std::vector<Row>& rows) {
  const double lasts_s = rows.back().time_s - rows.front().time_s;
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::input, table_.where(rows.back().line, *time_), why);
  };
  if (lasts_s > limits::measured_run_s) {
    refuse("this run lasts " + fixed(lasts_s, 0) + " s; a simulated one lasts " + fixed(limits::measured_run_s, 0) +
           " s at most");
  }
  filled_rows_ += 1 + first_place(rows.front().time_s) + static_cast<std::size_t>(lasts_s / frame_.window_s);
  if (filled_rows_ > limits::measured_rows)
    refuse("up to here the data have more than " + std::to_string(limits::measured_rows) + " rows, gaps included");
}

void MeasuredReader::add_run(RunKey key, std::vector<Row> rows,
                             const std::vector<std::optional<std::size_t>>& columns) {
  if (!check_times(rows)) return;
  refuse_too_long(rows);
  Series series{key.first, key.second, 0, 0, {}};
  std::vector<std::size_t> places;  // of the rows, gaps counted
  const std::size_t first = first_place(rows.front().time_s);
  for (const Row& row : rows) {
    const double windows = (row.time_s - rows.front().time_s) / frame_.window_s;
    const std::size_t place = first + static_cast<std::size_t>(std::lround(windows));
    while (series.bits.size() < place * frame_.sensors.size()) {
      series.bits.insert(series.bits.end(), frame_.sensors.size(), unknown_bit);
      ++inserted_rows_;
    }
    const auto bits = bits_of(row.line, columns);
    series.bits.insert(series.bits.end(), bits.begin(), bits.end());
    places.push_back(place);
  }
  mark_main(series, rows, places);
  const auto main = std::span(series.bits)
                        .subspan(series.main_begin * frame_.sensors.size(),
                                 (series.main_end - series.main_begin) * frame_.sensors.size());
  if (std::ranges::all_of(main, [](std::uint8_t bit) { return bit == unknown_bit; })) {
    ++unread_runs_;
    return;
  }
  measured_.runs.push_back(std::move(series));
}

/// From 1 in every trial, as simulated runs are: numbers may begin anywhere and have gaps.
void MeasuredReader::number_runs() {
  std::map<std::size_t, std::set<int>> known;  // of a trial
  for (const Series& run : measured_.runs) known[run.trial].insert(run.replicate);
  for (const Measured::Sum& sum : measured_.sums) known[sum.trial].insert(sum.replicate);
  std::map<RunKey, int> ranks;
  for (const auto& [trial, numbers] : known) {
    int rank = 0;
    for (const int number : numbers) ranks[{trial, number}] = ++rank;
  }
  const auto rank = [&](std::size_t trial, int replicate) { return ranks.at({trial, replicate}); };
  for (Series& run : measured_.runs) run.replicate = rank(run.trial, run.replicate);
  for (Measured::Sum& sum : measured_.sums) sum.replicate = rank(sum.trial, sum.replicate);
}

void MeasuredReader::refuse_too_little() {
  if (measured_.kind == Measured::Kind::sums) {
    if (measured_.sums.size() >= fewest_cells) return;
    throw Error(ErrorCode::input, {file_, 0, 0},
                "too little data: " + plural(measured_.sums.size(), "sum", "sums") + ", needed are " +
                    std::to_string(fewest_cells));
  }
  std::size_t known = 0;
  for (const Series& run : measured_.runs) {
    const std::size_t n = frame_.sensors.size();
    for (std::size_t row = run.main_begin; row < run.main_end; ++row) {
      const auto first = run.bits.begin() + static_cast<std::ptrdiff_t>(row * n);
      known +=
          std::any_of(first, first + static_cast<std::ptrdiff_t>(n), [](auto b) { return b != unknown_bit; }) ? 1 : 0;
    }
  }
  if (known >= fewest_rows) return;
  throw Error(
      ErrorCode::input, {file_, 0, 0},
      "too little data: " + plural(known, "row", "rows") + " to compare, needed are " + std::to_string(fewest_rows));
}

}  // namespace pirsim::reconcile
