#include "reconcile/data/measured.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "io/files/compression.hpp"
#include "io/files/input.hpp"
#include "pirsim/columns.hpp"
#include "reconcile/data/measured_reader.hpp"

namespace pirsim::reconcile {

StudyFrame frame_of(const SceneSpec& scene, const ScriptSpec& script) {
  StudyFrame frame;
  for (const TrialSpec& trial : script.trials) frame.trials.push_back(trial.id);
  for (const SensorSpec& sensor : scene.sensors) frame.sensors.push_back(sensor.id);
  frame.counted_phases = script.summary.phases;
  frame.window_s = static_cast<double>(script.sensing.ticks_per_window) / script.sensing.tick_rate_hz;
  return frame;
}

std::vector<std::string> measured_columns(const StudyFrame& frame) {
  return column_names<Sample>(frame.sensors, [](When when) { return when == When::always; });
}

std::vector<std::size_t> all_trials(const StudyFrame& frame) {
  std::vector<std::size_t> trials(frame.trials.size());
  std::iota(trials.begin(), trials.end(), std::size_t{0});
  return trials;
}

std::optional<Series> series_of(const StudyFrame& frame, int replicate, std::string_view trial,
                                const std::vector<Sample>& samples) {
  const auto known = std::ranges::find(frame.trials, trial);
  if (known == frame.trials.end() || samples.empty()) return std::nullopt;
  Series series;
  series.trial = static_cast<std::size_t>(known - frame.trials.begin());
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

Measured parse_measured(std::string_view text, const std::string& file, const StudyFrame& frame) {
  return MeasuredReader(text, file, frame).read();
}

Measured read_measured(const std::filesystem::path& file, const StudyFrame& frame) {
  return parse_measured(io::decompressed(io::read_input(file), io::max_text_file_bytes), file.string(), frame);
}

Measured read_measured(const std::filesystem::path& file, const SceneSpec& scene, const ScriptSpec& script) {
  return read_measured(file, frame_of(scene, script));
}

Measured parse_measured(std::string_view text, const std::string& file, const SceneSpec& scene,
                        const ScriptSpec& script) {
  return parse_measured(text, file, frame_of(scene, script));
}

}  // namespace pirsim::reconcile
