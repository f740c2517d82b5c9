// Which simulated rooms are like the one that a log comes from? They are weighed by how well each explains it, without
// anybody having counted. docs/howto/own_room.md
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "pirsim/columns.hpp"
#include "pirsim/counting.hpp"
#include "pirsim/dataset.hpp"
#include "pirsim/interval.hpp"
#include "pirsim/log.hpp"

namespace pirsim::calibrate {

/// A room of the recipe: its days, and what was drawn for it by name ("range_scale.scale").
struct PoolRoom {
  counting::LabelledRoom labelled;
  std::map<std::string, double> parameters;
};

/// A number that a day's motion tells without counts, and how the log compares with the rooms.
struct Statistic {
  std::string name, unit;
  /// Those of the schedule don't make the verdict: it is the recipe's hours that are to be moved, not the room.
  enum class About { motion, schedule } about = About::motion;
  double of_log = 0.0;
  Interval of_rooms{};    ///< 5 to 95 % of all rooms
  Interval of_weighty{};  ///< the same by weight
  double p = 1.0;         ///< share of rooms, and the log, that are at least as far from the middle
  double share = 0.0;     ///< of what makes the log unlike the rooms, that goes without this one; 0 of the schedule's
  /// Where it is unlike the rooms', by itself or most of all where they are so together: what that is a sign of, or
  /// of the schedule's, what to do. Empty elsewhere.
  std::string sign{};
  /// What a range would have to be like for the statistic to reach the log's, if it is unlike and one of the recipe's
  /// moves it: "more range_scale.scale".
  std::string advice{};
};

/// What the log determined of a parameter.
struct ParameterRange {
  std::string name;
  Interval before;  ///< 5 to 95 % of all rooms
  Interval after;   ///< the same by weight
  double mean_before = 0.0, mean_after = 0.0;
  double narrowed = 0.0;  ///< 1 - ratio of standard deviations: 0 is left open, 1 is determined
};

struct WeighedRoom {
  int number = 0;
  double log_likelihood = 0.0, weight = 0.0;
  /// Mean absolute error in people that a counter makes in this room, made from the others by this room's own
  /// log; none: nobody was there. Of readings from half an hour before the first person to half an hour after the last.
  std::optional<double> error;
};

enum class Verdict {
  like_these,      ///< some of these rooms make such a log
  none_like_it,    ///< no room of this recipe makes such a log: neither counts nor errors can be relied on
  too_little_told  ///< too little happens in the log to tell
};
[[nodiscard]] std::string word_of(Verdict verdict);         ///< "like-these"
[[nodiscard]] std::string word_of(Statistic::About about);  ///< "motion"

struct Calibration {
  counting::Counter counter;  ///< of all rooms, weighed, with the error to expect
  std::vector<WeighedRoom> rooms;
  double effective_rooms = 0.0;  ///< that carry the weight: 1 / sum of squares
  Verdict verdict = Verdict::too_little_told;
  double p = 1.0;  ///< of the verdict: share of rooms, and the log, that are as unlike the others
  std::vector<Statistic> statistics;
  std::vector<ParameterRange> parameters;
  double mean_error = 0.0;   ///< to expect; its interval is the counter's
  double error_alike = 0.0;  ///< the same if all rooms weighed alike
};

/// At this p or below no room makes such a log.
inline constexpr double verdict_level = 0.05;

/// Rooms, and all that doesn't depend on a log: their models, how well each is counted by the others', what their
/// motion tells. One pool serves many logs. Immutable, and cheap to copy.
class Pool {
 public:
  /// Threads change no bit. Throws as counting::train() does, and Error(input) for fewer than ten rooms.
  explicit Pool(std::vector<PoolRoom> rooms, const counting::Settings& settings = {}, unsigned threads = 0);
  [[nodiscard]] std::span<const PoolRoom> rooms() const noexcept;

