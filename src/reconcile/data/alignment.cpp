#include "reconcile/data/alignment.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "model/core/text.hpp"
#include "pirsim/csv.hpp"
#include "pirsim/error.hpp"

namespace pirsim::reconcile {
namespace {

/// The arm's cycle of desk work. Of 2 and 3 rows this one tells a share that changes best.
constexpr std::size_t reach_rows = 3;

bool moves_between(const Series& run, std::size_t begin, std::size_t end, std::size_t sensor, std::size_t n_sensors) {
  for (std::size_t row = begin; row < end; ++row) {
    if (run.bits[row * n_sensors + sensor] == 1) return true;
  }
  return false;
}

constexpr std::size_t a_row = 1;    ///< by which walks of people with another gait may be shorter (assumed)
constexpr double longer_by = 1.05;  ///< times as long may main parts be, or as short: who sits down earlier (assumed)

/// Rows of the runs of one trial.
struct Lengths {
  std::size_t shortest_lead = 0, shortest_tail = 0, shortest_main = 0, longest_main = 0;
};

Lengths lengths_of(std::size_t trial, std::span<const Series> runs, std::size_t n_sensors) {
  std::optional<Lengths> known;
  for (const Series& run : runs) {
    if (run.trial != trial) continue;
    const std::size_t tail = run.n_rows(n_sensors) - run.main_end, main = run.main_end - run.main_begin;
    if (!known) known = {run.main_begin, tail, main, main};
    known->shortest_lead = std::min(known->shortest_lead, run.main_begin);
    known->shortest_tail = std::min(known->shortest_tail, tail);
    known->shortest_main = std::min(known->shortest_main, main);
    known->longest_main = std::max(known->longest_main, main);
  }
  return known.value_or(Lengths{});
}

/// (n_sensors) 1 where all bits of a part (n_rows x n_sensors) before or after the main one are known, and as many as
/// in the shortest of its kind.
std::vector<std::uint8_t> known_sensors(std::span<const std::uint8_t> part, std::size_t shortest,
                                        std::size_t n_sensors) {
  const std::size_t n_rows = part.size() / n_sensors;
  std::vector<std::uint8_t> known(n_sensors, n_rows > 0 && n_rows + a_row >= shortest ? 1 : 0);
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i] == unknown_bit) known[i % n_sensors] = 0;
  }
  return known;
}

/// n_main: rows of the main part to look at.
DataShape::Run shape_of_run(const Series& run, std::size_t n_main, const Lengths& usual, std::size_t n_sensors) {
  const std::span<const std::uint8_t> bits = run.bits;
  const auto main = bits.subspan(run.main_begin * n_sensors, n_main * n_sensors);
  DataShape::Run shape{run.trial,
                       run.replicate,
                       n_main,
                       known_sensors(bits.first(run.main_begin * n_sensors), usual.shortest_lead, n_sensors),
                       known_sensors(bits.subspan(run.main_end * n_sensors), usual.shortest_tail, n_sensors),
                       {}};
  if (std::ranges::find(main, unknown_bit) == main.end()) return shape;
  for (const std::uint8_t bit : main) shape.unknown.push_back(bit == unknown_bit ? 1 : 0);
  return shape;
}

/// Rows of a measured run's main part to look at: no more than in any simulated one, where no effect acts after the
/// end.
std::size_t n_main_of(const Series& run, const Lengths& usual) {
  const std::size_t n_main = run.main_end - run.main_begin;
  return usual.longest_main > 0 ? std::min(n_main, usual.longest_main) : n_main;
}

/// Of these runs, those with sums, blind where there are none.
std::vector<DataShape::Run> summed(const Measured& measured, std::size_t n_sensors,
                                   const std::vector<DataShape::Run>& runs) {
  std::vector<DataShape::Run> all;
  for (const DataShape::Run& run : runs) {
    std::vector<std::uint8_t> unknown(n_sensors, 1);
    for (const Measured::Sum& sum : measured.sums) {
      if (sum.trial == run.trial && sum.replicate == run.replicate) unknown[sum.sensor] = 0;
    }
    const auto n_unknown = static_cast<std::size_t>(std::ranges::count(unknown, 1));
    if (n_unknown == n_sensors) continue;
    all.push_back(run);
    for (std::size_t row = 0; row < run.n_main && n_unknown > 0; ++row)
      all.back().unknown.insert(all.back().unknown.end(), unknown.begin(), unknown.end());
  }
  return all;
}

