#include "surveys/light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/sim/compiled_study.hpp"
#include "files/disk/file.hpp"
#include "files/read/reader_parts.hpp"
#include "files/write/script_writer.hpp"
#include "model/core/text.hpp"
#include "model/schema/check_scene.hpp"
#include "model/schema/clock.hpp"
#include "model/schema/words.hpp"
#include "pirsim/control.hpp"
#include "pirsim/look.hpp"
#include "pirsim/random.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/scene.hpp"
#include "surveys/light_fields.hpp"
#include "surveys/sight.hpp"

// What is summed up of a light, and figures over days.

namespace pirsim::control {
namespace {

constexpr std::size_t n_draws = 400, fewest_days = 3;
constexpr double middle = 0.9;

/// Of values, at least one.
Interval middle_of(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
  };
  return {at(0.5 - 0.5 * middle), at(0.5 + 0.5 * middle)};
}

/// Of one day and delay, in rows.
struct DelaySums {
  std::int32_t lit = 0, lit_empty = 0, dark = 0, false_offs = 0, switched_on = 0;
};

/// Of a run nothing is left out; of a date there may be rows of a part alone.
enum class DayKind { run, date };

/// Of one day.
struct DaySums {
  DayKind kind = DayKind::run;
  std::int32_t all = 0, rows = 0, unknown = 0, occupied = 0;  ///< all: by daylight too; rows: that count
  std::int32_t asleep = 0;                                    ///< with people all of whom sleep or go to bed
  std::int32_t first_occupied = -1, last_occupied = -1;       ///< of the rows that count; -1: nobody came
  std::vector<DelaySums> by_delay;
  [[nodiscard]] std::int32_t span() const { return first_occupied < 0 ? 0 : last_occupied - first_occupied + 1; }
};

/// Days drawn with replacement: how often each is drawn, (draws x days); the same for every figure.
class DrawnDays {
 public:
  explicit DrawnDays(std::size_t n_days);
  /// The sum of `above` over that of `below`, NaN without any of that. (n_days) each. No interval if all of `above` is
  /// 0: draws of it are 0, too.
  [[nodiscard]] Figure ratio(const std::vector<double>& above, const std::vector<double>& below) const;
  /// Events an hour, as ratio(). Without events its interval ends where a chance of 5 % remains to see none, if they
  /// come independently of each other: at 3 in all hours [Hanley1983].
  [[nodiscard]] Figure rate(const std::vector<double>& events, const std::vector<double>& hours) const;

 private:
  std::size_t n_days_;
  std::vector<std::uint16_t> times_;
};

DrawnDays::DrawnDays(std::size_t n_days) : n_days_(n_days) {
  if (n_days < fewest_days) return;
  times_.resize(n_draws * n_days, 0);
  Stream stream({1, 0, 0, Purpose::drawn_days});
  for (std::size_t draw = 0; draw < n_draws; ++draw) {
    for (std::size_t i = 0; i < n_days; ++i) ++times_[draw * n_days + stream.index(static_cast<std::uint32_t>(n_days))];
  }
}

Figure DrawnDays::ratio(const std::vector<double>& above, const std::vector<double>& below) const {
  const double all = std::accumulate(below.begin(), below.end(), 0.0);
  if (!(all > 0.0)) return {std::nan(""), {}};
  Figure figure{std::accumulate(above.begin(), above.end(), 0.0) / all, {}};
  if (figure.value == 0.0) return figure;
  std::vector<double> ratios;
  for (std::size_t draw = 0; draw < times_.size() / std::max<std::size_t>(1, n_days_); ++draw) {
    double numerator = 0.0, denominator = 0.0;
    for (std::size_t day = 0; day < n_days_; ++day) {
      numerator += times_[draw * n_days_ + day] * above[day];
      denominator += times_[draw * n_days_ + day] * below[day];
    }
    if (denominator > 0.0) ratios.push_back(numerator / denominator);
  }
  if (!ratios.empty()) figure.over_days = middle_of(std::move(ratios));
  return figure;
}

Figure DrawnDays::rate(const std::vector<double>& events, const std::vector<double>& hours) const {
  Figure figure = ratio(events, hours);
  const double all = std::accumulate(hours.begin(), hours.end(), 0.0);
  if (figure.value == 0.0 && n_days_ >= fewest_days && all > 0.0)
    figure.over_days = Interval{0.0, -std::log(0.5 - 0.5 * middle) / all};
  return figure;
}

constexpr int curve_min = 60;  ///< delays of the curve, minute by minute
constexpr std::size_t most_worst = 10;

/// Minutes, in order: those of the curve and the rule's.
std::vector<double> delays_of(const LightSpec& light) {
  std::vector<double> delays(curve_min + 1);
  std::iota(delays.begin(), delays.end(), 0.0);
  delays.insert(delays.end(), light.delays_min.begin(), light.delays_min.end());
  std::ranges::sort(delays);
  delays.erase(std::ranges::unique(delays).begin(), delays.end());
  return delays;
}

/// A light that goes by a counter goes off at these probabilities that nobody is there.
constexpr std::array nobody_levels{0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99};

/// Where a light finds what it goes by.
struct Columns {
  std::vector<std::size_t> sensors;
  std::vector<std::string> names;  ///< of the sensors
  std::optional<std::size_t> area, door;
};

template <typename Names>
std::optional<std::size_t> find(const Names& names, const std::string& name, const std::string& kind,
                                const LightSpec& light, Diagnostics& faults) {
  const auto at = std::ranges::find(names, name);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  faults.error(light.where,
               "light '" + light.id + "': the rows have no " + kind + " '" + name + "'" + near_or_all(name, names));
  return std::nullopt;
}

Columns columns_for(const LightSpec& light, const ColumnOwners& owners, Diagnostics& faults) {
  Columns columns;
  for (const std::string& sensor : light.sensors) {
    if (const auto at = find(owners.sensors, sensor, "sensor", light, faults)) columns.sensors.push_back(*at);
  }
  if (light.sensors.empty()) {
    columns.sensors.resize(owners.sensors.size());
    std::iota(columns.sensors.begin(), columns.sensors.end(), std::size_t{0});
  }
  columns.names = light.sensors.empty() ? owners.sensors : light.sensors;
  if (!light.area.empty()) columns.area = find(owners.areas, light.area, "people of an area", light, faults);
  if (!light.door.empty()) columns.door = find(owners.doors, light.door, "door", light, faults);
  const std::size_t n = light.sensors.empty() ? owners.sensors.size() : light.sensors.size();
  if (light.together && static_cast<std::size_t>(light.together->sensors) > n) {
    faults.error(light.where, "light '" + light.id + "': together: " +
                                  counted(static_cast<std::size_t>(light.together->sensors), "sensor") + " of " +
                                  std::to_string(n));
  }
  return columns;
}

/// At the end of a row, since 1970; none without a clock.
std::optional<std::int64_t> clock_s(const Sample& row) {
  if (row.clock.empty()) return std::nullopt;
  constexpr std::size_t whole_seconds = 19;
  if (const auto clock = clock_from(row.clock.substr(0, whole_seconds))) return clock->begin_s;
  throw Error(ErrorCode::input, "the time '" + row.clock + "' of a row is none: expected one like 2026-03-02T08:30:00");
}

/// Does a row that ends at this hour lie between them? At midnight it is the end of the day before.
bool is_between(double hour, double from_h, double to_h) {
  if (hour == 0.0) hour = 24.0;
  return from_h <= to_h ? from_h < hour && hour <= to_h : from_h < hour || hour <= to_h;
}

/// One light at all delays, from row to row.
class Light {
 public:
  Light(const LightSpec& spec, Columns columns, double window_s, People people)
      : spec_(spec),
        columns_(std::move(columns)),
        window_s_(window_s),
        rule_(spec, window_s),
        delays_min_(delays_of(spec)) {
    for (const double delay_min : delays_min_) delay_rows_.push_back(rows_of(60.0 * delay_min));
    if (spec.night) night_rows_ = rows_of(60.0 * spec.night->delay_min);
    if (spec.together) together_rows_ = rows_of(spec.together->within_s);
    settle_rows_ = 1 + static_cast<std::int64_t>(std::ceil(spec.settle_s / window_s));
    chosen_ = static_cast<std::size_t>(std::ranges::find(delays_min_, spec.delays_min.front()) - delays_min_.begin());
    n_switches_ = delays_min_.size() + (people == People::expected ? nobody_levels.size() : 0);
    waits_.resize(n_switches_);
    longest_dark_.resize(n_switches_, 0);
    begin();
  }

