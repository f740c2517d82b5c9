#include "reconcile/data/measured.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include "io/files/compression.hpp"
#include "io/files/input.hpp"
#include "reconcile/data/measured_log.hpp"
#include "reconcile/data/measured_reader.hpp"
#include "schema/clock.hpp"

namespace pirsim::reconcile {

StudyFrame frame_of(const SceneSpec& scene, const ScriptSpec& script) {
  StudyFrame frame;
  for (const TrialSpec& trial : script.trials) frame.trials.push_back(trial.id);
  for (const SensorSpec& sensor : scene.sensors) frame.sensors.push_back(sensor.id);
  frame.counted_phases = script.summary.phases;
  frame.window_s = static_cast<double>(script.sensing.ticks_per_window) / script.sensing.tick_rate_hz;
  frame.units = units_of(script);
  if (frame.units.empty()) return frame;
  frame.trials = frame.units.names;
  frame.counted_phases.clear();  // units say what is counted
  return frame;
}

StudyFrame StudyFrame::of_whole_runs() const {
  StudyFrame whole = *this;
  if (!units.empty()) whole.trials = {units.trial};
  whole.units = {};
  return whole;
}

std::vector<Series> in_units(const StudyFrame& frame, std::vector<Series> runs) {
  const Units& units = frame.units;
  if (units.empty()) return runs;
  const std::size_t n = frame.sensors.size();
  std::map<int, std::vector<const Series*>> datasets;  // by their numbers, the runs of each day
  for (const Series& run : runs) {
    const int day = (run.replicate - 1) % frame.n_days(), dataset = (run.replicate - 1) / frame.n_days();
    auto& days = datasets.try_emplace(dataset, units.n_days, nullptr).first->second;
    days[static_cast<std::size_t>(day)] = &run;
  }
  std::vector<Series> all;
  for (const auto& [dataset, days] : datasets) {
    std::vector<Series> own(units.names.size());
    std::vector<std::size_t> last(own.size(), 0);  // row of a unit, from 1
    for (std::size_t i = 0; i < units.of_row.size(); ++i) {
      const std::uint16_t unit = units.of_row[i];
      if (unit == Units::none) continue;
      const std::size_t day = i / units.n_rows, row = i % units.n_rows;
      std::vector<std::uint8_t>& bits = own[unit].bits;
      if (!bits.empty() && (last[unit] != i || row == 0)) bits.insert(bits.end(), n, unknown_bit);
      last[unit] = i + 1;
      const bool there = days[day] != nullptr && row < days[day]->n_rows(n);
      for (std::size_t sensor = 0; sensor < n; ++sensor)
        bits.push_back(there ? days[day]->bits[row * n + sensor] : unknown_bit);
    }
    for (std::size_t unit = 0; unit < own.size(); ++unit) {
      own[unit].trial = unit;
      own[unit].replicate = dataset + 1;
      own[unit].main_end = own[unit].n_rows(n);
      const bool known = std::ranges::any_of(own[unit].bits, [](std::uint8_t bit) { return bit != unknown_bit; });
      if (known) all.push_back(std::move(own[unit]));
    }
  }
  std::ranges::stable_sort(all, {}, [](const Series& run) { return std::pair(run.trial, run.replicate); });
  return all;
}

std::vector<std::size_t> all_trials(const StudyFrame& frame) {
  std::vector<std::size_t> trials(frame.trials.size());
  std::iota(trials.begin(), trials.end(), std::size_t{0});
  return trials;
}

std::optional<Series> series_of(const StudyFrame& frame, int replicate, std::string_view trial,
                                const std::vector<Sample>& samples) {
  const auto known = std::ranges::find(frame.trials, trial);
  const bool is_day = !frame.units.empty() && trial == frame.units.trial;
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

namespace {

void note_missing_trials(const StudyFrame& frame, Measured& measured) {
  std::vector<std::string> absent;
  const std::vector<std::size_t> present = measured.trials();
  for (std::size_t trial = 0; trial < frame.trials.size(); ++trial) {
    if (!std::ranges::binary_search(present, trial)) absent.push_back(frame.trials[trial]);
  }
  if (absent.empty()) return;
  measured.notes.push_back({DataNote::What::trials_absent, absent.size(), absent});
}

std::optional<std::int64_t> begin_of(const ScriptSpec& script) {
  const std::optional<RunClock> clock = clock_of(script, script.trials.front());
  return clock ? std::optional(clock->begin_s) : std::nullopt;
}

}  // namespace

Measured parse_measured(std::string_view text, const std::string& file, const StudyFrame& frame) {
  Measured measured = MeasuredReader(text, file, frame).read();
  note_missing_trials(frame, measured);
  return measured;
}

Measured read_measured(const std::filesystem::path& file, const StudyFrame& frame) {
  return parse_measured(io::decompressed(io::read_input(file), io::max_text_file_bytes), file.string(), frame);
}

Measured measured_of(const Log& log, const SceneSpec& scene, const ScriptSpec& script) {
  require_known_presence(script);
  const StudyFrame frame = frame_of(scene, script);
  Measured measured = measured_of(log, frame, begin_of(script));
  note_missing_trials(frame, measured);
  return measured;
}

Measured read_measured(const std::filesystem::path& file, const SceneSpec& scene, const ScriptSpec& script,
                       const LogMap& map) {
  require_known_presence(script);
  // A pipe can't be looked into before it is read: a map says that it is a log.
  const bool is_piped_log = map != LogMap{} && !std::filesystem::is_regular_file(file);
  if (is_piped_log || is_log(file)) return measured_of(io::read_log(std::span(&file, 1), map), scene, script);
  if (map != LogMap{})
    throw Error(ErrorCode::usage, file.string() + " is no log (docs/formats/log.md), so that a map says nothing of it");
  return read_measured(file, frame_of(scene, script));
}

Measured parse_measured(std::string_view text, const std::string& file, const SceneSpec& scene,
                        const ScriptSpec& script) {
  require_known_presence(script);
  return parse_measured(text, file, frame_of(scene, script));
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