/// Tells all faults at once.
void refuse_longer_than_study(const StudyFrame& frame, const Measured& measured, std::span<const Series> pilot) {
  // Without counted phases there is no part that rows could be taken for, but a sum can still be too large.
  const bool counts_all = frame.counted_phases.empty();
  const std::string part = counts_all ? "a run" : "'" + joined(frame.counted_phases, ", ") + "'";
  Diagnostics faults;
  for (std::size_t trial = 0; trial < frame.trials.size(); ++trial) {
    const auto longest = static_cast<double>(lengths_of(trial, pilot, frame.sensors.size()).longest_main);
    if (longest == 0.0) continue;
    const auto refuse = [&](const std::string& what, const std::string& hint) {
      faults.error({measured.file, 0, 0}, "trial '" + frame.trials[trial] + "': " + what + ", but " + part +
                                              " lasts at most " + io::csv_number(longest * frame.window_s) +
                                              " s in the simulation; " + hint);
    };
    for (const Measured::Sum& sum : measured.sums) {
      if (sum.trial != trial || sum.seconds <= longer_by * longest * frame.window_s) continue;
      refuse("'" + frame.sensors[sum.sensor] + "' has " + io::csv_number(sum.seconds) + " s with motion",
             counts_all ? "give the sum of one run" : "give the sum of one run, of that part only");
    }
    for (const Series& run : measured.runs) {
      const std::size_t n_main = run.main_end - run.main_begin;
      if (counts_all || measured.tells_phases || run.trial != trial ||
          static_cast<double>(n_main) <= longer_by * longest)
        continue;
      refuse(std::to_string(n_main) + " rows without a column 'phase'", "leave out the others, or give the phases");
    }
  }
  faults.throw_if_errors();
}

}  // namespace

std::vector<Gaps> gaps_of(const Series& run, std::size_t n_sensors) {
  std::vector<Gaps> gaps(n_sensors);
  for (std::size_t row = run.main_begin; row < run.main_end; ++row) {
    const std::size_t first = row - std::min(row - run.main_begin, reach_rows);
    const std::size_t last = std::min(run.main_end, row + 1 + reach_rows);
    for (std::size_t s = 0; s < n_sensors; ++s) {
      const std::uint8_t bit = run.bits[row * n_sensors + s];
      if (bit == unknown_bit || !moves_between(run, first, row, s, n_sensors) ||
          !moves_between(run, row + 1, last, s, n_sensors))
        continue;
      gaps[s].awaited += 1.0;
      gaps[s].silent += bit == 0 ? 1.0 : 0.0;
    }
  }
  return gaps;
}

const Series* run_of(std::span<const Series> runs, const DataShape::Run& shape) {
  const auto run = std::ranges::find_if(
      runs, [&](const Series& s) { return s.trial == shape.trial && s.replicate == shape.replicate; });
  return run == runs.end() ? nullptr : &*run;
}

bool knows_main_part(const DataShape::Run& shape, std::size_t sensor, std::size_t n_sensors) {
  bool any = shape.unknown.empty();
  for (std::size_t i = sensor; i < shape.unknown.size() && !any; i += n_sensors) any = shape.unknown[i] == 0;
  return any;
}

DataShape full_shape(const StudyFrame& frame, Measured::Kind kind, int n_replicates, std::span<const Series> pilot) {
  DataShape shape{kind, {}, n_replicates, std::vector<std::uint8_t>(frame.n_cells(), 1)};
  for (std::size_t trial = 0; trial < frame.trials.size(); ++trial) {
    const auto run = std::ranges::find(pilot, trial, &Series::trial);
    if (run == pilot.end()) continue;
    for (int replicate = 1; replicate <= n_replicates; ++replicate) {
      shape.runs.push_back(shape_of_run(*run, run->main_end - run->main_begin, {}, frame.sensors.size()));
      shape.runs.back().replicate = replicate;
    }
  }
  return shape;
}