  /// In the dark, after nothing.
  void begin() {
    switches_.assign(n_switches_, {});
    last_motion_.assign(columns_.sensors.size(), never);
    last_behind_ = last_motion_;
    is_on_.assign(columns_.sensors.size(), true);  // since before, if it is in the first row
    began_behind_.assign(columns_.sensors.size(), false);
    row_ = gap_rows_ = 0;
    open_at_ = -1;  // just shut when the run began, if it is shut at all
    begin_people();
  }
  void begin_day(DayKind kind) {
    days_.push_back({.kind = kind, .by_delay = decltype(DaySums::by_delay)(n_switches_)});
  }

  /// 0, 1, or 2 where not known. hour: of the day at its end. nobody: the probability that nobody is there.
  std::uint8_t add(const Sample& row, int people, std::optional<double> hour, double nobody) {
    ++row_;
    DaySums& day = days_.back();
    if (!is_here(row, people)) return unknown_bit;
    ++day.all;
    if (hour && !is_between(*hour, spec_.from_h, spec_.to_h)) {  // light from outside
      begin();
      return 0;
    }
    const bool is_asleep = people > 0 && sleep_all(row.phase, spec_.area);
    const auto [cue, is_known] = cue_of(row, is_asleep ? 0 : people);
    gap_rows_ = is_known ? 0 : gap_rows_ + 1;
    if (!is_known || people < 0) {
      ++day.unknown;
      pass(cue, is_night(hour), nobody);
      return unknown_bit;
    }
    ++day.rows;
    day.asleep += is_asleep ? 1 : 0;
    if (cue.occupied) {
      ++day.occupied;
      if (day.first_occupied < 0) day.first_occupied = day.rows;
      day.last_occupied = day.rows;
    }
    const bool comes = cue.occupied && !was_occupied_;
    for (std::size_t i = 0; i < switches_.size(); ++i)
      step(i, cue, delay_of(i, is_night(hour), nobody), comes, day.by_delay[i]);
    was_occupied_ = cue.occupied;
    const bool is_lit = switches_[chosen_].is_lit();
    note_spell(row, cue.occupied && !is_lit);
    return is_lit ? 1 : 0;
  }

  [[nodiscard]] int people_of(const Sample& row) const {
    return columns_.area ? row.people_of_areas[*columns_.area] : row.people;
  }

  [[nodiscard]] LightCosts costs(People people) const;

 private:
  static constexpr std::int64_t never = -1'000'000'000;
  struct Waits {
    std::int64_t n = 0, rows = 0, longest = 0;
    void add(std::int64_t wait) {
      ++n;
      rows += wait;
      longest = std::max(longest, wait);
    }
  };

  /// Nothing is known of who was in the dark before.
  void begin_people() {
    entered_.assign(n_switches_, -1);
    dark_for_.assign(n_switches_, 0);
    was_occupied_ = true;  // who is there already didn't come in
    end_spell();
  }

  /// Does the row's room have what the light goes by? Of its sensors as many as have to report motion are enough.
  [[nodiscard]] bool is_here(const Sample& row, int people) const {
    if (people == absent_people || (columns_.door && row.doors[*columns_.door] == absent_bit)) return false;
    const auto n =
        std::ranges::count_if(columns_.sensors, [&](std::size_t sensor) { return row.bits[sensor] != absent_bit; });
    return n >= (spec_.together ? spec_.together->sensors : 1);
  }

