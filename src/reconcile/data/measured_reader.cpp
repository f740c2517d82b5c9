#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include "files/disk/compression.hpp"
#include "files/disk/file.hpp"
#include "files/disk/line_reader.hpp"
#include "files/read/csv_reader.hpp"
#include "files/read/row_reader.hpp"
#include "logs/home_database.hpp"
#include "logs/log_head.hpp"
#include "model/core/random.hpp"
#include "model/core/text.hpp"
#include "model/schema/columns.hpp"
#include "model/schema/limits.hpp"
#include "pirsim/columns.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/log.hpp"
#include "reconcile/data/measured.hpp"

namespace pirsim::reconcile {
namespace {

constexpr double longer_than_window = 1.25;  ///< times may readings be, since clocks of loggers are slow; assumed
constexpr std::size_t fewest_rows = 30;      ///< of the main parts together
constexpr double most_missing_rows = 3600.0;
constexpr std::size_t fewest_cells = 5;  ///< of sums

/// The words of a line, in small letters, cut at what separates fields.
std::vector<std::string> fields_of(std::string_view line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',' || c == ';' || c == '\t') {
      fields.emplace_back();
    } else if (c != '"' && c != ' ') {
      fields.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return fields;
}

/// The log's moment at which a run begins.
std::int64_t moment_of(const Log& log, std::int64_t local_s) {
  constexpr std::int64_t us = 1'000'000;
  for (const LogOffset& offset : log.offsets) {
    const std::int64_t moment = (local_s - offset.offset_s) * us;
    if (log.moment(moment).offset_s == offset.offset_s) return moment;
  }
  return local_s * us;
}

constexpr const char* left_out = ": left out of every comparison.";

std::string told_of_empty(std::size_t n) {
  return counted(n, "reading is", "readings are") + " empty: taken for unknown, in the simulation too.";
}

/// Where each of the study's sensors is among the data's.
struct SensorColumns {
  SensorColumns() = default;
  SensorColumns(const std::vector<std::string>& sensors, const std::vector<std::string>& names) {
    for (const std::string& sensor : sensors) {
      const auto at = std::ranges::find(names, sensor);
      columns.push_back(at == names.end() ? std::nullopt : std::optional<std::size_t>(at - names.begin()));
      if (!columns.back()) absent.push_back(sensor);
    }
  }

  std::vector<std::optional<std::size_t>> columns;  ///< (n_sensors)
  std::vector<std::string> absent;

  /// Adds a note if any is absent.
  void tell(std::vector<std::string>& notes) const {
    if (!absent.empty()) notes.push_back("The file has no column for " + joined(absent, ", ") + left_out);
  }
};

/// What the data's own counts (n_days x n_rows of the frame's parts; -1: not known) say that the script's don't.
void note_people(const StudyFrame& frame, std::span<const std::int32_t> counted, LogMap::People means,
                 std::vector<std::string>& notes) {
  const DayParts& parts = frame.day_parts;
  if (parts.empty()) {
    notes.emplace_back("The column 'people' is left out of every comparison: it is the script that says who is there.");
    return;
  }
  std::size_t n = 0, differ = 0, first = 0;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    if (counted[i] < 0 || parts.people[i] < 0) continue;
    const bool same =
        means == LogMap::People::count ? counted[i] == parts.people[i] : (counted[i] > 0) == (parts.people[i] > 0);
    ++n;
    if (same) continue;
    if (differ++ == 0) first = i;
  }
  if (differ == 0) return;
  const double run_s = static_cast<double>(first % parts.n_rows) * frame.window_s;
  const std::optional<RunClock> clock =
      parts.begins_s.empty() ? std::nullopt : std::optional(RunClock{parts.begins_s[first / parts.n_rows]});
  notes.push_back("The data count other people than the script in " + std::to_string(differ) + " of " +
                  std::to_string(n) + " windows, first " + std::to_string(counted[first]) + " instead of " +
                  std::to_string(parts.people[first]) + " at " + moment_text(clock, run_s) +
                  ". Who is there in the simulation is what the script says.");
}

/// Puts a log's windows into runs.
class LogRuns {
 public:
  LogRuns(const Log& log, const StudyFrame& frame, const std::optional<RunClock>& clock)
      : log_(log), frame_(frame), where_{log.files.empty() ? std::string("log") : log.files.front().path, 0, 0} {
    require_clock(clock);
    require_windows();
    find_sensors();
    if (!frame.day_parts.empty() && !frame.day_parts.begins_s.empty() && log.clock != LogClock::elapsed) {
      for (const std::int64_t day_s : frame.day_parts.begins_s) begins_us_.push_back(moment_of(log, day_s));
    } else {
      begins_us_.push_back(log.clock == LogClock::elapsed ? 0 : moment_of(log, clock->begin_s));
    }
  }

