#include "reconcile/data/measured.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "model/schema/check_scene.hpp"
#include "model/schema/check_script.hpp"
#include "model/schema/clock.hpp"
#include "pirsim/error.hpp"
#include "stats/matrix.hpp"

namespace pirsim::reconcile {
namespace {

/// Who notes comings and goings knows them to about a minute: the same as the usual nuisance.
constexpr double around_change_s = 60.0;      // assumed (30-120)
constexpr std::size_t fewest_part_rows = 20;  ///< of a part; assumed (10-40)
constexpr std::size_t wanted_parts = 12;      ///< of all numbers of people together; assumed (8-20)
constexpr std::size_t fewest_parts = 2, most_parts = 6;
constexpr int most_told_apart = 4;  ///< people; more are put together, twice as many each time

constexpr std::size_t most_states = 8;  ///< of counted areas, told apart; assumed (4-16)

std::string people_text(int people, int most) {
  if (people == 0) return "nobody";
  if (people == 1) return "1 person";
  if (most <= most_told_apart) return std::to_string(people) + " people";
  int least = 1;
  while (2 * least <= people) least *= 2;
  return std::to_string(least) + " to " + std::to_string(2 * least - 1) + " people";
}

/// Those of a reading, area by area: "1 in kitchen, 2 elsewhere".
template <typename Text>
std::string areas_text(const CountsSpec& counts, std::size_t reading, const Text& text) {
  std::string all;
  int rest = counts.people[reading];
  const auto add = [&](int people, const std::string& where) {
    if (people > 0) all += (all.empty() ? "" : ", ") + text(people, where);
  };
  for (const AreaCountsSpec& area : counts.areas) {
    add(area.people[reading], "in " + area.area);
    rest -= area.people[reading];
  }
  add(rest, "elsewhere");
  return all.empty() ? "nobody" : all;
}

/// (n_times) What people's whereabouts have in common: the most exact words that are few.
std::vector<std::string> states_of(const CountsSpec& counts, int most) {
  const auto texts = [&](const auto& text) {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < counts.people.size(); ++i) all.push_back(text(i));
    return all;
  };
  const auto are_few = [](const std::vector<std::string>& all) {
    return std::set<std::string_view>(all.begin(), all.end()).size() <= most_states;
  };
  if (!counts.areas.empty()) {
    const auto exact = [](int people, const std::string& where) { return std::to_string(people) + ' ' + where; };
    const auto anybody = [](int, const std::string& where) { return "people " + where; };
    std::vector<std::string> all = texts([&](std::size_t i) { return areas_text(counts, i, exact); });
    if (are_few(all)) return all;
    all = texts([&](std::size_t i) { return areas_text(counts, i, anybody); });
    if (are_few(all)) return all;
  }
  return texts([&](std::size_t i) { return people_text(counts.people[i], most); });
}

/// People all the time between two moments of the data, and half a minute or so around; or changing.
class Presence {
 public:
  explicit Presence(const OccupancySpec& occupancy) {
    if (!occupancy.counts) return;
    const CountsSpec& counts = *occupancy.counts;
    const int most = counts.people.empty() ? 0 : *std::ranges::max_element(counts.people);
    const std::vector<std::string> states = states_of(counts, most);
    const double within_s = occupancy.changes_within_s.value_or(std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < counts.people.size(); ++k) {
      if (k == 0 || !are_as_many(counts, k)) {
        if (k > 0) {
          const double from_s = std::max(counts.times_s[k - 1], counts.times_s[k] - within_s);
          changes_.push_back({from_s - around_change_s, counts.times_s[k] + around_change_s});
        }
        counts_.push_back({counts.times_s[k], {counts.people[k], states[k]}});
      }
    }
  }
  struct There {
    std::int32_t people = DayParts::not_sure;
    std::string state;
  };
  [[nodiscard]] const There& between(double from_s, double to_s) const {
    if (counts_.empty()) return untold_;
    const auto next = std::ranges::upper_bound(changes_, from_s, {}, &Change::to_s);
    if (next != changes_.end() && next->from_s < to_s) return changing_;
    const auto after = std::ranges::upper_bound(counts_, to_s, {}, &Count::at_s);
    return after == counts_.begin() ? counts_.front().there : (after - 1)->there;
  }