  [[nodiscard]] bool is_night(std::optional<double> hour) const {
    return spec_.night && hour && is_between(*hour, spec_.night->from_h, spec_.night->to_h);
  }
  /// Where it goes by a counter the delay never ends, or has.
  [[nodiscard]] std::int64_t delay_of(std::size_t i, bool is_night, double nobody) const {
    constexpr std::int64_t never_ends = -never;
    if (i >= delay_rows_.size()) return nobody < nobody_levels[i - delay_rows_.size()] ? never_ends : 0;
    return is_night ? night_rows_ : delay_rows_[i];
  }

  /// A row that isn't counted. Where the sensors aren't known the light goes on as if nothing moved, and anew once that
  /// lasts longer than the delay.
  void pass(const Cue& cue, bool is_night, double nobody) {
    if (gap_rows_ > std::max(delay_rows_.back(), night_rows_) + 1) return;  // all has begun anew
    for (std::size_t i = 0; i < switches_.size(); ++i) {
      const std::int64_t delay_rows = delay_of(i, is_night, nobody);
      if (gap_rows_ > delay_rows)
        switches_[i] = {};
      else
        switches_[i].advance(rule_, cue, delay_rows);
    }
    begin_people();
  }

  [[nodiscard]] std::int64_t rows_of(double seconds) const { return std::llround(seconds / window_s_); }

  struct Reading {
    Cue cue;
    bool is_known = true;  ///< all sensors are, and the door; else nothing moves
  };
  Reading cue_of(const Sample& row, int people) {
    Reading reading;
    Cue& cue = reading.cue;
    cue.occupied = people > 0;
    cue.is_open = !columns_.door || row.doors[*columns_.door] != 0;
    reading.is_known = !columns_.door || row.doors[*columns_.door] != unknown_bit;
    if (cue.is_open) open_at_ = row_;
    for (std::size_t i = 0; i < columns_.sensors.size(); ++i) {
      const std::uint8_t bit = row.bits[columns_.sensors[i]];
      reading.is_known = reading.is_known && bit != unknown_bit;
      // A pulse that began before the door had settled may hold for minutes after whoever made it went out.
      if (bit != 0 && !is_on_[i] && row_ - open_at_ > settle_rows_) began_behind_[i] = true;
      if (bit == 0 || cue.is_open) began_behind_[i] = false;
      is_on_[i] = bit != 0;
      if (bit != 1) continue;
      last_motion_[i] = row_;
      if (began_behind_[i]) last_behind_[i] = row_;
    }
    cue.moved = reading.is_known && is_enough(last_motion_);
    cue.is_behind = reading.is_known && is_enough(last_behind_);
    return reading;
  }

  /// Of as many sensors as have to. Motion that was together starts nothing anew while nobody moves on.
  [[nodiscard]] bool is_enough(const std::vector<std::int64_t>& last_rows) const {
    const auto moved = std::ranges::count_if(last_rows, [&](std::int64_t l) { return row_ - l <= together_rows_; });
    return moved >= (spec_.together ? spec_.together->sensors : 1) &&
           std::ranges::find(last_rows, row_) != last_rows.end();
  }

  void step(std::size_t i, const Cue& cue, std::int64_t delay_rows, bool comes, DelaySums& sums) {
    LightSwitch& light = switches_[i];
    const bool was_lit = light.is_lit();
    light.advance(rule_, cue, delay_rows);
    const bool is_lit = light.is_lit();
    if (is_lit) {
      ++sums.lit;
      sums.lit_empty += cue.occupied ? 0 : 1;
      sums.switched_on += was_lit ? 0 : 1;
      dark_for_[i] = 0;
    } else {
      if (was_lit && cue.occupied) ++sums.false_offs;
      sums.dark += cue.occupied ? 1 : 0;
      dark_for_[i] = cue.occupied ? dark_for_[i] + 1 : 0;
      longest_dark_[i] = std::max(longest_dark_[i], dark_for_[i]);
    }
    if (comes) entered_[i] = row_;
    if (entered_[i] < 0) return;
    if (is_lit) waits_[i].add(row_ - entered_[i]);
    if (is_lit || !cue.occupied) entered_[i] = -1;
  }

  void note_spell(const Sample& row, bool is_dark) {
    if (!is_dark) {
      end_spell();
      spell_follows_light_ = switches_[chosen_].is_lit();
      return;
    }
    if (!spell_) {
      spell_ = DarkSpell{
          row.replicate, row.trial, row.time_s - window_s_,
          row.clock,     0.0,       spell_follows_light_ ? DarkSpell::Cause::went_off : DarkSpell::Cause::stayed_off};
    }
    spell_->length_s += window_s_;
  }
  void end_spell() {
    if (!spell_) return;
    const auto at =
        std::ranges::find_if(worst_, [&](const DarkSpell& other) { return other.length_s < spell_->length_s; });
    worst_.insert(at, *spell_);
    if (worst_.size() > most_worst) worst_.pop_back();
    spell_.reset();
  }

