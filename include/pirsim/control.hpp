// Light that motion sensors switch: what a delay costs people who sit in the dark, and what it costs in empty light.
// docs/howto/light.md
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pirsim/columns.hpp"
#include "pirsim/error.hpp"
#include "pirsim/interval.hpp"
#include "pirsim/sample.hpp"

namespace pirsim {
class Model;
struct SceneSpec;
}  // namespace pirsim

namespace pirsim::control {

// The rule by which light is switched, as plain data.

enum class Timer {
  restarts,  ///< every motion starts the delay anew
  runs_out   ///< only motion after the delay's end does, or in the very row in which it would go off
};

/// Several sensors have to report motion, at most so long after each other.
struct TogetherSpec {
  int sensors = 2;
  double within_s = 60.0;  ///< `assumed`; 0 to 300 tried
  bool operator==(const TogetherSpec&) const = default;
};

/// People switch the light on, who come into the dark or are left in it.
struct ManualSpec {
  double switch_s = 10.0;  ///< until they have done so (`assumed`; 0 to 60 tried)
  double grace_s = 15.0;   ///< so long after it went off, motion brings it back (`assumed`; 0 to 60 tried)
  bool operator==(const ManualSpec&) const = default;
};

/// Another delay from one hour of the day to another, over midnight if `to` is the earlier one.
struct NightSpec {
  double from_h = 22.0, to_h = 6.0;
  double delay_min = 2.0;
  bool operator==(const NightSpec&) const = default;
};

/// The light of one area, and the sensors that switch it.
struct LightSpec {
  std::string id = "light";
  std::string area;                      ///< whose people it is for; empty: all
  std::vector<std::string> sensors;      ///< none: all that the rows have
  std::optional<TogetherSpec> together;  ///< none: any one of them
  std::vector<double> delays_min{10.0};  ///< the first is what lit times and the worst moments are told of
  std::optional<ManualSpec> manual;      ///< none: motion switches it on
  std::optional<double> wave_s;          ///< who is in the dark has brought it back so long after; none: nobody does
  Timer timer = Timer::restarts;
  double least_on_min = 0.0;         ///< it is never lit for less
  std::string door;                  ///< motion while it is shut keeps the light on until it opens; empty: none
  double settle_s = 10.0;            ///< after it was shut, motion may be of who went out (`assumed`; 0 to 30 tried)
  std::optional<NightSpec> night;    ///< by the rows' clock
  double from_h = 0.0, to_h = 24.0;  ///< hours in which it is dark without light, by the rows' clock; as of a night
  double power_w = 0.0;              ///< 0: energy isn't told
  double at_most_a_week = 1.0;       ///< so often it may go off on somebody (`assumed`; 0.1 to 14 tried), for advise()
  Where where;
  bool operator==(const LightSpec&) const = default;
};

struct RuleSpec {
  std::string name = "light";
  std::vector<LightSpec> lights;
  bool operator==(const RuleSpec&) const = default;
};

/// docs/formats/control.md. Throws Error (io, input, usage) with every fault.
[[nodiscard]] RuleSpec read_rule(const std::filesystem::path& file, std::span<const std::string> overrides = {});
[[nodiscard]] RuleSpec parse_rule(std::string_view text, const std::string& name);

/// The rule that is given, whose lights of areas that name no sensors get those that watch them in the scene. Without
/// one a light for each area of the scene, one for all without areas, called by this name; areas without sensors are
/// remarks. Without a scene, too, one by any sensor. Throws Error(input) if no area of the scene has a sensor.
[[nodiscard]] RuleSpec rule_for(std::optional<RuleSpec> given, const SceneSpec* scene, const std::string& name,
                                std::vector<Issue>& remarks);
/// A remark for each light in whose area somebody at work is noticed in none of some seats by its sensors: who is alone
/// there sits in the dark at any delay. model: what made the rows.
[[nodiscard]] std::vector<Issue> deaf_seats(const RuleSpec& rule, const Model& model);

// What it costs.

/// Over some days: a number, NaN of nothing, and the middle 90 % of what days drawn with replacement give; none for
/// less than three. Of events that never came, the interval ends at three in all hours: where a chance of 5 % remains
/// to see none.
struct Figure {
  double value = 0.0;
  std::optional<Interval> over_days{};
};

/// Of one light and one delay. What needs to know where people are is NaN, and no false-offs are counted, if the rows
/// don't tell.
struct DelayCosts {
  double delay_min = 0.0;
  std::optional<double>
      nobody{};        ///< instead of a delay: it goes off once a counter gives so much to nobody being there
  double lit_h = 0.0;  ///< in all
  double switched_on_a_day = 0.0;
  Figure lit_share;           ///< of all hours
  double lit_empty_h = 0.0;   ///< while nobody was there
  double dark_h = 0.0;        ///< while somebody was there
  double false_offs = 0.0;    ///< how often it went off while somebody was there; of a counter's rows to be expected
  Figure false_offs_an_hour;  ///< of occupied time
  Figure dark_share;          ///< of occupied time
  Figure empty_share;         ///< lit while nobody was there, of all hours
  double longest_dark_s = 0.0;
  double mean_wait_s = 0.0, longest_wait_s = 0.0;  ///< from coming into an empty area to light; NaN: nobody came
};

/// Somebody was in the dark.
struct DarkSpell {
  int replicate = 0;
  std::string trial;
  double from_s = 0.0;  ///< of the run
  std::string clock;    ///< or no text
  double length_s = 0.0;
  enum class Cause { went_off, stayed_off } cause = Cause::went_off;
};

enum class People {
  known,
  unknown,
  expected  ///< as a counter estimates them: intervals are over who may have been there
};

struct LightCosts {
  std::string id;
  std::vector<std::string> sensors;  ///< that switch it
  std::vector<double> rule_delays_min;
  People people = People::known;
  std::int64_t days = 0;
  /// What "a day" divides by: days less what isn't known of them, a run of more than 24 h by its hours, dates by the
  /// part that the rows cover, but a day at least.
  double known_days = 0.0;
  double hours = 0.0;  ///< that count: of rows in which all of its sensors are known
  double unknown_h = 0.0;
  double asleep_h = 0.0;    ///< in which everybody there sleeps or goes to bed, who wants no light: not occupied
  double occupied_h = 0.0;  ///< NaN, as the next one, if the rows have no people
  double span_h = 0.0;      ///< from a day's first person to its last: who switches by hand, and not between
  double power_w = 0.0;
  double at_most_a_week = 1.0;          ///< as the rule has it
  std::vector<DelayCosts> by_delay;     ///< in order: every minute up to an hour, and the rule's
  std::vector<DelayCosts> by_nobody{};  ///< of expected people, in order of `nobody`
  std::vector<DarkSpell> worst;         ///< of the first delay, the longest first; ten at most