 private:
  struct Change {
    double from_s, to_s;
  };
  struct Count {
    double at_s;
    There there;
  };
  std::vector<Change> changes_;
  std::vector<Count> counts_;
  const There untold_{DayParts::not_sure, "people as told"}, changing_{DayParts::not_sure, "comings and goings"};
};

/// "10:49", with the date if the data have several days; seconds of the run without a clock.
std::string time_text(const DayParts& parts, std::size_t day, std::size_t row, double window_s) {
  const double run_s = static_cast<double>(row) * window_s;
  if (parts.begins_s.empty()) return std::to_string(std::llround(run_s)) + " s";
  constexpr std::size_t date_at = 5, time_at = 11, time_length = 5;
  const std::string text = RunClock{parts.begins_s[day]}.text(run_s);
  const std::string time = text.substr(time_at, time_length);
  const bool same_day =
      parts.n_days == 1 &&
      RunClock{parts.begins_s.front()}.begin_day() ==
          RunClock{parts.begins_s.front() + std::llround(static_cast<double>(parts.n_rows) * window_s)}.begin_day();
  return same_day ? time : text.substr(date_at, time_at - 1 - date_at) + " " + time;
}

/// Rows in the order of time, with what they have in common.
struct PartRows {
  std::string state;
  std::vector<std::size_t> rows;
};

/// Splits the rows of each state into parts of equal length, one after the other; in order of their beginnings.
std::vector<PartRows> split_rows(const std::map<std::string, std::vector<std::size_t>>& rows_of_state) {
  const std::size_t n_states = static_cast<std::size_t>(
      std::ranges::count_if(rows_of_state, [](const auto& state) { return state.second.size() >= fewest_part_rows; }));
  const std::size_t parts = std::clamp(wanted_parts / std::max<std::size_t>(1, n_states), fewest_parts, most_parts);
  std::vector<PartRows> all;
  for (const auto& [state, rows] : rows_of_state) {
    if (rows.size() < fewest_part_rows) continue;
    const std::size_t n = std::clamp(rows.size() / fewest_part_rows, std::size_t{1}, parts);
    for (std::size_t part = 0; part < n; ++part) {
      const auto at = [&](std::size_t i) { return rows.begin() + static_cast<std::ptrdiff_t>(i * rows.size() / n); };
      all.push_back({state, {at(part), at(part + 1)}});
    }
  }
  std::ranges::stable_sort(all, {}, [](const PartRows& part) { return part.rows.front(); });
  return all;
}

std::string name_of(const DayParts& parts, const PartRows& part, double window_s) {
  const std::size_t first = part.rows.front(), last = part.rows.back();
  return part.state + " from " + time_text(parts, first / parts.n_rows, first % parts.n_rows, window_s) + " to " +
         time_text(parts, last / parts.n_rows, last % parts.n_rows + 1, window_s);
}

}  // namespace