  LightSpec spec_;
  Columns columns_;
  double window_s_;
  SwitchRule rule_;
  std::vector<double> delays_min_;
  std::vector<std::int64_t> delay_rows_;
  std::int64_t night_rows_ = 0, together_rows_ = 0;
  std::int64_t settle_rows_ = 0;  ///< from the last one that its door was open in: it shuts in the next
  std::size_t chosen_ = 0;        ///< of the delays
  std::size_t n_switches_ = 0;    ///< those of the delays, then those by a counter
  std::vector<LightSwitch> switches_;
  std::vector<std::int64_t> entered_, dark_for_;
  std::vector<std::int64_t> last_motion_, last_behind_;  ///< (n_sensors) rows; behind: that began behind the shut door
  std::vector<bool> is_on_, began_behind_;               ///< (n_sensors) the bit, or it isn't known; its pulse
  std::int64_t open_at_ = -1;                            ///< the last row in which its door was open
  bool was_occupied_ = true;
  std::int64_t row_ = 0, gap_rows_ = 0;  ///< gap: rows of which nothing is known, up to now
  std::vector<DaySums> days_;
  std::vector<Waits> waits_;
  std::vector<std::int64_t> longest_dark_;
  std::optional<DarkSpell> spell_;
  bool spell_follows_light_ = false;
  std::vector<DarkSpell> worst_;
};

LightCosts Light::costs(People people) const {
  const double row_h = window_s_ / 3600.0;
  LightCosts costs;
  costs.id = spec_.id;
  costs.sensors = columns_.names;
  costs.rule_delays_min = spec_.delays_min;
  costs.people = people;
  costs.power_w = spec_.power_w;
  costs.at_most_a_week = spec_.at_most_a_week;
  costs.worst = worst_;
  if (spell_) {
    Light ended = *this;  // a spell that the rows break off
    ended.end_spell();
    costs.worst = ended.worst_;
  }
  std::vector<const DaySums*> days;  // that tell something
  for (const DaySums& day : days_) {
    costs.unknown_h += day.unknown * row_h;
    costs.asleep_h += day.asleep * row_h;
    if (day.rows > 0) days.push_back(&day);
  }
  costs.days = static_cast<std::int64_t>(days.size());
  const double dark_h = spec_.to_h - spec_.from_h + (spec_.to_h < spec_.from_h ? 24.0 : 0.0);
  double covered = 0.0;  // days
  std::vector<double> hours, occupied;
  for (const DaySums* day : days) {
    hours.push_back(day->rows * row_h);
    occupied.push_back(day->occupied * row_h);
    costs.hours += hours.back();
    costs.occupied_h += occupied.back();
    costs.span_h += day->span() * row_h;
    const double in_rows = day->rows + day->unknown;
    const double of_it = day->kind == DayKind::run ? std::max(1.0, day->all * row_h / 24.0) : in_rows * row_h / dark_h;
    covered += of_it;
    costs.known_days += of_it * day->rows / in_rows;
  }
  if (covered > 0.0 && covered < 1.0) costs.known_days /= covered;  // an hour tells nothing of the others
  const bool knows = people != People::unknown;
  const auto if_known = [knows](double value) { return knows ? value : std::nan(""); };
  if (!knows) occupied.assign(occupied.size(), 0.0);
  costs.occupied_h = if_known(costs.occupied_h), costs.span_h = if_known(costs.span_h);
  const DrawnDays drawn(days.size());
  for (std::size_t i = 0; i < n_switches_; ++i) {
    const bool is_delay = i < delays_min_.size();
    DelayCosts& at = (is_delay ? costs.by_delay : costs.by_nobody).emplace_back();
    at.delay_min = is_delay ? delays_min_[i] : std::nan("");
    if (!is_delay) at.nobody = nobody_levels[i - delays_min_.size()];
    std::vector<double> lit, dark, empty, offs;
    double switched_on = 0.0;
    for (const DaySums* day : days) {
      const DelaySums& sums = day->by_delay[i];
      lit.push_back(sums.lit * row_h);
      dark.push_back(sums.dark * row_h);
      offs.push_back(sums.false_offs);
      at.lit_h += lit.back();
      empty.push_back(sums.lit_empty * row_h);
      at.lit_empty_h += empty.back();
      at.dark_h += dark.back();
      at.false_offs += sums.false_offs;
      switched_on += sums.switched_on;
    }
    at.lit_empty_h = if_known(at.lit_empty_h), at.dark_h = if_known(at.dark_h);
    at.switched_on_a_day = costs.a_day(switched_on);
    at.lit_share = drawn.ratio(lit, hours);
    at.false_offs_an_hour = drawn.rate(offs, occupied);
    at.dark_share = drawn.ratio(dark, occupied);
    if (knows)
      at.empty_share = drawn.ratio(empty, hours);
    else
      at.empty_share.value = std::nan("");
    at.longest_dark_s = if_known(static_cast<double>(longest_dark_[i]) * window_s_);
    const Waits& waits = waits_[i];
    const double each_s = waits.n > 0 ? window_s_ / static_cast<double>(waits.n) : std::nan("");
    at.mean_wait_s = static_cast<double>(waits.rows) * each_s;
    at.longest_wait_s = waits.n > 0 ? static_cast<double>(waits.longest) * window_s_ : std::nan("");
  }
  return costs;
}

// Which delay to take.

constexpr double days_a_week = 7.0;

/// Below which a Poisson mean lies in 95 of 100 cases, n events seen [WilsonHilferty1931]; within 1 %.
double most_expected(double n) {
  constexpr double normal_95 = 1.6449;
  const double k = n + 1.0;
  return k * std::pow(1.0 - 1.0 / (9.0 * k) + normal_95 / (3.0 * std::sqrt(k)), 3.0);
}

double a_week(const LightCosts& light, const DelayCosts& at) { return days_a_week * light.a_day(at.false_offs); }
/// Days differ, and few events tell little: whichever is wider.
double at_most_a_week(const LightCosts& light, const DelayCosts& at) {
  const auto& over_days = at.false_offs_an_hour.over_days;
  const double by_days = over_days ? over_days->high * light.occupied_h : 0.0;
  return days_a_week * light.a_day(std::max(by_days, most_expected(at.false_offs)));
}

std::string minutes(const DelayCosts& at) { return shortest_number(at.delay_min) + " min"; }
std::string hours(double h) {
  const double s = std::round(3600.0 * h);
  return s < 60.0 ? fixed(s, 0) + " s" : h < 0.1 ? fixed(s / 60.0, 1) + " min" : fixed(h, 1) + " h";
}
std::string allowed(const LightCosts& light) {
  const double times = light.at_most_a_week;
  return "less than " + (times == 1.0 ? "once" : shortest_number(times) + " times") + " a week";
}
std::string often(double a_week) {
  if (a_week == 0.0) return "not once";
  return a_week < days_a_week ? fixed(a_week, 1) + " times a week" : fixed(a_week / days_a_week, 1) + " times a day";
}

/// To compare a delay with: the rule's, or else the next shorter one that people know; none for the shortest.
const DelayCosts* other_than(const LightCosts& light, double delay_min) {
  constexpr std::array usual{1.0, 5.0, 10.0, 15.0, 20.0, 30.0, 60.0};
  if (light.rule_delays_min.front() != delay_min) return &light.at(light.rule_delays_min.front());
  const auto above = std::ranges::lower_bound(usual, delay_min);
  return above == usual.begin() ? nullptr : &light.at(*(above - 1));
}

/// From which on all hold.
template <typename Holds>
const DelayCosts* first_of_rest(const std::vector<DelayCosts>& all, Holds holds) {
  const DelayCosts* first = nullptr;
  for (auto at = all.rbegin(); at != all.rend() && holds(*at); ++at) first = &*at;
  return first;
}

std::string empty_light(const LightCosts& light, const DelayCosts& at) {
  return hours(light.a_day(at.lit_empty_h)) + " of empty light a day";
}

std::string compared(const LightCosts& light, const DelayCosts& at) {
  const DelayCosts* other = other_than(light, at.delay_min);
  if (other == nullptr) return ".";
  return "; at " + minutes(*other) + " " + often(a_week(light, *other)) + ", and " +
         hours(light.a_day(other->lit_empty_h)) + ".";
}

std::string instead_of_a_delay(const LightCosts& light, const DelayCosts& at) {
  return " Off at P(nobody) of " + percent(*at.nobody) + " instead, it goes off on somebody " +
         often(a_week(light, at)) + ", with " + empty_light(light, at) + ".";
}

/// What is off can't go off.
std::string dark_all_the_same(const DelayCosts& at) {
  constexpr double worth_a_word = 0.05;  // assumed (0.01 to 0.2)
  if (at.dark_share.value < worth_a_word) return {};
  return " Somebody is in the dark for " + percent(at.dark_share.value) + " of their time all the same.";
}

std::string shown(const LightCosts& light, const DelayCosts& at) {
  return minutes(at) + ": off on somebody " + allowed(light) + ", " + empty_light(light, at) + compared(light, at) +
         dark_all_the_same(at);
}

std::string too_few_days(const LightCosts& light) {
  const double enough = std::ceil(days_a_week / light.at_most_a_week * most_expected(0.0));
  const double days = std::round(10.0 * light.known_days) / 10.0;
  const std::string data = days < 1.0    ? hours(24.0 * light.known_days) + " is too little"
                           : days == 1.0 ? "1 day is too little"
                                         : shortest_number(days) + " days are too few";
  return data + " to tell which delay goes off on somebody " + allowed(light) + ": " + fixed(enough, 0) +
         " days without a false-off would do.";
}

std::string best_guess(const LightCosts& light, const DelayCosts& at) {
  const std::string seen = light.people == People::expected ? fixed(at.false_offs, 1) + " false-offs expected"
                           : at.false_offs == 0.0           ? "no false-off"
                                                  : counted(static_cast<std::size_t>(at.false_offs), "false-off");
  return "best guess is " + minutes(at) + ": " + seen + " in " + hours(light.occupied_h) +
         " of occupied time, which shows less than one in " + hours(light.occupied_h / most_expected(at.false_offs)) +
         " (95 %), and " + empty_light(light, at) + compared(light, at) + dark_all_the_same(at);
}

std::string no_delay(const LightCosts& light) {
  const DelayCosts& longest = light.by_delay.back();
  return "no delay up to " + minutes(longest) + " keeps false-offs to " + allowed(light) + ": at " + minutes(longest) +
         " it goes off on somebody " + often(a_week(light, longest)) + ", with " + empty_light(light, longest) +
         compared(light, longest) + dark_all_the_same(longest);
}

std::string without_people(const LightCosts& light) {
  const DelayCosts& at = light.at(light.rule_delays_min.front());
  const auto costs = [&](const DelayCosts& of) {
    return hours(light.a_day(of.lit_h)) + " lit a day, switched on " + fixed(of.switched_on_a_day, 1) + " times";
  };
  const DelayCosts* other = other_than(light, at.delay_min);
  return "whom it goes off on isn't known; at " + minutes(at) + " " + costs(at) +
         (other != nullptr ? "; at " + minutes(*other) + " " + costs(*other) : "") + ".";
}

// Lights of a scene's areas.

RuleSpec rule_of_areas(const SceneSpec& scene, const std::string& name, std::vector<Issue>& remarks) {
  RuleSpec rule{name, {}};
  const Areas areas(scene);
  if (areas.empty()) rule.lights.emplace_back();
  for (std::size_t area = 0; area < areas.size(); ++area) {
    LightSpec light;
    light.id = light.area = areas.names()[area];
    for (const std::size_t sensor : areas.sensors_of(area)) light.sensors.push_back(scene.sensors[sensor].id);
    if (!light.sensors.empty()) {
      rule.lights.push_back(std::move(light));
    } else {
      remarks.push_back({Severity::warning,
                         {scene.name},
                         "the area '" + light.id + "' has no sensor that could switch a light: it is left out"});
    }
  }
  if (rule.lights.empty())
    throw Error(ErrorCode::input, {scene.name}, "no area has a sensor that could switch its light");
  return rule;
}

}  // namespace