  /// log: its days, with or without counts, which weigh the rooms; more days than rooms have say no more. days: those
  /// parts of it that are as the rooms' days are, which the verdict compares; none: too little is told.
  [[nodiscard]] Calibration calibrate(std::span<const counting::Stretch> log,
                                      std::span<const counting::Stretch> days) const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

// From a recipe and a log to rooms and stretches.

/// How long the sensors of a log hold motion, which the rooms' do too: seconds, none if the log doesn't tell. Rooms
/// have one hold. Throws Error(input) if those that are told differ by more than a tenth, or another sensor has shorter
/// pulses.
[[nodiscard]] std::optional<double> common_hold(const LogFacts& facts);
/// Overrides with which a recipe's dataset is a pool: a row a reading, and the hold that the log tells, if it does.
[[nodiscard]] std::vector<std::string> pool_overrides(const dataset::RecipeSpec& recipe, double step_s,
                                                      std::optional<double> hold_s);

/// Rows joined to readings: any motion in them, which what is unknown doesn't hide, and the people at their end.
[[nodiscard]] counting::Stretch readings_of(const dataset::RoomDayRows& rows, double step_s);
/// A finished dataset's rooms with as many sensors as the log has. Throws as dataset::read_room_days(), and
/// Error(input) if no room has so many.
[[nodiscard]] std::vector<PoolRoom> read_pool(const std::filesystem::path& folder, int n_sensors, double step_s,
                                              unsigned threads = 0);

/// Before hours of work on rooms that can't be weighed: throws Error(input) for a recipe of fewer than ten, and for one
/// whose rooms can't have so many sensors.
void require_rooms(const dataset::RecipeSpec& recipe, int n_sensors);

/// Hours of the day that a recipe simulates.
[[nodiscard]] Interval hours_of(const dataset::RecipeSpec& recipe);

/// What is compared of a log.
struct LogDays {
  std::vector<counting::Stretch> each;   ///< the hours of each day that the recipe simulates, which weigh the rooms
  std::vector<counting::Stretch> whole;  ///< those of which nine tenths are known of every sensor
  std::vector<std::string> partial;      ///< dates of those of which less is known, which aren't compared
};
/// Of a log without times of day all of it, as one.
[[nodiscard]] LogDays days_of(const LogRows& rows, const Interval& hours);
/// All of it, as one.
[[nodiscard]] counting::Stretch whole_log(const LogRows& rows);

/// What a counter remembers of the log that it comes from, and expects of those that it counts.
struct LogTraits {
  double interval_s = 0.0;                       ///< between readings; 0: events, or not told
  std::vector<std::string> sensors{};            ///< empty: not told
  std::vector<std::optional<double>> holds_s{};  ///< (sensors) none: the log doesn't tell; empty: of no sensor
};
[[nodiscard]] LogTraits traits_of(const LogFacts& facts);
void remember(const LogTraits& log, counting::Counter& counter);

/// A log as rooms are weighed by it.
struct WeighingLog {
  LogRows rows;  ///< readings, as the rooms have them
  LogTraits traits{};
  std::optional<double> hold_s{};  ///< for which the rooms' sensors hold motion; none: as the recipe says
};
/// step_s: of a reading; none: usual_window_s(). hold_s: of all sensors; none: as common_hold(). Throws as
/// common_hold(), and Error(usage) for a step shorter than the log's own.
[[nodiscard]] WeighingLog weighing_log(const Log& log, std::optional<double> step_s, std::optional<double> hold_s);
/// Weighs the rooms of a finished dataset. days: of the log, by the recipe's hours. The counter remembers the log.
[[nodiscard]] Calibration weigh_rooms(const std::filesystem::path& folder, const WeighingLog& log, const LogDays& days,
                                      const counting::Settings& settings = {}, unsigned threads = 0);

// What is written.

struct About {
  std::string recipe, log, made_by;
  Interval hours;
  std::size_t n_days = 0;            ///< of the log, that were compared
  std::vector<std::string> partial;  ///< days that weren't, as LogDays
  std::size_t n_counted = 0;         ///< its readings with counts
};

/// "1 day", or how many of several are compared, and which aren't.
[[nodiscard]] std::string days_compared(const About& about);

/// weights.csv, counter.json, calibration.json and calibration.html. Throws Error(io).
void write_calibration(const std::filesystem::path& folder, const Calibration& calibration, const About& about);
/// The recipe with its rooms drawn by weight, as YAML; paths in it are relative to the folder. recipe: as of the pool.
[[nodiscard]] std::string weighted_recipe(const dataset::RecipeSpec& recipe, const Calibration& calibration,
                                          const std::filesystem::path& folder);

/// How many rooms carry the weight, in a sentence.
[[nodiscard]] std::string how_much_it_told(const Calibration& calibration);
/// What the calibration found, in a sentence or two.
[[nodiscard]] std::string finding(const Calibration& calibration);

// A log counted.

inline constexpr double sure = 0.8;        ///< a number with such odds is told for sure: one of five may be another
inline constexpr double band_share = 0.9;  ///< of the odds, that the numbers told beside it have together

struct LogCounts {
  LogRows rows;  ///< windows of the counter's step
  counting::Estimates estimates;
  std::optional<Interval> expected_error;
  std::optional<counting::FiguresOff> figures_off;
  std::string warning{};               ///< the counter's
  std::vector<std::string> remarks{};  ///< what about this log the counter may not be made for
};
/// Throws Error(input) for a log that the counter isn't for: another number of sensors, others, or readings further
/// apart than its step.
[[nodiscard]] LogCounts count_log(const counting::Counter& counter, LogRows rows, const LogTraits& log,
                                  counting::Pass pass);

/// Mean absolute error, people.
struct CountError {
  double mean = 0.0, while_occupied = 0.0;
  std::size_t readings = 0, occupied = 0;  ///< occupied: with somebody, by the log's own counts
};
/// Against the log's own counts, if it has any.
[[nodiscard]] std::optional<CountError> error_of(const LogCounts& counts);
/// "wrong by 0.21 people on average, over 194 readings; by 0.44 over the 90 with somebody"
[[nodiscard]] std::string in_words(const CountError& error);
/// For how much of the time with somebody the number is told for sure, and for how much nobody knows, in a sentence or
/// two; nothing if nobody is there and all is known.
[[nodiscard]] std::string how_sure(const LogCounts& counts);

/// CSV: time of a reading's end, people, their mean, the band of nine in ten, and the probability of each count; empty
/// where nobody knows.
void write_counts(std::ostream& out, const LogCounts& counts);

// What people ask of it.

/// Of some readings, those that are told.
struct Figures {
  double told_h = 0.0;
  double occupied_h = 0.0;                 ///< with somebody, to be expected
  double nobody = 0.0, mean = 0.0;         ///< P(nobody), and people, on average; NaN of nothing
  int most = 0;                            ///< of the counts
  std::optional<std::size_t> first, last;  ///< readings with somebody, by the counts
};
[[nodiscard]] Figures figures_of(const counting::Estimates& estimates, std::size_t begin, std::size_t end,
                                 double step_s);

/// Readings of one date, or all of a log without dates.
struct CountedDay {
  std::string date{};
  std::size_t begin = 0, end = 0;
  Figures figures{};
  std::string arrival{}, departure{};  ///< when the first reading with somebody begins, and the last ends; or no text
  std::optional<counting::FiguresOff> off{};
};
/// An hour of the day, by local time, or of a log without: P(nobody), people, and the most of them, on average over the
/// days of which it is told.
struct CountedHour {
  int hour = 0, days = 0;
  double nobody = 0.0, mean = 0.0, most = 0.0;
  std::optional<counting::FiguresOff> off{};  ///< none: unknown, or nobody is there in such an hour
};
[[nodiscard]] std::vector<CountedDay> counted_days(const LogCounts& counts);
[[nodiscard]] std::vector<CountedHour> counted_hours(const LogCounts& counts);
/// CSV.
[[nodiscard]] std::string to_csv(std::span<const CountedDay> days);
[[nodiscard]] std::string to_csv(std::span<const CountedHour> hours);

/// Throws Error(io).
void write_counts_page(const std::filesystem::path& file, const LogCounts& counts, const std::string& log,
                       const std::string& made_by);

}  // namespace pirsim::calibrate

namespace pirsim {
template <>
[[nodiscard]] std::span<const Column<calibrate::CountedDay>> columns_of();
template <>
[[nodiscard]] std::span<const Column<calibrate::CountedHour>> columns_of();
}  // namespace pirsim
