#include "reconcile/data/measured_log.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <system_error>

#include "core/text.hpp"
#include "io/files/line_reader.hpp"
#include "io/log/home_database.hpp"
#include "io/log/log_words.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/log_facts.hpp"

namespace pirsim::reconcile {
namespace {

constexpr double longer_than_window = 1.25;  ///< times may readings be, since clocks of loggers are slow; assumed

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

/// Of the log's own time, at which a run begins.
std::int64_t moment_of(const Log& log, std::int64_t local_s) {
  constexpr std::int64_t us = 1'000'000;
  for (const LogOffset& offset : log.offsets) {
    const std::int64_t moment = (local_s - offset.offset_s) * us;
    if (log.moment(moment).offset_s == offset.offset_s) return moment;
  }
  return local_s * us;
}

/// Puts a log's windows into runs.
class LogRuns {
 public:
  LogRuns(const Log& log, const StudyFrame& frame, std::optional<std::int64_t> begin_s)
      : log_(log), frame_(frame), where_{log.files.empty() ? std::string("log") : log.files.front().path, 0, 0} {
    require_clock(begin_s);
    require_windows();
    find_sensors();
    if (!frame.units.empty() && !frame.units.begins_s.empty() && log.clock != LogClock::elapsed) {
      for (const std::int64_t day_s : frame.units.begins_s) begins_us_.push_back(moment_of(log, day_s));
    } else {
      begins_us_.push_back(log.clock == LogClock::elapsed ? 0 : moment_of(log, *begin_s));
    }
  }

  Measured measured() {
    Measured measured;
    measured.file = where_.file;
    measured.digest = log_.files.empty() ? std::string() : log_.files.front().sha256;
    measured.tells_phases = false;
    const std::size_t n = frame_.sensors.size();
    std::vector<std::int32_t> counted(frame_.units.of_row.size(), log_state::unknown_count);
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
    measured.runs = in_units(frame_, std::move(measured.runs));
    return measured;
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { throw Error(ErrorCode::input, where_, why); }

  void require_clock(std::optional<std::int64_t> begin_s) const {
    if (log_.clock != LogClock::elapsed && !begin_s)
      refuse("the log has times of day, but the script doesn't say when its run begins: write begin: " +
             to_text(log_.moment(log_.begin_us), LogClock::local).substr(0, 19));
    if (log_.clock == LogClock::elapsed && frame_.n_days() > 1)
      refuse("the log counts seconds, and the script has several days: a log needs times with dates");
    if (frame_.units.empty() && frame_.trials.size() > 1)
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
    for (const std::string& sensor : frame_.sensors) {
      const auto found = std::ranges::find(names, sensor);
      columns_.push_back(found == names.end() ? std::nullopt
                                              : std::optional(static_cast<std::size_t>(found - names.begin())));
      if (!columns_.back()) absent_.push_back(sensor);
    }
    if (absent_.size() < frame_.sensors.size()) return;
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
    const std::int64_t n_rows = frame_.units.empty()
                                    ? std::max<std::int64_t>(0, first + static_cast<std::int64_t>(windows.size()))
                                    : static_cast<std::int64_t>(frame_.units.n_rows);
    const std::size_t n = frame_.sensors.size();
    std::vector<std::uint8_t> bits(static_cast<std::size_t>(n_rows) * n, unknown_bit);
    const std::int64_t skipped = std::max<std::int64_t>(0, -first);
    if (skipped >= static_cast<std::int64_t>(windows.size())) return bits;
    const LogRows rows = windows.rows(static_cast<std::size_t>(skipped), static_cast<std::size_t>(n_rows));
    const auto at = static_cast<std::size_t>(first + skipped);
    for (std::size_t i = 0; i < rows.n_windows() && at + i < static_cast<std::size_t>(n_rows); ++i) {
      for (std::size_t sensor = 0; sensor < n; ++sensor) {
        if (columns_[sensor]) bits[(at + i) * n + sensor] = rows.at(i, *columns_[sensor]);
      }
      if (!rows.people.empty() && !counted.empty()) counted[day * frame_.units.n_rows + at + i] = rows.people[i];
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
    using What = DataNote::What;
    const LogFacts facts = facts_of(log_);
    measured.notes.push_back({What::log_read,
                              log_.n_rows,
                              {log_.has_readings() ? shortest_number(static_cast<double>(log_.interval_us) / 1e6) : "",
                               shortest_number(frame_.window_s)}});
    if (!absent_.empty()) measured.notes.push_back({What::sensors_absent, absent_.size(), absent_});
    measured.holds_s.assign(frame_.sensors.size(), 0.0);
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      if (!columns_[sensor]) continue;
      const LogSensorFacts& told = facts.sensors[*columns_[sensor]];
      if (!told.hold_s) continue;
      measured.holds_s[sensor] = *told.hold_s;
      measured.notes.push_back(
          {What::hold_told, told.pulses.n, {frame_.sensors[sensor], shortest_number(*told.hold_s)}});
    }
    const std::size_t empty = unknown_ - absent_.size() * (known_ + unknown_) / frame_.sensors.size();
    if (empty > 0) measured.notes.push_back({What::readings_empty, empty});
  }

  const Log& log_;
  const StudyFrame& frame_;
  Where where_;
  std::vector<std::int64_t> begins_us_;              ///< (n_days)
  std::vector<std::optional<std::size_t>> columns_;  ///< (n_sensors) of the log
  std::vector<std::string> absent_;
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

Measured measured_of(const Log& log, const StudyFrame& frame, std::optional<std::int64_t> begin_s) {
  return LogRuns(log, frame, begin_s).measured();
}

void note_people(const StudyFrame& frame, std::span<const std::int32_t> counted, LogMap::People means,
                 std::vector<DataNote>& notes) {
  const Units& units = frame.units;
  if (units.empty()) {
    notes.push_back({DataNote::What::people_unused});
    return;
  }
  std::size_t n = 0, differ = 0, first = 0;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    if (counted[i] < 0 || units.people[i] < 0) continue;
    const bool same =
        means == LogMap::People::count ? counted[i] == units.people[i] : (counted[i] > 0) == (units.people[i] > 0);
    ++n;
    if (same) continue;
    if (differ++ == 0) first = i;
  }
  if (differ == 0) return;
  const double run_s = static_cast<double>(first % units.n_rows) * frame.window_s;
  const std::optional<RunClock> clock =
      units.begins_s.empty() ? std::nullopt : std::optional(RunClock{units.begins_s[first / units.n_rows]});
  notes.push_back({DataNote::What::people_differ,
                   differ,
                   {std::to_string(n), moment_text(clock, run_s), std::to_string(counted[first]),
                    std::to_string(units.people[first])}});
}

}  // namespace pirsim::reconcile