DataShape shape_of(const StudyFrame& frame, const Measured& measured, std::span<const Series> pilot) {
  refuse_longer_than_study(frame, measured, pilot);
  const std::size_t n = frame.sensors.size();
  DataShape shape = full_shape(frame, measured.kind, measured.n_replicates(), pilot);
  std::ranges::fill(shape.known_cells, std::uint8_t{0});
  for (const Measured::Sum& sum : measured.sums) shape.known_cells[frame.cell(sum.trial, sum.sensor)] = 1;
  if (measured.kind == Measured::Kind::sums) {
    shape.runs = summed(measured, n, shape.runs);
    return shape;
  }
  shape.runs.clear();
  for (const Series& run : measured.runs) {
    const Lengths usual = lengths_of(run.trial, pilot, n);
    shape.runs.push_back(shape_of_run(run, n_main_of(run, usual), usual, n));
    for (std::size_t i = run.main_begin * n; i < run.main_end * n; ++i) {
      if (run.bits[i] != unknown_bit) shape.known_cells[frame.cell(run.trial, i % n)] = 1;
    }
  }
  return shape;
}

std::vector<std::string> notes_on(const StudyFrame& frame, const DataShape& shape, const Measured& measured,
                                  std::span<const Series> pilot) {
  const std::size_t n = frame.sensors.size();
  std::size_t leads = 0, tails = 0, begun = 0, shorter = 0, longer = 0;
  for (std::size_t i = 0; i < measured.runs.size(); ++i) {
    const Series& run = measured.runs[i];
    const DataShape::Run& of_run = shape.runs[i];
    const Lengths usual = lengths_of(run.trial, pilot, n);
    const auto left_out_of_any = [&](const std::vector<std::uint8_t>& known) {
      for (std::size_t sensor = 0; sensor < n; ++sensor) {
        if (known[sensor] == 0 && knows_main_part(of_run, sensor, n)) return 1;
      }
      return 0;
    };
    const std::size_t n_main = run.main_end - run.main_begin;
    leads += run.main_begin > 0 ? left_out_of_any(of_run.lead_known) : 0;
    tails += run.main_end < run.n_rows(n) ? left_out_of_any(of_run.tail_known) : 0;
    begun += measured.tells_phases && run.main_begin == 0 && usual.shortest_lead > a_row ? 1 : 0;
    shorter += longer_by * static_cast<double>(n_main) < static_cast<double>(usual.shortest_main) ? 1 : 0;
    longer += of_run.n_main < n_main ? 1 : 0;
  }
  std::vector<std::string> notes;
  const auto tell = [&](std::size_t n_runs, const std::string& text) {
    if (n_runs > 0) notes.push_back(text);
  };
  const auto left_out = [&](std::size_t n_runs, const std::string& which, const std::string& because) {
    tell(n_runs, "What comes " + which + " the counted phases is left out of the comparison in " +
                     counted(n_runs, "run") + ", of all sensors or some: " + because +
                     ", or some readings are unknown.");
  };
  left_out(leads, "before", "the recording begins later than any simulated one");
  left_out(tails, "after", "the recording ends earlier than any simulated one");
  tell(begun, counted(begun, "run") + " of the file " + (begun == 1 ? "begins" : "begin") +
                  " in a counted phase: the first row is taken for its beginning.");
  tell(shorter, "The main part of " + counted(shorter, "run") +
                    " of the file ends before any simulated one, by a twentieth or more: compared as far as it goes.");
  tell(longer, "What goes on after the end of the longest simulated run is left out of the comparison in " +
                   counted(longer, "run") + ".");
  return notes;
}

}  // namespace pirsim::reconcile
