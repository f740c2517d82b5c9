// All runs of a study, in parallel, results in order.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "pirsim/rays.hpp"
#include "pirsim/sample.hpp"
#include "pirsim/model.hpp"

namespace pirsim {

enum class Record {
  samples,           ///< rows only
  samples_and_zones  ///< also every zone's activity at every tick: some 500 bytes a tick and sensor
};

enum class Trace {
  none,
  signals  ///< also what every analog sensor received, made of it and why at every tick; slow
};

struct RunResult {
  std::uint32_t run = 0;
  int replicate = 0;
  std::string trial;
  std::vector<Sample> samples;      ///< one a window
  std::vector<ZoneActivity> zones;  ///< (n_ticks x n_zones) from tick 1 on, if recorded
  std::vector<TraceRow> trace;      ///< (n_ticks x n_analog_sensors) if asked for; texts are the Model's
};

struct StudyOptions {
  unsigned threads = 0;  ///< 0: all cores. Never changes a byte of the results.
  Record record = Record::samples;
  std::optional<RunRange> runs{};   ///< default: all of the study
  std::function<bool()> goes_on{};  ///< asked before each run; after a false no further one begins
  Trace trace = Trace::none;
};

/// Runs the study, or a range of it, and hands each run's result to `consume` in the order of runs, from one thread at
/// a time. Memory is bounded by a few runs a thread. Throws what a run or `consume` throws.
void run_study(const Model& model, const StudyOptions& options, const std::function<void(const RunResult&)>& consume);

/// One run from beginning to end.
[[nodiscard]] RunResult run_once(const Model& model, std::uint32_t run, Record record = Record::samples,
                                 Trace trace = Trace::none);

}  // namespace pirsim