DayParts day_parts_of(const ScriptSpec& script) {
  DayParts parts;
  const double window_s = static_cast<double>(script.sensing.ticks_per_window) / script.sensing.tick_rate_hz;
  if (script.trials.size() != 1 || !script.trials.front().occupancy) return parts;
  const TrialSpec& trial = script.trials.front();
  const OccupancyRuns runs = runs_of(*trial.occupancy, script.begin);
  const double duration_s = trial.duration_s.value_or(runs.duration_s);
  parts.n_rows = static_cast<std::size_t>(std::max(0.0, std::floor(duration_s / window_s + 1e-6)));
  if (parts.n_rows == 0 || runs.begins_s.empty()) return parts;
  parts.trial = trial.id;
  parts.n_days = runs.begins_s.size();
  parts.of_row.assign(parts.n_days * parts.n_rows, DayParts::none);
  parts.people.assign(parts.of_row.size(), DayParts::not_sure);
  for (const double begin_s : runs.begins_s) {
    if (runs.clock) parts.begins_s.push_back(runs.clock->begin_s + std::llround(begin_s - runs.begins_s.front()));
  }
  const Presence presence(*trial.occupancy);
  std::map<std::string, std::vector<std::size_t>> rows_of_state;
  for (std::size_t i = 0; i < parts.of_row.size(); ++i) {
    const double from_s = runs.begins_s[i / parts.n_rows] + static_cast<double>(i % parts.n_rows) * window_s;
    const Presence::There& there = presence.between(from_s, from_s + window_s);
    parts.people[i] = there.people;
    rows_of_state[there.state].push_back(i);
  }
  for (const PartRows& part : split_rows(rows_of_state)) {
    for (const std::size_t row : part.rows) parts.of_row[row] = static_cast<std::uint16_t>(parts.names.size());
    parts.names.push_back(name_of(parts, part, window_s));
  }
  if (parts.names.empty())
    throw Error(ErrorCode::input, trial.occupancy->where,
                "too short to be compared: fewer than " + std::to_string(fewest_part_rows) +
                    " windows have the same number of people in them");
  return parts;
}

void require_known_presence(const ScriptSpec& script) {
  const auto drawn =
      std::ranges::find_if(script.trials, [](const TrialSpec& trial) { return trial.schedule.has_value(); });
  if (drawn == script.trials.end()) return;
  throw Error(
      ErrorCode::input, drawn->schedule->where,
      "a schedule draws who is there, and other people would be taken for a fault of a sensor: write the counts "
      "of the measured days instead, occupancy: {counts: FILE} (their column 'people' will do); without counts "
      "nothing of such days can be compared. `pirsim log` tells what they tell by themselves");
}

StudyFrame frame_of(const SceneSpec& scene, const ScriptSpec& script) {
  refuse_arrays(scene, "reconcile");
  StudyFrame frame;
  for (const TrialSpec& trial : script.trials) frame.trials.push_back(trial.id);
  for (const SensorSpec& sensor : scene.sensors) frame.sensors.push_back(sensor.id);
  frame.counted_phases = script.summary.phases;
  frame.window_s = static_cast<double>(script.sensing.ticks_per_window) / script.sensing.tick_rate_hz;
  frame.day_parts = day_parts_of(script);
  if (frame.day_parts.empty()) return frame;
  frame.trials = frame.day_parts.names;
  frame.counted_phases.clear();  // parts say what is counted
  return frame;
}

StudyFrame StudyFrame::of_whole_runs() const {
  StudyFrame whole = *this;
  if (!day_parts.empty()) whole.trials = {day_parts.trial};
  whole.day_parts = {};
  return whole;
}