  Measured measured() {
    Measured measured;
    measured.file = where_.file;
    measured.digest = log_.files.empty() ? std::string() : log_.files.front().sha256;
    measured.tells_phases = false;
    const std::size_t n = frame_.sensors.size();
    std::vector<std::int32_t> counted(frame_.day_parts.of_row.size(), log_state::unknown_count);
    for (std::size_t day = 0; day < begins_us_.size(); ++day) {
      Series run{0, static_cast<int>(day) + 1, 0, 0, {}};
      run.bits = bits_of(day, counted);
      run.main_end = run.n_rows(n);
      known_ += static_cast<std::size_t>(std::ranges::count_if(run.bits, [](auto bit) { return bit != unknown_bit; }));
      unknown_ += static_cast<std::size_t>(std::ranges::count(run.bits, unknown_bit));
      measured.runs.push_back(std::move(run));
    }
    require_overlap();
    tell(measured);
    if (log_.people) note_people(frame_, counted, log_.map.people_mean, measured.notes);
    measured.runs = in_day_parts(frame_, std::move(measured.runs));
    return measured;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw Error(ErrorCode::input, where_, why); }

  void require_clock(const std::optional<RunClock>& clock) const {
    if (log_.clock != LogClock::elapsed && !clock)
      refuse("the log has times of day, but the script doesn't say when its run begins: write begin: " +
             to_text(log_.moment(log_.begin_us), LogClock::local).substr(0, 19));
    if (log_.clock == LogClock::elapsed && frame_.n_days() > 1)
      refuse("the log counts seconds, and the script has several days: a log needs times with dates");
    if (frame_.day_parts.empty() && frame_.trials.size() > 1)
      refuse(
          "the log doesn't tell which of the script's trials it is of: give rows with a column 'trial', or a script "
          "with one");
  }

  void require_windows() const {
    const double interval_s = static_cast<double>(log_.interval_us) / 1e6;
    if (interval_s <= longer_than_window * frame_.window_s) return;
    refuse("the log's readings are " + shortest_number(interval_s) + " s apart, the script's windows " +
           shortest_number(frame_.window_s) +
           " s long: write sensing: {window_s: " + shortest_number(std::round(interval_s)) + "}");
  }

  void find_sensors() {
    std::vector<std::string> names;
    for (const LogTrack& track : log_.sensors) names.push_back(track.name);
    sensors_ = {frame_.sensors, names};
    if (sensors_.absent.size() < frame_.sensors.size()) return;
    std::string example = "sensors: {" + frame_.sensors.front() + ": " + names.front() + ", ...}";
    refuse("none of the log's sensors (" + joined(names, ", ") + ") is one of the scene (" +
           joined(frame_.sensors, ", ") + "): say which is which in a map (--map), " + example);
  }