SwitchRule::SwitchRule(const LightSpec& light, double window_s)
    : least_on_rows(std::llround(60.0 * light.least_on_min / window_s)), timer(light.timer) {
  if (light.wave_s) wave_rows = std::llround(*light.wave_s / window_s);
  if (!light.manual) return;
  switch_rows = std::llround(light.manual->switch_s / window_s);
  grace_rows = std::llround(light.manual->grace_s / window_s);
}

void LightSwitch::go_on() noexcept {
  lit_ = was_lit_ = true;
  since_ = counted_from_ = row_;
  waits_ = 0;
}

bool LightSwitch::goes_on(const SwitchRule& rule, const Cue& cue) noexcept {
  if (!rule.switch_rows) {
    waits_ = cue.occupied && rule.wave_rows ? waits_ + 1 : 0;
    return cue.moved || (rule.wave_rows && waits_ > *rule.wave_rows);
  }
  if (cue.moved && was_lit_ && row_ - since_ <= rule.grace_rows) return true;
  waits_ = cue.occupied ? waits_ + 1 : 0;
  return waits_ > *rule.switch_rows;
}

void LightSwitch::advance(const SwitchRule& rule, const Cue& cue, std::int64_t delay_rows) {
  ++row_;
  if (cue.is_open && latched_) counted_from_ = row_;
  latched_ = !cue.is_open && (latched_ || cue.is_behind);
  if (!lit_) {
    if (goes_on(rule, cue)) go_on();
    return;
  }
  const bool is_over = row_ - counted_from_ > delay_rows;
  if (cue.moved && (rule.timer == Timer::restarts || is_over)) counted_from_ = row_;
  if (latched_ || row_ - counted_from_ <= delay_rows || row_ - since_ < rule.least_on_rows) return;
  lit_ = false;
  since_ = row_;
}

