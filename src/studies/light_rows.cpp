#include "studies/light_rows.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pirsim/model.hpp"
#include "pirsim/study.hpp"
#include "schema/areas.hpp"

namespace pirsim::studies {
namespace {

constexpr std::size_t word_bits = 64;

void set_bit(RowBits& bits, std::size_t row) { bits[row / word_bits] |= std::uint64_t{1} << (row % word_bits); }

/// Without areas all people are in the only one.
LightRun run_of(const RunResult& result, std::size_t n_areas, std::size_t n_sensors) {
  LightRun run;
  run.n_rows = result.samples.size();
  const RowBits nothing((run.n_rows + word_bits - 1) / word_bits, 0);
  run.occupied.assign(n_areas, nothing);
  run.moved.assign(n_sensors, nothing);
  for (std::size_t row = 0; row < run.n_rows; ++row) {
    const Sample& sample = result.samples[row];
    for (std::size_t area = 0; area < n_areas; ++area) {
      if ((sample.people_of_areas.empty() ? sample.people : sample.people_of_areas[area]) > 0)
        set_bit(run.occupied[area], row);
    }
    for (std::size_t sensor = 0; sensor < n_sensors; ++sensor) {
      if (sample.bits[sensor] == 1) set_bit(run.moved[sensor], row);
    }
  }
  return run;
}

/// What people do about the dark belongs to the aim, not to a rule of its own.
control::SwitchRule rule_of(const PlacementLightSpec& light, double window_s) {
  control::LightSpec spec;
  spec.wave_s = light.wave_s;
  return {spec, window_s};
}

/// Row by row through the switch; words in which nothing happens in the dark are passed over.
void switch_run(const RowBits& occupied, const RowBits& moved, std::size_t n_rows, const control::SwitchRule& rule,
                std::int64_t delay_rows, LightSums& sums) {
  control::LightSwitch light;
  for (std::size_t word = 0; word < occupied.size(); ++word) {
    const std::size_t first = word * word_bits, n = std::min(word_bits, n_rows - first);
    if (!light.is_lit() && occupied[word] == 0 && moved[word] == 0) {
      light.rest(static_cast<std::int64_t>(n));
      continue;
    }
    for (std::size_t bit = 0; bit < n; ++bit) {
      const control::Cue cue{(moved[word] >> bit & 1U) != 0, (occupied[word] >> bit & 1U) != 0, false};
      const bool was_lit = light.is_lit();
      light.advance(rule, cue, delay_rows);
      sums.occupied += cue.occupied ? 1 : 0;
      if (light.is_lit()) {
        sums.lit_empty += cue.occupied ? 0 : 1;
      } else if (cue.occupied) {
        ++sums.dark;
        sums.false_offs += was_lit ? 1 : 0;
      }
    }
  }
}

PlacementLight told(const LightSums& sums, double window_s) {
  const double row_h = window_s / 3600.0;
  PlacementLight light;
  light.occupied_h = static_cast<double>(sums.occupied) * row_h;
  light.false_offs = sums.false_offs;
  light.dark_h = static_cast<double>(sums.dark) * row_h;
  light.lit_empty_h = static_cast<double>(sums.lit_empty) * row_h;
  return light;
}

}  // namespace

LightRows light_rows(const SceneSpec& scene, const PlacementLightSpec& light, const SensingSpec& sensing,
                     unsigned threads, const RunsDone& done) {
  ScriptSpec script = light.people;
  if (sensing.response) script.sensing.response = sensing.response;
  const Model model = compile(scene, std::move(script));
  const Areas areas(scene);
  LightRows rows;
  rows.window_s = static_cast<double>(model.script().sensing.ticks_per_window) / model.script().sensing.tick_rate_hz;
  rows.areas = areas.empty() ? std::vector<std::string>{""} : areas.names();
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) {
    rows.sensors.push_back(scene.sensors[i].id);
    rows.area_of.push_back(areas.empty() ? std::optional<std::size_t>(0) : areas.of_sensors()[i]);
  }
  std::size_t n_done = 0;
  run_study(model, {.threads = threads}, [&](const RunResult& result) {
    if (result.fault) {
      rows.warnings.push_back({Severity::warning,
                               {scene.name},
                               "the light's people: run " + std::to_string(result.replicate) + " of trial '" +
                                   result.trial + "' can't go on, and is left out: " + result.fault->message});
    } else {
      rows.runs.push_back(run_of(result, rows.areas.size(), rows.sensors.size()));
    }
    done(++n_done, model.n_runs());
  });
  return rows;
}

LightSums& LightSums::operator+=(const LightSums& other) noexcept {
  occupied += other.occupied;
  false_offs += other.false_offs;
  dark += other.dark;
  lit_empty += other.lit_empty;
  return *this;
}

bool LightSums::better_than(const LightSums& other) const noexcept {
  return std::tie(false_offs, dark, lit_empty) < std::tie(other.false_offs, other.dark, other.lit_empty);
}

LightSums switch_light(const LightRows& rows, std::size_t area, std::span<const std::size_t> sensors,
                       const PlacementLightSpec& light) {
  const control::SwitchRule rule = rule_of(light, rows.window_s);
  const std::int64_t delay_rows = std::llround(60.0 * light.delay_min / rows.window_s);
  LightSums sums;
  RowBits moved;
  for (const LightRun& run : rows.runs) {
    moved.assign(run.occupied[area].size(), 0);
    for (const std::size_t sensor : sensors) {
      for (std::size_t word = 0; word < moved.size(); ++word) moved[word] |= run.moved[sensor][word];
    }
    switch_run(run.occupied[area], moved, run.n_rows, rule, delay_rows, sums);
  }
  return sums;
}

LightScore score_light(const LightRows& rows, const PlacementLightSpec& light) {
  LightScore score;
  LightSums all;
  for (std::size_t area = 0; area < rows.areas.size(); ++area) {
    std::vector<std::size_t> sensors;
    for (std::size_t i = 0; i < rows.sensors.size(); ++i) {
      if (rows.area_of[i] == area) sensors.push_back(i);
    }
    const LightSums sums = switch_light(rows, area, sensors, light);
    all += sums;
    PlacementLight of_area = told(sums, rows.window_s);
    of_area.area = rows.areas[area];
    for (const std::size_t sensor : sensors) of_area.sensors.push_back(rows.sensors[sensor]);
    if (sums.occupied > 0 || !sensors.empty()) score.areas.push_back(std::move(of_area));
  }
  score.all = told(all, rows.window_s);
  score.all.sensors = rows.sensors;
  return score;
}

}  // namespace pirsim::studies
