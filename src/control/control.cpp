#include "pirsim/control.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "control/day_sums.hpp"
#include "control/light_switch.hpp"
#include "core/text.hpp"
#include "pirsim/sample.hpp"
#include "schema/areas.hpp"
#include "schema/clock.hpp"

namespace pirsim::control {
namespace {

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
  Light(const LightSpec& spec, Columns columns, double window_s)
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
    waits_.resize(delays_min_.size());
    longest_dark_.resize(delays_min_.size(), 0);
    begin();
  }

  /// In the dark, after nothing.
  void begin() {
    switches_.assign(delays_min_.size(), {});
    last_motion_.assign(columns_.sensors.size(), never);
    last_behind_ = last_motion_;
    is_on_.assign(columns_.sensors.size(), true);  // since before, if it is in the first row
    began_behind_.assign(columns_.sensors.size(), false);
    row_ = gap_rows_ = 0;
    open_at_ = -1;  // just shut when the run began, if it is shut at all
    begin_people();
  }
  void begin_day(DayKind kind) {
    days_.push_back({.kind = kind, .by_delay = decltype(DaySums::by_delay)(delays_min_.size())});
  }

  /// 0, 1, or 2 where not known. hour: of the day at its end.
  std::uint8_t add(const Sample& row, int people, std::optional<double> hour) {
    ++row_;
    DaySums& day = days_.back();
    if (!is_here(row, people)) return unknown_bit;
    ++day.all;
    if (hour && !is_between(*hour, spec_.from_h, spec_.to_h)) {  // light from outside
      begin();
      return 0;
    }
    const auto [cue, is_known] = cue_of(row, people);
    gap_rows_ = is_known ? 0 : gap_rows_ + 1;
    if (!is_known || people < 0) {
      ++day.unknown;
      pass(cue, is_night(hour));
      return unknown_bit;
    }
    ++day.rows;
    if (cue.occupied) {
      ++day.occupied;
      if (day.first_occupied < 0) day.first_occupied = day.rows;
      day.last_occupied = day.rows;
    }
    const bool comes = cue.occupied && !was_occupied_;
    for (std::size_t i = 0; i < switches_.size(); ++i)
      step(i, cue, delay_of(i, is_night(hour)), comes, day.by_delay[i]);
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
    entered_.assign(delays_min_.size(), -1);
    dark_for_.assign(delays_min_.size(), 0);
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
  [[nodiscard]] std::int64_t delay_of(std::size_t i, bool is_night) const {
    return is_night ? night_rows_ : delay_rows_[i];
  }

  /// A row that isn't counted. Where the sensors aren't known the light goes on as if nothing moved, and anew once that
  /// lasts longer than the delay.
  void pass(const Cue& cue, bool is_night) {
    if (gap_rows_ > std::max(delay_rows_.back(), night_rows_) + 1) return;  // all has begun anew
    for (std::size_t i = 0; i < switches_.size(); ++i) {
      const std::int64_t delay_rows = delay_of(i, is_night);
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
  const bool knows = people == People::known;
  const auto if_known = [knows](double value) { return knows ? value : std::nan(""); };
  if (!knows) occupied.assign(occupied.size(), 0.0);
  costs.occupied_h = if_known(costs.occupied_h), costs.span_h = if_known(costs.span_h);
  const DrawnDays drawn(days.size());
  for (std::size_t i = 0; i < delays_min_.size(); ++i) {
    DelayCosts& at = costs.by_delay.emplace_back();
    at.delay_min = delays_min_[i];
    std::vector<double> lit, dark, offs;
    double switched_on = 0.0;
    for (const DaySums* day : days) {
      const DelaySums& sums = day->by_delay[i];
      lit.push_back(sums.lit * row_h);
      dark.push_back(sums.dark * row_h);
      offs.push_back(sums.false_offs);
      at.lit_h += lit.back();
      at.lit_empty_h += sums.lit_empty * row_h;
      at.dark_h += dark.back();
      at.false_offs += sums.false_offs;
      switched_on += sums.switched_on;
    }
    at.lit_empty_h = if_known(at.lit_empty_h), at.dark_h = if_known(at.dark_h);
    at.switched_on_a_day = costs.a_day(switched_on);
    at.lit_share = drawn.ratio(lit, hours);
    at.false_offs_an_hour = drawn.rate(offs, occupied);
    at.dark_share = drawn.ratio(dark, occupied);
    at.longest_dark_s = if_known(static_cast<double>(longest_dark_[i]) * window_s_);
    const Waits& waits = waits_[i];
    const double each_s = waits.n > 0 ? window_s_ / static_cast<double>(waits.n) : std::nan("");
    at.mean_wait_s = static_cast<double>(waits.rows) * each_s;
    at.longest_wait_s = waits.n > 0 ? static_cast<double>(waits.longest) * window_s_ : std::nan("");
  }
  return costs;
}

}  // namespace

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
    if (!faults.has_errors()) state_->lights.emplace_back(light, std::move(own), window_s);
  }
  faults.throw_if_errors();
  state_->lit.resize(state_->lights.size());
  state_->people_of.resize(state_->lights.size());
}
Control::~Control() = default;
Control::Control(Control&&) noexcept = default;