  [[nodiscard]] const DelayCosts& at(double delay_min) const;  ///< of one that is there
  [[nodiscard]] double a_day(double sum) const;                ///< 0 where nothing is known
};

/// The shortest delay from which on a light goes off on somebody less often than the rule allows.
struct Advice {
  enum class Ground {
    shown,           ///< the upper end of the rate is below it too (95 %; over days, and by Poisson's law)
    too_few_days,    ///< the rate alone is: the best guess
    no_delay,        ///< of those tried is long enough
    nobody_came,     ///< or nothing is known
    unknown_people,  ///< the rows don't tell
  };
  Ground ground = Ground::nobody_came;
  std::optional<double> delay_min{};  ///< of the first two
  std::string sentence;               ///< which delay to take and what it costs, or why that can't be told
  /// Of too_few_days: the part of the sentence that says how many days would do, and the sentence without it.
  std::string doubt{}, rest{};
};
[[nodiscard]] Advice advise(const LightCosts& light);
/// A sentence a light; a doubt that several share is in the first of them alone.
[[nodiscard]] std::vector<std::string> advise_all(std::span<const LightCosts> lights);

struct Costs {
  std::string rule;
  double window_s = 0.0;
  std::vector<LightCosts> lights;
  std::vector<Issue> remarks;
};

/// Whether each light is on in a row, by its first delay.
struct LitRow {
  std::span<const std::uint8_t> lit;     ///< (n_lights) 0 or 1; 2: its sensors aren't known
  std::span<const std::int32_t> people;  ///< (n_lights) of its area, -1: not known
  std::optional<std::int64_t> ends_s{};  ///< by the rows' clock, since 1970-01-01T00:00
};

/// Switches lights row by row. Memory grows with the number of days alone.
class Control {
 public:
  /// columns: what the rows have. people: whether they tell it. Throws Error(input) for sensors, areas and doors that
  /// the rows don't have, for a rule that asks for more sensors than a light has, and for one by people without such.
  Control(RuleSpec rule, ColumnOwners columns, double window_s, People people = People::known);
  ~Control();
  Control(Control&&) noexcept;

  /// The next row is of another run, whatever its replicate and trial.
  void begin_run() noexcept;
  /// In order of time. A bit of 2 isn't known, people of -1 neither. A light isn't in rooms that have none of its
  /// sensors, or not its door (bits of 3), or not its area (people of -2). A new replicate or trial begins in the dark.
  /// day: what intervals are over; a run if it is empty. nobody: of expected people, the probability that nobody is
  /// there, by this row and those before it. Throws Error(input) for a clock that tells no time.
  LitRow add(const Sample& row, std::string_view day = {}, double nobody = 0.0);
  /// So many of the rows that were added stand for ones that are missing.
  void note_missing(std::int64_t n_rows) noexcept;
  [[nodiscard]] Costs finish() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The rule, each light with the delay that is advised and the sentence about it, as YAML that read_rule() takes.
/// Lights without advice keep theirs. costs: of the rule.
[[nodiscard]] std::string advised_rule(RuleSpec rule, const Costs& costs);

/// Costs in (draws) of who may have been there, all as likely: their means, each with the middle 90 % of the draws. No
/// moments in the dark are told.
[[nodiscard]] Costs expected_of(std::span<const Costs> draws);

/// A row of the table of costs; docs/formats/control.md.
struct CostLine {
  const LightCosts& light;
  const DelayCosts& at;
};
[[nodiscard]] std::string to_csv(const Costs& costs);

}  // namespace pirsim::control

namespace pirsim {
template <>
[[nodiscard]] std::span<const Column<control::CostLine>> columns_of();
}