  /// (n_rows x n_sensors) of a day, and its counts.
  std::vector<std::uint8_t> bits_of(std::size_t day, std::vector<std::int32_t>& counted) const {
    const LogWindows windows(log_, frame_.window_s, begins_us_[day]);
    const std::int64_t window_us = std::llround(frame_.window_s * 1e6);
    // Of the first window, counted from the beginning of the run.
    const std::int64_t first = (windows.begin(0).us - begins_us_[day]) / window_us;
    const std::int64_t n_rows = frame_.day_parts.empty()
                                    ? std::max<std::int64_t>(0, first + static_cast<std::int64_t>(windows.size()))
                                    : static_cast<std::int64_t>(frame_.day_parts.n_rows);
    const std::size_t n = frame_.sensors.size();
    std::vector<std::uint8_t> bits(static_cast<std::size_t>(n_rows) * n, unknown_bit);
    const std::int64_t skipped = std::max<std::int64_t>(0, -first);
    if (skipped >= static_cast<std::int64_t>(windows.size())) return bits;
    const LogRows rows = windows.rows(static_cast<std::size_t>(skipped), static_cast<std::size_t>(n_rows));
    const auto at = static_cast<std::size_t>(first + skipped);
    for (std::size_t i = 0; i < rows.n_windows() && at + i < static_cast<std::size_t>(n_rows); ++i) {
      for (std::size_t sensor = 0; sensor < n; ++sensor) {
        if (sensors_.columns[sensor]) bits[(at + i) * n + sensor] = rows.at(i, *sensors_.columns[sensor]);
      }
      if (!rows.people.empty() && !counted.empty()) counted[day * frame_.day_parts.n_rows + at + i] = rows.people[i];
    }
    return bits;
  }

  void require_overlap() const {
    if (known_ > 0) return;
    refuse("nothing of the log lies in the script's runs: it goes from " +
           to_text(log_.moment(log_.begin_us), log_.clock) + " to " + to_text(log_.moment(log_.end_us), log_.clock) +
           ", the first run begins " + to_text(log_.moment(begins_us_.front()), log_.clock));
  }

  void tell(Measured& measured) const {
    const LogFacts facts = facts_of(log_);
    measured.notes.push_back(
        "Read as a log of " + counted(log_.n_rows, "line") +
        (log_.has_readings()
             ? ", a reading every " + shortest_number(static_cast<double>(log_.interval_us) / 1e6) + " s"
             : ", an event each") +
        ": a window of " + shortest_number(frame_.window_s) + " s has motion if there is any in it.");
    sensors_.tell(measured.notes);
    measured.holds_s.assign(frame_.sensors.size(), 0.0);
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      if (!sensors_.columns[sensor]) continue;
      const LogSensorFacts& told = facts.sensors[*sensors_.columns[sensor]];
      if (!told.hold_s) continue;
      measured.holds_s[sensor] = *told.hold_s;
      measured.notes.push_back(frame_.sensors[sensor] + " holds motion for " + shortest_number(*told.hold_s) +
                               " s: its " + std::to_string(told.pulses.n) +
                               " pulses are hardly ever shorter. The simulated sensor does so too.");
    }
    const std::size_t empty = unknown_ - sensors_.absent.size() * (known_ + unknown_) / frame_.sensors.size();
    if (empty > 0) measured.notes.push_back(told_of_empty(empty));
  }

  const Log& log_;
  const StudyFrame& frame_;
  Where where_;
  std::vector<std::int64_t> begins_us_;  ///< (n_days)
  SensorColumns sensors_;                ///< among the log's
  std::size_t known_ = 0, unknown_ = 0;  ///< bits
};