const DelayCosts& LightCosts::at(double delay_min) const {
  const auto found = std::ranges::find(by_delay, delay_min, &DelayCosts::delay_min);
  if (found == by_delay.end())
    throw Error(ErrorCode::usage, "light '" + id + "': no delay of " + std::to_string(delay_min) + " min");
  return *found;
}

double LightCosts::a_day(double sum) const { return known_days > 0.0 ? sum / known_days : 0.0; }

struct Control::State {
  RuleSpec rule;
  double window_s;
  People people;
  std::size_t n_areas;
  std::vector<Light> lights;
  std::vector<std::uint8_t> lit{};
  std::vector<std::int32_t> people_of{};
  std::optional<int> replicate{};  ///< none: a run begins
  std::string trial{}, day{};
  bool has_clock = false;
  std::int64_t n_missing = 0;
};

Control::Control(RuleSpec rule, ColumnOwners columns, double window_s, People people)
    : state_(new State{std::move(rule), window_s, people, columns.areas.size(), {}}) {
  Diagnostics faults;
  if (!(window_s > 0.0)) faults.error({state_->rule.name}, "expected rows of more than 0 s");
  for (const LightSpec& light : state_->rule.lights) {
    Columns own = columns_for(light, columns, faults);
    if (people == People::unknown && (light.manual || light.wave_s)) {
      faults.error(light.where, "light '" + light.id + "': " + (light.manual ? "manual" : "wave_s") +
                                    " goes by who is in the dark, and the rows have no people");
    }
    if (people == People::expected && !light.area.empty()) {
      faults.error(light.where, "light '" + light.id +
                                    "': a counter counts the people of all its sensors, and not those "
                                    "of an area: leave out `area`");
    }
    if (!faults.has_errors()) state_->lights.emplace_back(light, std::move(own), window_s, people);
  }
  faults.throw_if_errors();
  state_->lit.resize(state_->lights.size());
  state_->people_of.resize(state_->lights.size());
}
Control::~Control() = default;
Control::Control(Control&&) noexcept = default;

void Control::begin_run() noexcept { state_->replicate.reset(); }
void Control::note_missing(std::int64_t n_rows) noexcept { state_->n_missing += n_rows; }

LitRow Control::add(const Sample& row, std::string_view day, double nobody) {
  State& state = *state_;
  const bool is_new_run = row.replicate != state.replicate || row.trial != state.trial;
  const bool is_new_day = day.empty() ? is_new_run || !state.day.empty() : day != state.day;
  for (Light& light : state.lights) {
    if (is_new_run) light.begin();
    if (is_new_day) light.begin_day(day.empty() ? DayKind::run : DayKind::date);
  }
  if (is_new_run || is_new_day) state.replicate = row.replicate, state.trial = row.trial, state.day = day;
  const std::optional<std::int64_t> ends_s = clock_s(row);
  std::optional<double> hour;
  if (ends_s) hour = static_cast<double>(((*ends_s % day_s) + day_s) % day_s) / 3600.0;
  state.has_clock = state.has_clock || ends_s;
  for (std::size_t i = 0; i < state.lights.size(); ++i) {
    const bool knows = state.people != People::unknown;
    const int people = knows ? state.lights[i].people_of(row) : 0;
    state.lit[i] = state.lights[i].add(row, people, hour, nobody);
    state.people_of[i] = knows ? people : -1;
  }
  return {state.lit, state.people_of, ends_s};
}

