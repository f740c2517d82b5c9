// All runs of a study, in parallel, results in order.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "pirsim/model.hpp"
#include "pirsim/rays.hpp"
#include "pirsim/sample.hpp"

namespace pirsim {

enum class Record {
  samples,           ///< rows only
  samples_and_zones  ///< also which zones are active at every tick
};

enum class Trace {
  none,
  signals  ///< also what every analog sensor received, made of it and why at every tick; slow
};

enum class Occupants {
  counted,  ///< rows say how many people there are
  told      ///< also who is where and does what, a row a window and person
};

enum class Frames {
  none,
  taken  ///< also those of thermopile arrays
};

struct RunResult {
  std::uint32_t run = 0;
  int replicate = 0;
  std::string trial;
  std::vector<Sample> samples;           ///< one a window
  std::vector<ZoneSet> zones;            ///< (n_ticks) active ones, from tick 1 on, if recorded
  std::vector<TraceRow> trace;           ///< (n_ticks x n_analog_sensors) if asked for; texts are the Model's
  std::vector<OccupantRow> occupants{};  ///< if asked for
  std::vector<FrameStack> frames{};      ///< (n_arrays) if asked for
  std::vector<RunIncident> incidents{};  ///< in the order of time
  std::optional<RunFault> fault{};       ///< then there is nothing of the above
};

struct StudyOptions {
  unsigned threads = 0;  ///< 0: all cores. Never changes a byte of the results.
  Record record = Record::samples;
  std::optional<RunRange> runs{};       ///< default: all of the study
  std::function<bool()> goes_on{};      ///< asked before each run; after a false no further one begins
  std::function<void()> window_done{};  ///< after each simulated window of any run, from any thread; keep it short
  Trace trace = Trace::none;
  Occupants occupants = Occupants::counted;
  std::optional<std::vector<std::uint32_t>> chosen{};  ///< instead of `runs`: these, in this order
  Frames frames = Frames::none;
};

/// Runs the study, or a part of it, and hands each run's result to `consume` in the order of runs, from one thread at
/// a time. Memory is bounded by a few runs a thread. A run that can't go on is handed on with its fault and without
/// rows, and the others go on. Throws what `consume` throws.
void run_study(const Model& model, const StudyOptions& options, const std::function<void(const RunResult&)>& consume);

/// One run from beginning to end, with its fault if it can't go on.
[[nodiscard]] RunResult run_once(const Model& model, std::uint32_t run, Record record = Record::samples,
                                 Trace trace = Trace::none, Occupants occupants = Occupants::counted,
                                 Frames frames = Frames::none);

}  // namespace pirsim