std::vector<Series> in_day_parts(const StudyFrame& frame, std::vector<Series> runs) {
  const DayParts& parts = frame.day_parts;
  if (parts.empty()) return runs;
  const std::size_t n = frame.sensors.size();
  std::map<int, std::vector<const Series*>> datasets;  // by their numbers, the runs of each day
  for (const Series& run : runs) {
    const int day = (run.replicate - 1) % frame.n_days(), dataset = (run.replicate - 1) / frame.n_days();
    auto& days = datasets.try_emplace(dataset, parts.n_days, nullptr).first->second;
    days[static_cast<std::size_t>(day)] = &run;
  }
  std::vector<Series> all;
  for (const auto& [dataset, days] : datasets) {
    std::vector<Series> own(parts.names.size());
    std::vector<std::size_t> last(own.size(), 0);  // row of a part, from 1
    for (std::size_t i = 0; i < parts.of_row.size(); ++i) {
      const std::uint16_t part = parts.of_row[i];
      if (part == DayParts::none) continue;
      const std::size_t day = i / parts.n_rows, row = i % parts.n_rows;
      std::vector<std::uint8_t>& bits = own[part].bits;
      if (!bits.empty() && (last[part] != i || row == 0)) bits.insert(bits.end(), n, unknown_bit);
      last[part] = i + 1;
      const bool there = days[day] != nullptr && row < days[day]->n_rows(n);
      for (std::size_t sensor = 0; sensor < n; ++sensor)
        bits.push_back(there ? days[day]->bits[row * n + sensor] : unknown_bit);
    }
    for (std::size_t part = 0; part < own.size(); ++part) {
      own[part].trial = part;
      own[part].replicate = dataset + 1;
      own[part].main_end = own[part].n_rows(n);
      const bool known = std::ranges::any_of(own[part].bits, [](std::uint8_t bit) { return bit != unknown_bit; });
      if (known) all.push_back(std::move(own[part]));
    }
  }
  std::ranges::stable_sort(all, {}, [](const Series& run) { return std::pair(run.trial, run.replicate); });
  return all;
}

std::vector<std::size_t> all_trials(const StudyFrame& frame) { return stats::numbers_to(frame.trials.size()); }

std::optional<Series> series_of(const StudyFrame& frame, int replicate, std::string_view trial,
                                const std::vector<Sample>& samples) {
  const auto known = std::ranges::find(frame.trials, trial);
  const bool is_day = !frame.day_parts.empty() && trial == frame.day_parts.trial;
  if ((known == frame.trials.end() && !is_day) || samples.empty()) return std::nullopt;
  Series series;
  series.trial = is_day ? 0 : static_cast<std::size_t>(known - frame.trials.begin());
  series.replicate = replicate;
  series.bits.reserve(samples.size() * frame.sensors.size());
  bool begun = frame.counted_phases.empty();
  if (begun) series.main_end = samples.size();
  for (std::size_t row = 0; row < samples.size(); ++row) {
    series.bits.insert(series.bits.end(), samples[row].bits.begin(), samples[row].bits.end());
    if (std::ranges::find(frame.counted_phases, samples[row].phase) == frame.counted_phases.end()) continue;
    if (!begun) series.main_begin = row;
    begun = true;
    series.main_end = row + 1;
  }
  if (!begun) return std::nullopt;
  return series;
}

int Measured::n_replicates() const noexcept {
  std::map<std::size_t, std::set<int>> seen;  // of a trial
  for (const Series& run : runs) seen[run.trial].insert(run.replicate);
  for (const Sum& sum : sums) seen[sum.trial].insert(sum.replicate);
  std::size_t most = 0;
  for (const auto& [trial, numbers] : seen) most = std::max(most, numbers.size());
  return static_cast<int>(most);
}

std::vector<std::size_t> Measured::trials() const {
  std::set<std::size_t> all;
  for (const Series& run : runs) all.insert(run.trial);
  for (const Sum& sum : sums) all.insert(sum.trial);
  return {all.begin(), all.end()};
}

ScriptSpec with_holds(const SceneSpec& scene, const ScriptSpec& script, const Measured& measured) {
  constexpr const char* effect = "pulse_stretching";
  ScriptSpec held = script;
  const bool has_one = std::ranges::find(script.effects, effect, &EffectSpec::name) != script.effects.end();
  for (std::size_t sensor = 0; sensor < measured.holds_s.size() && !has_one; ++sensor) {
    if (measured.holds_s[sensor] <= 0.0) continue;
    held.effects.push_back(
        {effect, {{"hold_s", measured.holds_s[sensor]}}, {{"sensor", scene.sensors[sensor].id}}, {}});
  }
  return held;
}

}  // namespace pirsim::reconcile