void Control::begin_run() noexcept { state_->replicate.reset(); }

LitRow Control::add(const Sample& row, std::string_view day) {
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
    const int people = state.people == People::known ? state.lights[i].people_of(row) : 0;
    state.lit[i] = state.lights[i].add(row, people, hour);
    state.people_of[i] = state.people == People::known ? people : -1;
  }
  return {state.lit, state.people_of, ends_s};
}

Costs Control::finish() const {
  Costs costs{state_->rule.name, state_->window_s, {}, {}};
  for (const Light& light : state_->lights) costs.lights.push_back(light.costs(state_->people));
  for (const LightSpec& light : state_->rule.lights) {
    const auto tell_rounding = [&](const char* what, double time, double unit_s, const char* unit) {
      const double in_rows =
          static_cast<double>(std::llround(unit_s * time / state_->window_s)) * state_->window_s / unit_s;
      if (std::abs(in_rows - time) < 1e-6) return;
      costs.remarks.push_back({Severity::warning, light.where,
                               "light '" + light.id + "': in rows of " + shortest_number(state_->window_s) + " s " +
                                   what + " of " + shortest_number(time) + " " + unit + " is one of " +
                                   shortest_number(in_rows) + " " + unit});
    };
    for (const double delay_min : light.delays_min) tell_rounding("a delay", delay_min, 60.0, "min");
    if (light.night) tell_rounding("a delay at night", light.night->delay_min, 60.0, "min");
    tell_rounding("a least_on_min", light.least_on_min, 60.0, "min");
    if (light.together) tell_rounding("a within_s", light.together->within_s, 1.0, "s");
    if (light.manual) tell_rounding("a switch_s", light.manual->switch_s, 1.0, "s");
    if (light.manual) tell_rounding("a grace_s", light.manual->grace_s, 1.0, "s");
    if (light.wave_s) tell_rounding("a wave_s", *light.wave_s, 1.0, "s");
    const bool wants_clock = light.night || light.from_h > 0.0 || light.to_h < 24.0;
    if (wants_clock && !state_->has_clock) {
      costs.remarks.push_back(
          {Severity::warning, light.where,
           "light '" + light.id + "': the rows have no clock: `night`, `from` and `to` do nothing"});
    }
    if (!light.area.empty() && light.sensors.empty() && state_->n_areas > 1) {
      costs.remarks.push_back(
          {Severity::warning, light.where,
           "light '" + light.id + "': the sensors of all areas switch it; name its `sensors`, or say --scene"});
    }
  }
  return costs;
}

}  // namespace pirsim::control
