// Which columns of a log tell its time. Private to io.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/log/log_head.hpp"
#include "io/log/log_timer.hpp"

namespace pirsim::io {

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
