// Words of logs: states, and what columns are called.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/read/csv_reader.hpp"
#include "logs/times.hpp"

namespace pirsim::io {

/// log_state of "1", "0.0", "on", "False", "motion", "unavailable", ""; none for what is no state.
[[nodiscard]] std::optional<std::int32_t> read_state(std::string_view text);
/// By the words of a map first.
[[nodiscard]] std::optional<std::int32_t> read_state(std::string_view text, const LogMap::States& words);
/// "", "nan", "null": a table's cell in which nothing stands.
[[nodiscard]] bool is_empty_cell(std::string_view text);
/// A whole number from 0, also as "3.0"; log_state::unknown_count for what says that nobody knows; none for any other
/// text.
[[nodiscard]] std::optional<std::int32_t> read_count(std::string_view text);

/// A name in small letters, cut at what is neither letter nor digit, and before capitals that follow small letters:
/// {"s6", "pir"},
/// {"front", "door"}.
[[nodiscard]] std::vector<std::string> words_of_name(std::string_view name);

enum class NameSays { nothing, time, sensor, state, motion, count, presence, other_quantity, other_device };
/// What a column or an entity is by its name. `time`, `sensor` and `state` are said only of whole names.
[[nodiscard]] NameSays what_name_says(std::string_view name);
/// How surely the name says that a column is the time: 3 for "timestamp", which tells when something happened; 2 for
/// "utc"; 1 for other names, also for "received", which may be later.
[[nodiscard]] int rank_as_time(std::string_view name);
/// "M003", "MA012": how CASAS calls motion sensors.
[[nodiscard]] bool is_casas_motion(std::string_view name);

/// A text that YAML takes for nothing else.
[[nodiscard]] std::string quoted_yaml(const std::string& text);
[[nodiscard]] std::string quoted_yaml(const std::vector<std::string>& list);

// The first lines of a log as a table.

struct HeadLine {
  std::string text;
  int line = 0;
};

/// Every row has as many fields as the first line, the missing ones being empty; spaces around fields are left out.
struct HeadTable {
  std::string file;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> names;  ///< "column 3" where none is told
  int header_line = 0;             ///< 0: the first line is a row

  [[nodiscard]] std::size_t n_columns() const { return names.size(); }
  /// Of the rows' fields in this column.
  [[nodiscard]] std::size_t count(std::size_t column, const std::function<bool(const std::string&)>& holds) const;
  [[nodiscard]] bool is_mostly(std::size_t column, const std::function<bool(const std::string&)>& holds) const {
    return !rows.empty() && 2 * count(column, holds) >= rows.size();
  }
  [[nodiscard]] NameSays says(std::size_t column) const { return what_name_says(names[column]); }
  [[nodiscard]] std::size_t n_values(std::size_t column) const;  ///< different ones
  /// The column of that name; otherwise refuses.
  [[nodiscard]] std::size_t named(const std::string& name) const;
  /// The columns with their first values, for messages.
  [[nodiscard]] std::string columns_in_words() const;
  // Throw Error(input): with the columns, and with the maps that settle it.
  [[noreturn]] void refuse(const std::string& why) const;
  [[noreturn]] void refuse_with(const std::string& why, const std::vector<std::string>& maps) const;
};

/// time_format: of a map. Throws Error(input).
[[nodiscard]] HeadTable table_of(const std::vector<HeadLine>& head, char separator, const std::string& file,
                                 const std::string& time_format);

[[nodiscard]] bool is_number(const std::string& text);

// Which columns of a log tell its time.

class TimeFinder {
 public:
  /// All outlive it. zone: of local times, or null.
  TimeFinder(const HeadTable& table, const LogMap& map, LogZone* zone);

  /// Of these columns, which a map tells; none: of all. Throws Error(input), with maps if several may be the time.
  [[nodiscard]] TimeColumns find(const std::vector<std::string>& told) const;
  /// Times of day after the date in the same row, if a column holds it.
  [[nodiscard]] TimeColumns with_date(TimeColumns time) const;
  /// The kind of most of a column's fields.
  [[nodiscard]] std::optional<Stamp::Kind> kind_of(std::size_t column) const { return kinds_[column]; }
  /// Of the rows; none where no time can be read.
  [[nodiscard]] std::vector<std::optional<std::int64_t>> times(const TimeColumns& time) const;

 private:
  using Columns = std::vector<std::size_t>;
  /// What may be the time. rank: how surely its names say so.
  struct Candidate {
    TimeColumns time;
    int rank = 0;
  };
  enum class NumberIs { no_time, in_order, called_so, since_1970, called_so_in_order };
  struct Numbers {
    NumberIs are = NumberIs::no_time;
    bool are_since_1970 = false, grow = false;
  };

  [[nodiscard]] std::optional<Stamp::Kind> kind_in(std::size_t column) const;
  [[nodiscard]] LogMap::Dates order_in(std::size_t column) const;
  [[nodiscard]] TimeColumns column_of(std::size_t column, Stamp::Kind kind) const;
  [[nodiscard]] TimeColumns pair_of(std::size_t date, std::size_t hour) const;
  [[nodiscard]] std::optional<Stamp::Kind> kind_of(const TimeColumns& time) const;
  [[nodiscard]] std::optional<Stamp> stamp_of(std::string_view text, LogMap::Dates order) const {
    return parse_stamp(text, order, map_.time_format);
  }
  void require_zone(std::size_t column, LogMap::Dates order) const;
  void set_days(TimeColumns& time, const std::vector<double>& numbers) const;
  [[nodiscard]] TimeColumns with_rest(TimeColumns time, const Columns& columns) const;
  [[nodiscard]] Numbers numbers_of(std::size_t column) const;
  [[nodiscard]] std::vector<Candidate> moments(const Columns& columns, const Columns& dates,
                                               const Columns& hours) const;
  [[nodiscard]] std::vector<Candidate> own_numbers(const Columns& columns) const;
  [[nodiscard]] bool tell_the_same(const TimeColumns& a, const TimeColumns& b) const;
  [[nodiscard]] TimeColumns surest(std::vector<Candidate> candidates) const;

  const HeadTable& table_;
  const LogMap& map_;
  LogZone* zone_;
  std::vector<std::optional<Stamp::Kind>> kinds_;  ///< of the columns
};

}  // namespace pirsim::io