Costs Control::finish() const {
  Costs costs{state_->rule.name, state_->window_s, {}, {}};
  for (const Light& light : state_->lights) costs.lights.push_back(light.costs(state_->people));
  const auto remark = [&](const Where& where, const std::string& what) {
    costs.remarks.push_back({Severity::warning, where, what});
  };
  for (const LightSpec& light : state_->rule.lights) {
    const std::string name = "light '" + light.id + "': ";
    const auto tell_rounding = [&](const char* what, double time, double unit_s, const char* unit) {
      const double in_rows =
          static_cast<double>(std::llround(unit_s * time / state_->window_s)) * state_->window_s / unit_s;
      if (std::abs(in_rows - time) < 1e-6) return;
      remark(light.where, name + "in rows of " + shortest_number(state_->window_s) + " s " + what + " of " +
                              shortest_number(time) + " " + unit + " is one of " + shortest_number(in_rows) + " " +
                              unit);
    };
    for (const double delay_min : light.delays_min) tell_rounding("a delay", delay_min, 60.0, "min");
    if (light.night) tell_rounding("a delay at night", light.night->delay_min, 60.0, "min");
    tell_rounding("a least_on_min", light.least_on_min, 60.0, "min");
    if (light.together) tell_rounding("a within_s", light.together->within_s, 1.0, "s");
    if (light.manual) tell_rounding("a switch_s", light.manual->switch_s, 1.0, "s");
    if (light.manual) tell_rounding("a grace_s", light.manual->grace_s, 1.0, "s");
    if (light.wave_s) tell_rounding("a wave_s", *light.wave_s, 1.0, "s");
    const bool wants_clock = light.night || light.from_h > 0.0 || light.to_h < 24.0;
    if (wants_clock && !state_->has_clock)
      remark(light.where, name + "the rows have no clock: `night`, `from` and `to` do nothing");
    if (!light.area.empty() && light.sensors.empty() && state_->n_areas > 1)
      remark(light.where, name + "the sensors of all areas switch it; name its `sensors`, or say --scene");
  }
  if (state_->n_missing > 0) {
    remark({}, counted(static_cast<std::size_t>(state_->n_missing), "row") + " of " +
                   shortest_number(state_->window_s) +
                   " s are missing between those that are there: nothing is known of them");
  }
  if (state_->people == People::unknown) remark({}, "the rows have no people: who was left in the dark isn't known");
  return costs;
}

