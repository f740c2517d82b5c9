// What is odd or wrong in a log, a kind once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/disk/line_reader.hpp"
#include "logs/home_database.hpp"
#include "logs/json_rows.hpp"
#include "logs/log_proof.hpp"
#include "logs/log_shape.hpp"
#include "logs/times.hpp"
#include "pirsim/error.hpp"
#include "pirsim/log.hpp"

namespace pirsim::io {

/// Of one severity. Logs have the same oddity a million times: the first is told, with how many more there are.
class LogRemarks {
 public:
  /// `kind` is what they have in common; message() is asked for the first one alone.
  template <typename GiveMessage>
  void add(std::string_view kind, const Where& where, GiveMessage message) {
    ++n_;
    const auto known = std::ranges::find(kinds_, kind, &Oddity::name);
    if (known == kinds_.end())
      kinds_.push_back({std::string(kind), where, message(), 1});
    else
      ++known->n;
  }
  [[nodiscard]] std::uint64_t count() const noexcept { return n_; }
  [[nodiscard]] std::vector<Issue> issues(Severity severity) const {
    std::vector<Issue> issues;
    for (const Oddity& kind : kinds_) {
      const std::string more = kind.n == 1 ? "" : "; " + std::to_string(kind.n - 1) + " more like this";
      issues.push_back({severity, kind.where, kind.message + more});
    }
    return issues;
  }

 private:
  struct Oddity {
    std::string name;
    Where where;
    std::string message;
    std::uint64_t n;
  };
  std::vector<Oddity> kinds_;
  std::uint64_t n_ = 0;
};

// Lines that programs write for people, as rows of a table of time, sensor and state.

class TextLines {
 public:
  enum class Writer { openhab, zigbee2mqtt, esphome, mosquitto, tasmota, fhem };
  /// Whose text the first lines are; none: nobody's that is known.
  [[nodiscard]] static std::optional<Writer> writer_of(std::span<const HeadLine> head);

  TextLines(Writer writer, std::string file) : writer_(writer), file_(std::move(file)) {}

  [[nodiscard]] std::string_view name() const;
  /// Adds the changes that a line tells to `rows`, each a line of a table of tabs with the columns of
  /// HomeDatabase::header.
  void read(const HeadLine& line, std::vector<HeadLine>& rows, LogRemarks& remarks);
  /// Lines that tell of something else.
  [[nodiscard]] std::uint64_t n_other() const noexcept { return n_other_; }

 private:
  struct Change {
    std::string time, sensor, state;
    bool operator==(const Change&) const = default;
  };
  using Changes = std::vector<Change>;
  [[nodiscard]] Changes changes_in(std::string_view text, int line, LogRemarks& remarks);
  [[nodiscard]] static Changes of_openhab(std::string_view text);
  [[nodiscard]] Changes of_zigbee2mqtt(std::string_view text);
  [[nodiscard]] Changes of_message(const std::string& time, std::string_view topic, std::string_view payload);
  [[nodiscard]] Changes of_mosquitto(std::string_view text);
  [[nodiscard]] Changes of_tasmota(std::string_view text, int line, LogRemarks& remarks);
  [[nodiscard]] static Changes of_fhem(std::string_view text);
  [[nodiscard]] Changes of_esphome(std::string_view text, int line, LogRemarks& remarks);
  [[nodiscard]] std::string since_first_midnight(std::int64_t us, int line, LogRemarks& remarks);

  Writer writer_;
  std::string file_;
  std::uint64_t n_other_ = 0;
  std::map<std::string, std::map<std::string, Change>> told_;  ///< the last one by device and property
  std::int64_t last_us_ = 0, days_us_ = 0;                     ///< of times of day
  std::uint64_t n_back_ = 0, n_ahead_ = 0;                     ///< lines before and after the time of the one above
};

// One file of a log, row by row.

/// What all files of a log share.
struct LogReading {
  const LogMap& map;
  LogZone* zone;  ///< none: null
  LogRemarks faults{}, remarks{};
  LogRemarks unset{};      ///< rows left out, from before a clock was set
  bool has_start = false;  ///< the map says from when on the log counts
  EventTracks events{};
  LogMap::Rows rows = LogMap::Rows::found;  ///< what those of the files so far are
  std::uint64_t n_rows = 0;
  std::optional<std::int64_t> first_us{}, last_us{};  ///< of all rows, whether or not they tell of a sensor
  std::optional<std::int64_t> from_us{}, to_us{};     ///< what is wanted of it
  struct Moments {
    std::int64_t first_us, last_us;
  };
  /// Rows of a day, or of a stretch as long as the longest gap if that is shorter.
  struct Busy {
    std::int64_t first_us, last_us;
    const std::string* path;  ///< of the first row that is read,
    int line;                 ///< and where it stands
    std::uint64_t n_rows = 0;
  };
  std::map<std::int64_t, Busy> busy{};  ///< those in which there are rows
  // For the gate (log_gate.hpp).
  std::map<std::string, CellCounts, std::less<>> columns{};  ///< of wide logs
  StepsBack order{};                                         ///< of rows of wide logs
  Where back_at{};                                           ///< the first row that steps back
  std::uint64_t n_left_out = 0;                              ///< rows
  std::optional<Issue> left_out{};                           ///< the first one, and why