/// None of an empty file, and of one that can't be read so far: whoever reads rows says why.
std::optional<std::string> first_line(const std::filesystem::path& file) {
  try {
    io::LineReader lines(file);
    const auto line = lines.next();
    return line ? std::optional(std::string(*line)) : std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
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

/// The line with the names, or less if that is all.
std::string_view up_to_header(std::string_view text) {
  std::size_t end = 0;
  bool is_header = false;
  while (end < text.size() && !is_header) {
    const std::string_view rest = text.substr(end);
    is_header = !rest.starts_with('#') && !rest.starts_with('\n') && !rest.starts_with("\r\n");
    end += std::min(rest.find('\n'), rest.size() - 1) + 1;
  }
  return text.substr(0, end);
}

class MeasuredReader {
 public:
  MeasuredReader(std::string_view bytes, const std::string& file, const StudyFrame& frame)
      : frame_(frame.of_whole_runs()), asked_(frame), text_(io::text_from(std::string(bytes), file)), file_(file) {
    measured_.file = file;
    measured_.digest = sha256(bytes);
  }

  /// Throws Error(input) with every fault.
  [[nodiscard]] Measured read() {
    if (io::CsvTable::parse(up_to_header(text_), file_).column("sensor")) {
      read_sums(io::CsvTable::parse(text_, file_));
    } else {
      io::RowReader reader(text_, file_);
      read_rows(reader);
    }
    repeated_.tell(faults_);
    faults_.throw_if_errors();
    if (asked_.day_parts.empty()) number_runs();
    refuse_too_little();
    measured_.runs = in_day_parts(asked_, std::move(measured_.runs));
    return std::move(measured_);
  }

 private:
  using RunKey = std::pair<std::size_t, int>;  ///< trial, replicate
  struct ReadRow {
    Where where;  ///< of its time
    double time_s = 0.0;
    bool is_counted = true;  ///< by its phase
    std::vector<std::uint8_t> bits{};
  };
  using InRun = std::optional<std::pair<RunKey, double>>;  ///< of a row: its run, and its second there

  void read_sums(const io::CsvTable& table) {
    measured_.kind = Measured::Kind::sums;
    const auto column_of = [&](std::string_view name) {
      const ColumnInfo& column = *std::ranges::find(sum_columns(), name, &ColumnInfo::name);
      const auto named = table.column(column.name), by_alias = table.column(column.alias);
      if (named && by_alias) {
        faults_.error({file_, 1, 1}, "columns '" + std::string(column.name) + "' and '" + std::string(column.alias) +
                                         "' mean the same: give one of them");
      }
      return named ? named : by_alias;
    };
    const std::size_t sensor = *table.column("sensor");
    const auto trial_column = column_of("trial"), replicate_column = table.column("replicate");
    std::optional<std::size_t> seconds = column_of("seconds");
    if (!trial_column && frame_.trials.size() > 1) static_cast<void>(table.required_column("trial", faults_));
    if (!seconds) seconds = table.required_column("seconds", faults_);
    // A missing column that is misspelt would be told a second time, as unknown.
    faults_.throw_if_errors();
    refuse_unknown_columns(table.names(), sum_columns());
    faults_.throw_if_errors();
    std::set<std::pair<RunKey, std::size_t>> seen;
    std::size_t missing = 0;
    for (std::size_t row = 0; row < table.n_rows(); ++row) {
      Diagnostics found;
      const auto trial =
          trial_column ? find(frame_.trials, "trial", table.text(row, *trial_column), table.where(row, *trial_column))
                       : std::optional<std::size_t>(0);
      const auto which = find(frame_.sensors, "sensor", table.text(row, sensor), table.where(row, sensor));
      const int replicate = replicate_column ? table.integer(row, *replicate_column, found).value_or(1) : 1;
      const auto value = table.number(row, *seconds, found);
      repeated_.add("number", found);
      if (!trial || !which) continue;
      refuse_too_many({*trial, replicate}, table.where(row, replicate_column.value_or(sensor)));
      if (!seen.insert({{*trial, replicate}, *which}).second)
        repeated_.add("twice", table.where(row, sensor), "this trial and sensor appear twice");
      if (value && *value < 0.0)
        repeated_.add("negative", table.where(row, *seconds), "seconds with motion can't be negative");
      if (!value) {
        ++missing;
        continue;
      }
      measured_.sums.push_back({*trial, *which, replicate, *value});
    }
    if (missing > 0)
      measured_.notes.push_back(counted(missing, "sum is", "sums are") + " empty and left out of every comparison.");
    std::set<std::pair<std::size_t, std::size_t>> cells;
    std::set<std::size_t> trials;
    for (const auto& [run, which] : seen) {
      cells.insert({run.first, which});
      trials.insert(run.first);
    }
    const std::size_t absent = trials.size() * frame_.sensors.size() - cells.size();
    if (absent > 0)
      measured_.notes.push_back(counted(absent, "cell") + " (trial and sensor) of the trials in the file " +
                                (absent == 1 ? "has" : "have") + " no sum" + left_out);
  }

  void read_rows(io::RowReader& reader) {
    using Format = io::RowFormat;
    const Format& format = reader.format();
    const std::vector<std::string>& sensors = format.columns().sensors;
    if (!format.has(Format::trial) && frame_.trials.size() > 1) {
      faults_.error({file_, 1, 1}, "column 'trial' is missing" + near_or_all("trial", sensors));
      faults_.throw_if_errors();
    }
    const auto columns = sensor_columns(sensors);
    if (!faults_.has_errors()) refuse_unknown_columns(sensors, row_columns());
    faults_.throw_if_errors();

    step_s_ = reader.step_s();
    tells_phases_ = format.has(Format::phase) && !frame_.counted_phases.empty();
    std::vector<std::int32_t> counted(asked_.day_parts.of_row.size(), -1);  // (n_days x n_rows) people in the data
    std::map<RunKey, std::vector<ReadRow>> runs;
    Sample row;
    while (reader.next(row)) {
      const InRun place = asked_.day_parts.empty() ? place_of(row, format) : place_in_days(row, format);
      if (!place) continue;
      const auto& [run, time_s] = *place;
      refuse_too_many(run, format.where(Format::replicate));
      const bool is_counted = std::ranges::find(frame_.counted_phases, row.phase) != frame_.counted_phases.end();
      ReadRow& added = runs[run].emplace_back(ReadRow{format.where(Format::time_s), time_s, is_counted});
      for (const auto& column : columns) {
        added.bits.push_back(column ? std::min(row.bits[*column], unknown_bit) : unknown_bit);
        unknown_bits_ += column && added.bits.back() == unknown_bit ? 1 : 0;
      }
      const std::size_t at = asked_.day_parts.empty() ? 0 : first_place(time_s);
      if (row.people >= 0 && at < asked_.day_parts.n_rows)
        counted[static_cast<std::size_t>(run.second - 1) * asked_.day_parts.n_rows + at] = row.people;
    }
    repeated_.tell(faults_);
    faults_.throw_if_errors();
    for (const auto& [key, rows] : runs) add_run(key, rows);
    if (format.has(Format::people)) note_people(asked_, counted, LogMap::People::count, measured_.notes);
    measured_.tells_phases = format.has(Format::phase);
    tell_rows();
  }

  void refuse_unknown_columns(const std::vector<std::string>& names, std::span<const ColumnInfo> columns) {
    std::vector<std::string> known;
    for (const ColumnInfo& column : columns) {
      known.emplace_back(column.name);
      if (!column.alias.empty()) known.emplace_back(column.alias);
    }
    if (measured_.kind == Measured::Kind::series)
      known.insert(known.end(), frame_.sensors.begin(), frame_.sensors.end());
    for (const std::string& name : names) {
      if (std::ranges::find(known, name) != known.end() || owner_of(name) != Each::sensor) continue;
      faults_.error({file_, 1, 1}, "unknown column '" + name + "'" + near_or_all(name, known));
    }
  }

  /// Where each of the study's sensors is among `names`.
  [[nodiscard]] std::vector<std::optional<std::size_t>> sensor_columns(const std::vector<std::string>& names) {
    SensorColumns sensors(frame_.sensors, names);
    if (sensors.absent.size() == frame_.sensors.size()) {
      faults_.error({file_, 1, 1}, "none of the columns is a sensor of the scene (" + joined(frame_.sensors, ", ") +
                                       "): is this the data of another scene?");
    } else {
      sensors.tell(measured_.notes);
    }
    return std::move(sensors.columns);
  }

  [[nodiscard]] std::optional<std::size_t> find(const std::vector<std::string>& names, const std::string& what,
                                                const std::string& name, const Where& where) {
    const auto known = std::ranges::find(names, name);
    if (known != names.end()) return static_cast<std::size_t>(known - names.begin());
    if (unknown_names_.insert(name).second)  // each is told once
      faults_.error(where, what + " '" + name + "' is not in the study" + near_or_all(name, names));
    return std::nullopt;
  }

  /// Before anything is made of them: each is simulated as often as there are datasets in the reference table.
  void refuse_too_many(const RunKey& run, const Where& where) {
    std::set<int>& replicates = replicates_[run.first];
    replicates.insert(run.second);
    if (replicates.size() <= limits::measured_replicates) return;
    throw Error(ErrorCode::input, where,
                "more than " + std::to_string(limits::measured_replicates) + " replicates of trial '" +
                    frame_.trials[run.first] + "': measured data can't have more");
  }

  /// Before gaps are filled, which a small file may have many of.
  void refuse_too_long(const std::vector<ReadRow>& rows) {
    const double lasts_s = rows.back().time_s - rows.front().time_s;
    const auto refuse = [&](const std::string& why) { throw Error(ErrorCode::input, rows.back().where, why); };
    if (lasts_s > limits::measured_run_s) {
      refuse("this run lasts " + fixed(lasts_s, 0) + " s; a simulated one lasts " + fixed(limits::measured_run_s, 0) +
             " s at most");
    }
    filled_rows_ += 1 + first_place(rows.front().time_s) + static_cast<std::size_t>(lasts_s / frame_.window_s);
    if (filled_rows_ > limits::measured_rows)
      refuse("up to here the data have more than " + std::to_string(limits::measured_rows) + " rows, gaps included");
  }

  /// Where the first row lies in its run. If phases are counted, they tell where the main part begins, not the clock.
  [[nodiscard]] std::size_t first_place(double time_s) const {
    if (!frame_.counted_phases.empty()) return 0;
    return static_cast<std::size_t>(std::max(0L, std::lround(time_s / frame_.window_s) - 1));
  }

  void add_run(RunKey key, const std::vector<ReadRow>& rows) {
    if (!check_times(rows)) return;
    refuse_too_long(rows);
    Series series{key.first, key.second, 0, 0, {}};
    std::vector<std::size_t> places;  // of the rows, gaps counted
    const std::size_t first = first_place(rows.front().time_s);
    for (const ReadRow& row : rows) {
      const double windows = (row.time_s - rows.front().time_s) / frame_.window_s;
      const std::size_t place = first + static_cast<std::size_t>(std::lround(windows));
      while (series.bits.size() < place * frame_.sensors.size()) {
        series.bits.insert(series.bits.end(), frame_.sensors.size(), unknown_bit);
        ++inserted_rows_;
      }
      series.bits.insert(series.bits.end(), row.bits.begin(), row.bits.end());
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

  /// Rows follow each other as the reader of rows wants it; their clock may say otherwise.
  [[nodiscard]] bool check_times(const std::vector<ReadRow>& rows) {
    const double first_s = rows.front().time_s;
    const auto refuse = [&](const char* kind, const ReadRow& row, const std::string& why) {
      repeated_.add(kind, row.where, why);
      return false;
    };
    if (frame_.counted_phases.empty() && !(first_s >= 0.0 && first_s <= most_missing_rows * frame_.window_s))
      return refuse("begin", rows.front(),
                    "time_s counts from the beginning of the trial; this one begins with " + io::csv_number(first_s));
    if (rows.size() > 1 && std::abs(step_s_ - frame_.window_s) > 1e-6 * frame_.window_s)
      return refuse("window", rows.front(),
                    "rows are " + io::csv_number(step_s_) + " s apart, the script's window is " +
                        io::csv_number(frame_.window_s) + " s");
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const double windows = (rows[i].time_s - rows[i - 1].time_s) / frame_.window_s;
      if (windows <= 0.5)
        return refuse("order", rows[i], "time doesn't grow: this row isn't later than the one before");
      if (windows > most_missing_rows)
        return refuse(
            "gap", rows[i],
            "this row comes " + io::csv_number(std::round(windows)) + " windows after the one before: too long a gap");
    }
    return true;
  }

  void mark_main(Series& series, const std::vector<ReadRow>& rows, const std::vector<std::size_t>& places) {
    series.main_end = tells_phases_ ? 0 : places.back() + 1;
    for (std::size_t i = 0; tells_phases_ && i < rows.size(); ++i) {
      if (!rows[i].is_counted) continue;
      if (series.main_end == 0) series.main_begin = places[i];
      series.main_end = places[i] + 1;
    }
  }

  /// From 1 in every trial, as simulated runs are: numbers may begin anywhere and have gaps.
  void number_runs() {
    std::map<std::size_t, std::set<int>> known;  // of a trial
    for (const Series& run : measured_.runs) known[run.trial].insert(run.replicate);
    for (const Measured::Sum& sum : measured_.sums) known[sum.trial].insert(sum.replicate);
    const auto number = [&](auto& one) {
      const std::set<int>& all = known[one.trial];
      one.replicate = 1 + static_cast<int>(std::distance(all.begin(), all.find(one.replicate)));
    };
    std::ranges::for_each(measured_.runs, number);
    std::ranges::for_each(measured_.sums, number);
  }

  void refuse_too_little() {
    const bool has_sums = measured_.kind == Measured::Kind::sums;
    const std::size_t n = frame_.sensors.size(), needed = has_sums ? fewest_cells : fewest_rows;
    std::size_t known = measured_.sums.size();
    for (const Series& run : measured_.runs) {
      for (std::size_t row = run.main_begin; row < run.main_end; ++row) {
        const auto bits = std::span(run.bits).subspan(row * n, n);
        known += std::ranges::any_of(bits, [](auto bit) { return bit != unknown_bit; }) ? 1 : 0;
      }
    }
    if (known >= needed) return;
    throw Error(ErrorCode::input, {file_, 0, 0},
                "too little data: " + counted(known, has_sums ? "sum" : "row") + (has_sums ? "" : " to compare") +
                    ", needed are " + std::to_string(needed));
  }

  /// Notes what was done with the rows.
  void tell_rows() {
    const std::string phases = joined(frame_.counted_phases, ", ");
    const auto tell = [&](std::size_t n, const std::string& text) {
      if (n > 0) measured_.notes.push_back(text);
    };
    tell(outside_, counted(outside_, "row lies", "rows lie") + " outside of the script's days: left out.");
    tell(measured_.tells_phases ? 0 : frame_.counted_phases.size(),
         "The file has no column 'phase': its rows are taken for those of the phase '" + phases +
             "', from its beginning.");
    tell(inserted_rows_,
         counted(inserted_rows_, "row is", "rows are") + " missing: taken for unknown, in the simulation too.");
    tell(unknown_bits_, told_of_empty(unknown_bits_));
    tell(unread_runs_, counted(unread_runs_, "run has", "runs have") + " no reading" +
                           (phases.empty() ? "" : " in a counted phase (" + phases + ")") + " and " +
                           (unread_runs_ == 1 ? "is" : "are") + " left out.");
  }

  /// Each day of a dataset is a run of its script.
  [[nodiscard]] int replicate_of(const Sample& row, const io::RowFormat& format) {
    using Format = io::RowFormat;
    if (format.has(Format::replicate) || !format.has(Format::day) || format.has(Format::trial)) return row.replicate;
    const std::optional<int> day = io::parse_number<int>(row.trial);
    if (!day) repeated_.add("day", format.where(Format::day), "day: expected a whole number, got '" + row.trial + "'");
    return day.value_or(1);
  }

  [[nodiscard]] InRun place_of(const Sample& row, const io::RowFormat& format) {
    const auto trial = format.has(io::RowFormat::trial)
                           ? find(frame_.trials, "trial", row.trial, format.where(io::RowFormat::trial))
                           : std::optional<std::size_t>(0);
    if (!trial) return std::nullopt;
    return std::pair{RunKey{*trial, replicate_of(row, format)}, row.time_s};
  }

  /// By its local time if it has one, or else by its number and second.
  [[nodiscard]] InRun place_in_days(const Sample& row, const io::RowFormat& format) {
    const DayParts& parts = asked_.day_parts;
    const auto lasts_s = static_cast<double>(parts.n_rows) * frame_.window_s;
    if (row.clock.empty() || parts.begins_s.empty()) {
      const InRun place = place_of(row, format);
      if (!place) return std::nullopt;
      const int day = place->first.second;
      if (day < 1 || day > asked_.n_days()) {
        repeated_.add("day", format.where(io::RowFormat::replicate),
                      "run " + std::to_string(day) + ", but the script's occupancy has " +
                          counted(parts.n_days, "day") + ": a column 'time' tells which day a row is of");
        return std::nullopt;
      }
      if (place->second > lasts_s + 0.5 * frame_.window_s) return ++outside_, std::nullopt;
      return place;
    }
    const std::int64_t now_s = clock_from(row.clock)->begin_s;
    for (std::size_t day = 0; day < parts.n_days; ++day) {
      const auto time_s = static_cast<double>(now_s - parts.begins_s[day]);
      if (time_s <= 0.0 || time_s > lasts_s) continue;
      const double windows = time_s / frame_.window_s;
      if (std::abs(windows - std::round(windows)) > 1e-3) {
        repeated_.add("grid", format.where(io::RowFormat::time),
                      "this row ends within a window of the script, whose run begins at " +
                          RunClock{parts.begins_s[day]}.text(0.0) +
                          ": give the log itself, or a script whose from or "
                          "begin lies on the rows' grid");
        return std::nullopt;
      }
      return std::pair{RunKey{0, static_cast<int>(day) + 1}, time_s};
    }
    ++outside_;
    return std::nullopt;
  }

  StudyFrame frame_;  ///< of whole runs
  const StudyFrame& asked_;
  std::string text_, file_;
  Diagnostics faults_;
  io::RepeatedFaults repeated_;
  Measured measured_;
  bool tells_phases_ = false;  ///< that are counted
  double step_s_ = 0.0;        ///< of the rows
  std::set<std::string> unknown_names_;
  std::map<std::size_t, std::set<int>> replicates_;  ///< of a trial
  std::size_t outside_ = 0;                          ///< rows
  std::size_t inserted_rows_ = 0, unknown_bits_ = 0, unread_runs_ = 0, filled_rows_ = 0;
};

void note_missing_trials(const StudyFrame& frame, Measured& measured) {
  std::vector<std::string> absent;
  const std::vector<std::size_t> present = measured.trials();
  for (std::size_t trial = 0; trial < frame.trials.size(); ++trial) {
    if (!std::ranges::binary_search(present, trial)) absent.push_back(frame.trials[trial]);
  }
  if (!absent.empty()) measured.notes.push_back("The file has nothing of " + joined(absent, ", ") + left_out);
}

}  // namespace

bool is_log(const std::filesystem::path& file) {
  std::error_code told_later;
  if (!std::filesystem::is_regular_file(file, told_later)) return false;
  if (io::is_database(file)) return true;
  const std::optional<std::string> line = first_line(file);
  if (!line) return false;
  const std::vector<std::string> fields = fields_of(*line);
  const auto has = [&](std::string_view name) { return std::ranges::find(fields, name) != fields.end(); };
  if (has("time_s") || (has("sensor") && (has("seconds") || has("real")))) return false;
  const auto is_time = [](const std::string& name) { return io::what_name_says(name) == io::NameSays::time; };
  // "[2026-01-25 10:20:47] info: ..." of programs' text logs, HOBO's "Plot Title: ..."
  const bool begins_with_time = !line->empty() && std::isdigit(static_cast<unsigned char>(line->front())) != 0;
  const bool is_of_a_program =
      line->starts_with('[') || line->starts_with("Zigbee2MQTT") || fields.front().starts_with("plottitle:");
  return begins_with_time || is_of_a_program || has("entity_id") || has("start") ||
         std::ranges::any_of(fields, is_time);
}

Measured parse_measured(std::string_view text, const std::string& file, const StudyFrame& frame) {
  Measured measured = MeasuredReader(text, file, frame).read();
  note_missing_trials(frame, measured);
  return measured;
}

Measured measured_of(const Log& log, const SceneSpec& scene, const ScriptSpec& script) {
  require_known_presence(script);
  const StudyFrame frame = frame_of(scene, script);
  Measured measured = LogRuns(log, frame, clock_of(script, script.trials.front())).measured();
  for (const Issue& remark : log.remarks) measured.notes.push_back("The log: " + remark.message + ".");
  note_missing_trials(frame, measured);
  return measured;
}

Measured read_measured(const std::filesystem::path& file, const SceneSpec& scene, const ScriptSpec& script,
                       const LogMap& map) {
  require_known_presence(script);
  // A pipe can't be looked into before it is read: a map says that it is a log.
  std::error_code none;
  const bool is_piped_log = map != LogMap{} && !std::filesystem::is_regular_file(file, none);
  if (is_piped_log || is_log(file)) return measured_of(io::read_log(std::span(&file, 1), map), scene, script);
  if (map != LogMap{})
    throw Error(ErrorCode::usage, file.string() + " is no log (docs/formats/log.md), so that a map says nothing of it");
  return parse_measured(io::decompressed(io::read_input(file), io::max_text_file_bytes), file.string(), scene, script);
}

Measured parse_measured(std::string_view text, const std::string& file, const SceneSpec& scene,
                        const ScriptSpec& script) {
  require_known_presence(script);
  return parse_measured(text, file, frame_of(scene, script));
}

}  // namespace pirsim::reconcile