Costs expected_of(std::span<const Costs> draws) {
  Costs all = draws.front();
  // known: of each draw, what isn't NaN there.
  const auto known = [&](auto value_of) {
    std::vector<double> values;
    for (const Costs& draw : draws) {
      if (const double value = value_of(draw); !std::isnan(value)) values.push_back(value);
    }
    return values;
  };
  const auto mean = [&](auto value_of) {
    const std::vector<double> values = known(value_of);
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  for (std::size_t l = 0; l < all.lights.size(); ++l) {
    LightCosts& light = all.lights[l];
    light.worst.clear();
    light.occupied_h = mean([&](const Costs& draw) { return draw.lights[l].occupied_h; });
    light.span_h = mean([&](const Costs& draw) { return draw.lights[l].span_h; });
    for (std::vector<DelayCosts> LightCosts::*of : {&LightCosts::by_delay, &LightCosts::by_nobody}) {
      for (std::size_t i = 0; i < (light.*of).size(); ++i) {
        DelayCosts& at = (light.*of)[i];
        for (double DelayCosts::*sum : {&DelayCosts::lit_h, &DelayCosts::switched_on_a_day, &DelayCosts::lit_empty_h,
                                        &DelayCosts::dark_h, &DelayCosts::false_offs, &DelayCosts::longest_dark_s,
                                        &DelayCosts::mean_wait_s, &DelayCosts::longest_wait_s})
          at.*sum = mean([&](const Costs& draw) { return (draw.lights[l].*of)[i].*sum; });
        for (Figure DelayCosts::*figure : {&DelayCosts::lit_share, &DelayCosts::false_offs_an_hour,
                                           &DelayCosts::dark_share, &DelayCosts::empty_share}) {
          const auto value_of = [&](const Costs& draw) { return ((draw.lights[l].*of)[i].*figure).value; };
          std::vector<double> values = known(value_of);
          at.*figure = {mean(value_of), {}};
          if (!values.empty()) (at.*figure).over_days = middle_of(std::move(values));
        }
      }
    }
  }
  return all;
}

Advice advise(const LightCosts& light) {
  using Ground = Advice::Ground;
  const std::string name = light.id + ": ";
  if (!(light.known_days > 0.0)) return {Ground::nobody_came, {}, name + "nothing is known: no delay can be judged."};
  if (light.people == People::unknown) return {Ground::unknown_people, {}, name + without_people(light)};
  if (!(light.occupied_h > 0.0)) return {Ground::nobody_came, {}, name + "nobody came: no delay can be judged."};
  const auto is_below = [&](auto rate) {
    return [&light, rate](const DelayCosts& at) { return rate(light, at) < light.at_most_a_week; };
  };
  const auto first = [&](auto rate) { return first_of_rest(light.by_delay, is_below(rate)); };
  const DelayCosts* by_counter = first_of_rest(light.by_nobody, is_below(a_week));
  const std::string counter = by_counter == nullptr ? "" : instead_of_a_delay(light, *by_counter);
  if (const DelayCosts* at = first(at_most_a_week))
    return {Ground::shown, at->delay_min, name + shown(light, *at) + counter};
  if (const DelayCosts* at = first(a_week))
    return {Ground::too_few_days, at->delay_min,
            name + too_few_days(light) + " The " + best_guess(light, *at) + counter, too_few_days(light),
            name + "the " + best_guess(light, *at) + counter};
  return {Ground::no_delay, {}, name + no_delay(light) + counter};
}

std::vector<std::string> advise_all(std::span<const LightCosts> lights) {
  std::vector<std::string> sentences, doubts;
  for (const LightCosts& light : lights) {
    const Advice advice = advise(light);
    const bool is_said = std::ranges::find(doubts, advice.doubt) != doubts.end();
    sentences.push_back(is_said && !advice.doubt.empty() ? advice.rest : advice.sentence);
    doubts.push_back(advice.doubt);
  }
  return sentences;
}

std::string advised_rule(RuleSpec rule, const Costs& costs) {
  std::string text;
  YAML::Node root;
  root["pirsim_control"] = 1;
  root["name"] = rule.name;
  for (std::size_t i = 0; i < rule.lights.size(); ++i) {
    LightSpec& light = rule.lights[i];
    const Advice advice = advise(costs.lights[i]);
    if (advice.delay_min) light.delays_min = {*advice.delay_min};
    YAML::Node written = io::written(light);
    if (light.door.empty()) written.remove("settle_s");  // it is a door's
    root["lights"].push_back(written);
  }
  for (const std::string& sentence : advise_all(costs.lights)) text += "# " + sentence + '\n';
  return text + YAML::Dump(root) + '\n';
}

RuleSpec rule_for(std::optional<RuleSpec> given, const SceneSpec* scene, const std::string& name,
                  std::vector<Issue>& remarks) {
  if (scene == nullptr) return given ? std::move(*given) : RuleSpec{"any sensor", {{}}};
  std::vector<Issue> left_out;  // areas without sensors: of a rule they are told where the light stays without
  RuleSpec of_scene = rule_of_areas(*scene, name, given ? left_out : remarks);
  if (!given) return of_scene;
  for (LightSpec& light : given->lights) {
    const auto same = std::ranges::find(of_scene.lights, light.area, &LightSpec::area);
    if (light.sensors.empty() && !light.area.empty() && same != of_scene.lights.end()) light.sensors = same->sensors;
  }
  return std::move(*given);
}

std::vector<Issue> deaf_seats(const RuleSpec& rule, const Model& model) {
  const SceneSpec& scene = model.scene();
  const Areas areas(scene);
  const sim::CompiledStudy& study = model.compiled();
  const WorkReport work = studies::watch_sitters(studies::room_of(study), studies::worker_of(study.trials()));
  const auto is_here = [&](const std::string& sensor) {
    return std::ranges::find(scene.sensors, sensor, &SensorSpec::id) != scene.sensors.end();
  };
  std::vector<Issue> remarks;
  for (const LightSpec& light : rule.lights) {
    if (!std::ranges::all_of(light.sensors, is_here)) continue;  // the rows are of other sensors than the scene's
    const auto switches = [&](const SensorSpec& sensor) {
      return light.sensors.empty() || std::ranges::find(light.sensors, sensor.id) != light.sensors.end();
    };
    std::vector<std::string> unnoticed;
    for (std::size_t seat = 0; seat < work.seats.size(); ++seat) {
      const auto found = std::ranges::find(scene.seats, work.seats[seat], &SeatSpec::id);
      if (found == scene.seats.end()) continue;  // to lie and to stand: who is there doesn't stay for hours, or sleeps
      const SeatSpec& place = *found;
      if (!light.area.empty() && areas.name_at(floor_point(place.world_from_seat.origin)) != light.area) continue;
      bool is_noticed = false;
      for (std::size_t i = 0; i < scene.sensors.size(); ++i)
        is_noticed = is_noticed || (switches(scene.sensors[i]) && work.notice(seat, i).seconds > 0);
      if (!is_noticed) unnoticed.push_back(place.id);
    }
    if (unnoticed.empty()) continue;
    remarks.push_back({Severity::warning,
                       {scene.name},
                       "light '" + light.id + "': none of its sensors notices somebody at work in " +
                           joined(unnoticed, ", ") +
                           ": who is alone there sits in the dark at any delay; `pirsim check` says why"});
  }
  return remarks;
}

namespace {

LightSpec read_light(const io::YamlNode& node, std::size_t index, Diagnostics& faults) {
  io::YamlMap map(node, faults, "light");
  LightSpec light;
  light.where = node.where();
  light.area = map.text("area");
  light.id = map.text("id", light.area.empty() ? "light_" + std::to_string(index + 1) : light.area);
  light.door = map.text("door");
  io::read_fields(map, light);
  io::read_part(map, "together", light.together);
  io::read_part(map, "manual", light.manual);
  io::read_part(map, "night", light.night);
  if (light.delays_min.empty()) faults.error(map.where("delay_min"), "delay_min: expected a number, or several");
  for (auto delay = light.delays_min.begin(); delay != light.delays_min.end(); ++delay) {
    if (std::find(light.delays_min.begin(), delay, *delay) == delay) continue;
    const io::YamlNode again = map.list("delay_min")[static_cast<std::size_t>(delay - light.delays_min.begin())];
    faults.error(again.where(), "delay_min: " + shortest_number(*delay) + " is named twice");
  }
  if (light.wave_s && light.manual)
    faults.error(map.where("wave_s"), "wave_s: with `manual`, who is in the dark uses the switch instead");
  if (map.has("settle_s") && light.door.empty())
    faults.error(map.where("settle_s"), "settle_s: of its door, and the light has no `door`");
  if (map.has("sensors") && light.sensors.empty())
    faults.error(map.where("sensors"), "sensors: light '" + light.id + "' has none that could switch it");
  const bool is_whole_day = light.from_h == 0.0 && light.to_h == 24.0;
  if (!is_whole_day && std::fmod(light.from_h, 24.0) == std::fmod(light.to_h, 24.0))
    faults.error(map.where("to"), "light: `to` is `from`: it is never dark");
  if (const std::string bad = name_fault(light.id); !bad.empty())
    faults.error(map.where("id"), "light: id: '" + light.id + "': " + bad);
  map.finish();
  return light;
}

RuleSpec read(const io::YamlNode& root, const std::string& name) {
  Diagnostics faults;
  io::YamlMap map(root, faults, "rule");
  io::check_version(map, "pirsim_control");
  RuleSpec rule;
  rule.name = map.text("name", name);
  Names ids("light");
  for (const io::YamlNode& node : map.required_list("lights", limits::list_entries)) {
    const LightSpec light = read_light(node, rule.lights.size(), faults);
    const std::string again = ids.fault_of_adding(light.id);
    if (!again.empty()) faults.error(light.where, again);
    rule.lights.push_back(light);
  }
  map.finish();
  faults.throw_if_errors();
  return rule;
}

}  // namespace

RuleSpec read_rule(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return read(io::YamlNode::load(io::read_input(file), overrides), io::stem_of_input(file));
}

RuleSpec parse_rule(std::string_view text, const std::string& name) {
  return read(io::YamlNode::parse(text, name), name);
}

}  // namespace pirsim::control
