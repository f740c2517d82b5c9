#include "pirsim/control.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "control/day_sums.hpp"
#include "control/light_switch.hpp"
#include "core/text.hpp"
#include "schema/areas.hpp"
#include "schema/bits.hpp"
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

/// Hours of the day at the end of a row; none without a clock.
std::optional<double> hour_of(const Sample& row) {
  if (row.clock.size() < 19) return std::nullopt;
  const auto digits = [&](std::size_t at) { return 10 * (row.clock[at] - '0') + (row.clock[at + 1] - '0'); };
  return digits(11) + digits(14) / 60.0 + digits(17) / 3600.0;
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
    chosen_ = static_cast<std::size_t>(std::ranges::find(delays_min_, spec.delays_min.front()) - delays_min_.begin());
    waits_.resize(delays_min_.size());
    longest_dark_.resize(delays_min_.size(), 0);
    begin();
  }

  /// In the dark, after nothing.
  void begin() {
    switches_.assign(delays_min_.size(), {});
    last_motion_.assign(columns_.sensors.size(), never);
    row_ = gap_rows_ = 0;
    begin_people();
  }
  void begin_day() {
    days_.emplace_back().by_delay.resize(delays_min_.size());
    day_row_ = 0;
  }

  /// 0, 1, or 2 where not known.
  std::uint8_t add(const Sample& row, int people) {
    ++row_, ++day_row_;
    DaySums& day = days_.back();
    if (!is_here(row, people)) return unknown_bit;
    const std::optional<double> hour = hour_of(row);
    if (hour && !is_between(*hour, spec_.from_h, spec_.to_h)) {  // light from outside
      begin();
      return 0;
    }
    const std::optional<Cue> cue = cue_of(row, people);
    if (!cue || people < 0) {
      ++day.unknown;
      pass(cue, is_night(hour));
      return unknown_bit;
    }
    gap_rows_ = 0;
    ++day.rows;
    if (cue->occupied) {
      ++day.occupied;
      if (day.first_occupied < 0) day.first_occupied = day_row_;
      day.last_occupied = day_row_;
    }
    const bool comes = cue->occupied && !was_occupied_;
    for (std::size_t i = 0; i < switches_.size(); ++i)
      step(i, *cue, delay_of(i, is_night(hour)), comes, day.by_delay[i]);
    was_occupied_ = cue->occupied;
    const bool is_lit = switches_[chosen_].is_lit();
    note_spell(row, cue->occupied && !is_lit);
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
  void pass(const std::optional<Cue>& cue, bool is_night) {
    gap_rows_ = cue ? 0 : gap_rows_ + 1;
    if (gap_rows_ > std::max(delay_rows_.back(), night_rows_) + 1) return;  // all has begun anew
    for (std::size_t i = 0; i < switches_.size(); ++i) {
      const std::int64_t delay_rows = delay_of(i, is_night);
      if (gap_rows_ > delay_rows)
        switches_[i] = {};
      else
        switches_[i].advance(rule_, cue.value_or(Cue{}), delay_rows);
    }
    begin_people();
  }

  [[nodiscard]] std::int64_t rows_of(double seconds) const { return std::llround(seconds / window_s_); }

  /// None where a sensor isn't known.
  std::optional<Cue> cue_of(const Sample& row, int people) {
    int n_moved = 0;
    bool is_known = !columns_.door || row.doors[*columns_.door] != unknown_bit;
    for (std::size_t i = 0; i < columns_.sensors.size(); ++i) {
      const std::uint8_t bit = row.bits[columns_.sensors[i]];
      if (bit == 1) last_motion_[i] = row_;
      is_known = is_known && bit != unknown_bit;
      n_moved += row_ - last_motion_[i] <= together_rows_;
    }
    // Motion that was together starts nothing anew while nobody moves on.
    const bool moves = std::ranges::any_of(last_motion_, [&](std::int64_t last) { return last == row_; });
    if (!is_known) return std::nullopt;
    Cue cue;
    cue.moved = moves && n_moved >= (spec_.together ? spec_.together->sensors : 1);
    cue.occupied = people > 0;
    cue.is_open = columns_.door && row.doors[*columns_.door] != 0;
    return cue;
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
  std::size_t chosen_ = 0;  ///< of the delays
  std::vector<LightSwitch> switches_;
  std::vector<std::int64_t> entered_, dark_for_, last_motion_;
  bool was_occupied_ = true;
  std::int64_t row_ = 0, gap_rows_ = 0;  ///< gap: rows of which nothing is known, up to now
  std::int32_t day_row_ = 0;
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
  std::vector<double> hours, occupied;
  for (const DaySums* day : days) {
    hours.push_back(day->rows * row_h);
    occupied.push_back(day->occupied * row_h);
    costs.hours += hours.back();
    costs.occupied_h += occupied.back();
    costs.span_h += day->span() * row_h;
  }
  const DrawnDays drawn(days.size());
  const double n_days = std::max(1.0, static_cast<double>(days.size()));
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
    at.switched_on_a_day = switched_on / n_days;
    at.lit_share = drawn.ratio(lit, hours);
    at.false_offs_an_hour = drawn.rate(offs, occupied);
    at.dark_share = drawn.ratio(dark, occupied);
    at.longest_dark_s = static_cast<double>(longest_dark_[i]) * window_s_;
    const Waits& waits = waits_[i];
    at.mean_wait_s = waits.n > 0 ? static_cast<double>(waits.rows) / static_cast<double>(waits.n) * window_s_ : 0.0;
    at.longest_wait_s = static_cast<double>(waits.longest) * window_s_;
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
  if (is_new_run || day != state.day) {
    state.replicate = row.replicate, state.trial = row.trial, state.day = day;
    for (Light& light : state.lights) {
      if (is_new_run) light.begin();
      light.begin_day();
    }
  }
  state.has_clock = state.has_clock || !row.clock.empty();
  for (std::size_t i = 0; i < state.lights.size(); ++i) {
    const int people = state.people == People::known ? state.lights[i].people_of(row) : 0;
    state.lit[i] = state.lights[i].add(row, people);
    state.people_of[i] = state.people == People::known ? people : -1;
  }
  return {state.lit, state.people_of};
}

Costs Control::finish() const {
  Costs costs{state_->rule.name, state_->window_s, {}, {}};
  for (const Light& light : state_->lights) costs.lights.push_back(light.costs(state_->people));
  for (const LightSpec& light : state_->rule.lights) {
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
