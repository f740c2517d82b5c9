// Counting people from motion: hidden Markov models of many simulated rooms, mixed as a log of the real one weighs
// them. docs/counting.md
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/interval.hpp"
#include "pirsim/sample.hpp"

namespace pirsim::counting {

using pirsim::unknown_bit;
inline constexpr int unknown_count = unknown_people;

/// Readings of one room at equal steps, one after the other.
struct Stretch {
  int n_sensors = 0;
  std::vector<std::uint8_t> motion;  ///< (readings x sensors) 0, 1 or unknown_bit
  std::vector<int> people{};         ///< (readings), unknown_count where nobody counted; empty: nowhere
  [[nodiscard]] std::size_t n_readings() const {
    return n_sensors == 0 ? 0 : motion.size() / static_cast<std::size_t>(n_sensors);
  }
};

/// A simulated room that a counter learns from, with the people of every reading.
struct LabelledRoom {
  int number = 0;
  std::vector<Stretch> days;
};

/// Fitted on simulated rooms, each left out in turn; docs/counting.md tells how.
struct Settings {
  double step_s = 30.0;       ///< between readings
  int modes = 4;              ///< of a number of people: from quiet to busy
  double shrinkage = 60.0;    ///< pseudo-readings by which a room's emissions and moves are drawn to those of all rooms
  int iterations = 40;        ///< of the Baum-Welch algorithm
  double weight_power = 0.2;  ///< of the log's likelihood in a room's weight
  /// Odds of motion while somebody is there, of the versions of each room's model among which a log chooses.
  std::vector<double> livelinesses{0.25, 0.5, 1.0, 2.0, 4.0};
};

// A hidden Markov model. A state is a number of people in one mode: state = count * modes + mode. A symbol is how many
// of the room's sensors report motion in a reading.

struct RoomModel {
  int number = 0;
  double weight = 1.0;            ///< they add up to 1
  std::vector<double> first;      ///< (states) probability at the first reading
  std::vector<double> moves;      ///< (states x states) probability from one reading to the next, from row to column
  std::vector<double> emissions;  ///< (states x symbols)
  double liveliness = 1.0;        ///< odds of a sensor's motion while somebody is there, times those in the room
};

/// How far off a figure is in rooms that are left out: on average, and in nine of ten cases at most.
struct Off {
  double mean = 0.0, most = 0.0;
};
/// Of what people ask of a log counted: of a day, and, over as many days as the rooms have, of an hour of the day.
struct FiguresOff {
  Off occupied_h, arrival_min, departure_min, most;
  Off hour_nobody, hour_mean, hour_most;
};
struct FigureName {
  const char* name;
  Off FiguresOff::*off;
};
inline constexpr FigureName figure_names[]{
    {"occupied_h", &FiguresOff::occupied_h},       {"arrival_min", &FiguresOff::arrival_min},
    {"departure_min", &FiguresOff::departure_min}, {"most", &FiguresOff::most},
    {"hour_nobody", &FiguresOff::hour_nobody},     {"hour_mean", &FiguresOff::hour_mean},
    {"hour_most", &FiguresOff::hour_most}};

/// Plain and immutable once made.
struct Counter {
  Settings settings;
  int n_sensors = 1;
  int n_counts = 1;                         ///< 0, 1, ..., n_counts - 1 people
  std::vector<RoomModel> rooms;             ///< perhaps at several livelinesses each
  std::optional<Interval> expected_error;   ///< 90 %, mean absolute error in people; docs/howto/own_room.md
  std::optional<FiguresOff> figures_off{};  ///< of days like the rooms', smoothed
  std::string warning{};                    ///< why its counts can't be relied on; empty: nothing is known against them
  // Of the log that it was calibrated by; empty: it wasn't, or its file doesn't tell.
  std::vector<std::string> sensors{};
  std::vector<std::optional<double>> holds_s{};  ///< (sensors) for which they hold motion; none: the log didn't tell
  [[nodiscard]] int n_states() const { return n_counts * settings.modes; }
  [[nodiscard]] int n_symbols() const { return n_sensors + 1; }
};

/// Baum-Welch with known counts: emissions and moves a room, drawn to those of all. Threads change no bit. Throws
/// Error(input) for no room, rooms without people, and rooms that don't have as many sensors.
[[nodiscard]] Counter train(std::span<const LabelledRoom> rooms, const Settings& settings, unsigned threads = 0);

/// Each room's model at every liveliness of the settings, room by room, which share its weight. Throws Error(usage) if
/// 1 isn't among these, or twice.
[[nodiscard]] Counter at_livelinesses(const Counter& counter);

/// (rooms) of the stretches, each begun anew. Readings that are unknown count nothing; counts that are known are held
/// to.
[[nodiscard]] std::vector<double> log_likelihoods(const Counter& counter, std::span<const Stretch> stretches);
/// Rooms by how well they explain a log; a likelihood may be minus infinity.
void weigh(Counter& counter, std::span<const double> log_likelihoods);

enum class Pass {
  forward,  ///< each reading by those before it: as it could have been told then
  smoothed  ///< by those after it as well
};

/// Nothing is known of any sensor for longer than this: so long after a reading the number is still the same in four of
/// five, so much later it is what the rooms' days are like. Assumed, by the moves of counters of an office, of which 76
/// to 86 % stay for 5 min, 61 to 76 % for 10.
inline constexpr double longest_guess_s = 300.0;
/// (readings) 1: something is known at it, or was known at most longest_guess_s before it; smoothed, or is known at
/// most so long after it.
[[nodiscard]] std::vector<char> told_readings(const Stretch& stretch, double step_s, Pass pass);

/// Of each reading.
struct Estimates {
  int n_counts = 1;
  std::vector<double> probabilities;  ///< (readings x counts), NaN where the reading isn't told
  [[nodiscard]] bool is_told(std::size_t reading) const;
  /// The least count that as many people or fewer have at least even odds of: it makes the absolute error least.
  /// unknown_count where the reading isn't told.
  [[nodiscard]] int count(std::size_t reading) const {
    return is_told(reading) ? quantile(reading, 0.5) : unknown_count;
  }
  /// The least count that as many people or fewer have at least this share of the odds of; of a reading that is told.
  [[nodiscard]] int quantile(std::size_t reading, double share) const;
  /// The shortest run of counts that has at least this share of the odds, and of those as short the likeliest; of a
  /// reading that is told.
  struct Band {
    int least = 0, most = 0;
  };
  [[nodiscard]] Band band(std::size_t reading, double share) const;
};

[[nodiscard]] Estimates estimate(const Counter& counter, const Stretch& stretch, Pass pass);

/// (draws)(readings) how many people there may have been, each course as likely as the counter holds it to be: a room
/// by weight, its states from the last reading back to the first [Scott2002]. Counts that are known are held to;
/// unknown_count where a smoothed reading isn't told.
[[nodiscard]] std::vector<std::vector<int>> draw_people(const Counter& counter, const Stretch& stretch, int n_draws);

/// Counts reading by reading, as they come; the same as Pass::forward. The counter outlives it.
class LiveCount {
 public:
  explicit LiveCount(const Counter& counter);
  /// (counts) after one more reading of (sensors) bits; NaN as in Estimates. Throws Error(usage) for another number of
  /// sensors.
  std::vector<double> next(std::span<const std::uint8_t> bits);

 private:
  const Counter* counter_;
  std::vector<double> belief_;  ///< (rooms x states), empty before the first reading
  double unknown_s_;            ///< since something was known; infinite: never
};

/// As JSON; docs/formats/counter.md. Throws Error: io, input (with what isn't as expected).
void write_counter(const std::filesystem::path& file, const Counter& counter);
[[nodiscard]] Counter read_counter(const std::filesystem::path& file);
/// The same in two steps, so that a pipe is read once: any file that is no larger than a counter may be, and a counter
/// of its bytes; `name` stands in messages.
[[nodiscard]] std::string read_counter_bytes(const std::filesystem::path& file);
[[nodiscard]] Counter parse_counter(std::string_view bytes, const std::string& name);

}  // namespace pirsim::counting