  std::map<std::string, std::string, std::less<>> classes{};  ///< of devices: "motion", "door"

  /// What an entity is by its device class, or else by its name.
  [[nodiscard]] NameSays says(const std::string& entity) const {
    const auto found = classes.find(entity);
    if (found == classes.end()) return what_name_says(entity);
    const NameSays says = what_name_says(found->second);
    return says == NameSays::motion || says == NameSays::presence ? says : NameSays::other_device;
  }
  void note_row(std::int64_t us, const std::string& path, int line);
  [[nodiscard]] bool is_wanted(std::int64_t from, std::int64_t to) const noexcept {
    return (!from_us || to >= *from_us) && (!to_us || from <= *to_us);
  }
  /// Longer than that: when nothing at all was written.
  [[nodiscard]] std::vector<Moments> silences(std::int64_t longer_than_us) const;
};

class LogFile {
 public:
  LogFile(const std::filesystem::path& path, LogReading& reading, const LogObserver& observer);
  /// All rows. Events go to the reading's tracks.
  void read();

  [[nodiscard]] const LogShape& shape() const noexcept { return shape_; }
  [[nodiscard]] LogTimer& timer() noexcept { return timer_; }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] LogClock clock() const noexcept { return timer_.clock(); }
  /// None: events, or rows of changes.
  [[nodiscard]] std::optional<ReadingTracks>& readings() noexcept { return readings_; }
  /// The only sensor of a file that has one and doesn't name it.
  [[nodiscard]] bool is_of_one_sensor() const {
    return shape_.form == LogMap::Form::wide && shape_.sensors.size() == 1 && !shape_.people;
  }
  [[nodiscard]] InputFile file() const { return database_ ? database_->file() : lines_->file(); }
  /// "openHAB's log"; none of a table.
  [[nodiscard]] std::string_view source() const {
    return text_ ? text_->name() : database_ ? HomeDatabase::called : std::string_view();
  }
  /// Lines of that that tell no change.
  [[nodiscard]] std::uint64_t n_other_lines() const { return text_ ? text_->n_other() : 0; }
  /// What a map's from and to say in this log's time; none for no text. Throws Error(usage).
  [[nodiscard]] std::optional<std::int64_t> limit(const std::string& key, const std::string& text) const;

 private:
  [[nodiscard]] std::optional<HeadLine> next_line();
  [[nodiscard]] std::optional<HeadLine> next_object();
  void find_shape();
  void read_head();
  void skip_titles();
  void read_json_head(std::string first);
  void take_json(std::string text);
  template <typename Take>
  void each_row(Take take);
  void read_text_head(TextLines::Writer writer);
  [[nodiscard]] LogMap map_of_head() const;
  [[noreturn]] void refuse_head();
  void finish();
  void take(std::string_view line, int number);
  [[nodiscard]] bool is_header_again() const;
  [[nodiscard]] std::size_t least_fields() const { return std::max(shape_.n_fields(), n_read_fields_); }
  void refuse_fields(int line, std::size_t n);
  [[nodiscard]] std::optional<std::int64_t> time_of_row(LogTimer& timer, const TimeColumns& columns, int line);
  void take_readings(std::int64_t us, int line);
  void take_changes(std::int64_t us, int line);
  void take_event(std::int64_t us, int line);
  void take_unset(const std::string& why, int line);
  void take_interval(std::int64_t us, int line);
  [[nodiscard]] EventTracks::Track* track_of(std::string_view name, int line);
  [[nodiscard]] EventTracks::Track* track_of_row(int line);
  void require_few_events(int line) const;
  void take_odd_event(EventTracks::Track& track, std::int64_t us, std::int32_t unknown, int line);
  void read_values(int line);
  void require_one_run(int line);
  template <typename Message>
  void fault(std::string_view kind, int line, std::size_t column, Message message);
  template <typename Message>
  void remark(std::string_view kind, int line, Message message);
  /// A row that can't be used. message: why.
  template <typename Message>
  void leave_out(std::string_view kind, int line, Message message);

  std::string path_;
  LogReading& reading_;
  const LogObserver& observer_;
  std::optional<LineReader> lines_;
  std::optional<HomeDatabase> database_;  ///< or
  std::optional<TextLines> text_;
  std::optional<JsonRows> json_;
  bool is_ruled_ = false;                                ///< a table for people
  std::optional<std::pair<int, std::size_t>> broken_{};  ///< a line with too few fields, and how many
  std::vector<HeadLine> head_;
  LogShape shape_;
  LogTimer timer_;
  std::optional<LogTimer> end_timer_;  ///< of intervals
  std::optional<ReadingTracks> readings_;
  std::size_t n_read_fields_ = 0;
  std::vector<std::string_view> fields_;
  std::vector<std::string> unquoted_;
  std::vector<std::int32_t> values_, last_values_;  ///< of a wide row: sensors, then people
  std::optional<std::int64_t> row_us_;              ///< of the row before
  std::vector<CellCounts> cells_;                   ///< as values_
  std::int64_t last_us_ = 0;                        ///< of a wide row
  std::uint64_t n_rows_ = 0;                        ///< of a wide log
  std::vector<std::string> run_;                    ///< which of several runs is read
};

}  // namespace pirsim::io
