#include "reconcile/statistics.hpp"

#include <algorithm>
#include <boost/algorithm/string/join.hpp>
#include <cmath>
#include <limits>

#include "pirsim/csv.hpp"
#include "pirsim/error.hpp"
#include "reconcile/bit_statistics.hpp"

namespace pirsim::reconcile {
namespace {

constexpr float nothing_known = std::numeric_limits<float>::quiet_NaN();
constexpr double busy_share = 0.12;  ///< of the rows
constexpr std::size_t a_row = 1;     ///< by which walks of people with another gait may be shorter (assumed)
constexpr double longer_by = 1.05;   ///< times as long may main parts be, or as short: who sits down earlier (assumed)

constexpr auto first_sixth = static_cast<std::size_t>(CellStatistic::sixth_1);
constexpr std::array<std::string_view, first_sixth> cell_names{
    "seconds",       "busy_seconds",  "silent_seconds", "half_difference",   "onsets",        "longest_run",
    "isolated",      "single_gaps",   "double_gaps",    "again_after_1",     "again_after_2", "again_after_3",
    "again_after_4", "again_after_6", "longest_gap",    "dispersion",        "period_power",  "cycle_strength",
    "agreement",     "lead_seconds",  "tail_seconds",   "late_tail_seconds", "run_variance"};
constexpr auto first_slice = static_cast<std::size_t>(TrialStatistic::slice_1);
constexpr std::size_t n_slices = n_trial_statistics - first_slice;
constexpr std::array<std::string_view, first_slice> trial_names{
    "lag_minus_4", "lag_minus_2", "lag_minus_1", "lag_0",      "lag_1",      "lag_2",        "lag_3",       "lag_5",
    "lag_8",       "lag_11",      "lag_15",      "any_active", "two_active", "three_active", "coactivation"};
constexpr std::array<int, 11> lags{-4, -2, -1, 0, 1, 2, 3, 5, 8, 11, 15};

/// A run's main part, as long as the shape says and blind where it is: (n_main x n_sensors).
std::vector<std::uint8_t> main_bits(const Series& run, const DataShape::Run& shape, std::size_t n_sensors) {
  const std::size_t first = run.main_begin * n_sensors;
  const std::size_t last = std::min(run.main_end, run.main_begin + shape.n_main) * n_sensors;
  std::vector<std::uint8_t> bits(run.bits.begin() + static_cast<std::ptrdiff_t>(first),
                                 run.bits.begin() + static_cast<std::ptrdiff_t>(last));
  bits.resize(shape.n_main * n_sensors, 0);  // people have left: no motion
  for (std::size_t i = 0; i < shape.unknown.size(); ++i) {
    if (shape.unknown[i] != 0) bits[i] = unknown_bit;
  }
  return bits;
}

/// (n_main) of one sensor.
template <typename Value>
std::vector<Value> column(const std::vector<Value>& table, std::size_t n_columns, std::size_t which) {
  std::vector<Value> values;
  values.reserve(table.size() / n_columns);
  for (std::size_t i = which; i < table.size(); i += n_columns) values.push_back(table[i]);
  return values;
}

bool knows_main_part(const DataShape::Run& shape, std::size_t sensor, std::size_t n_sensors) {
  bool any = shape.unknown.empty();
  for (std::size_t i = sensor; i < shape.unknown.size() && !any; i += n_sensors) any = shape.unknown[i] == 0;
  return any;
}

double seconds_between(const Series& run, std::size_t begin, std::size_t end, std::size_t sensor, std::size_t n_sensors,
                       double window_s) {
  std::size_t rows = 0;
  for (std::size_t row = begin; row < end; ++row) rows += run.bits[row * n_sensors + sensor] == 1 ? 1 : 0;
  return static_cast<double>(rows) * window_s;
}

/// Collects the statistics of the runs of one trial.
class TrialStatistics {
 public:
  TrialStatistics(const StudyFrame& frame, const Profile::Trial& profile)
      : frame_(frame),
        profile_(profile),
        cells_(frame.sensors.size()),
        seconds_(frame.sensors.size()),
        pairs_(n_pairs(frame), 0.0),
        lead_known_(frame.sensors.size(), 1),
        tail_known_(frame.sensors.size(), 1) {}

  void add(const Series& run, const DataShape::Run& shape, Measured::Kind kind) {
    const std::vector<std::uint8_t> bits = main_bits(run, shape, frame_.sensors.size());
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      if (!knows(shape, sensor)) continue;
      add_cell(run, shape, bits, sensor);
      lead_known_[sensor] &= shape.lead_known[sensor];
      tail_known_[sensor] &= shape.tail_known[sensor];
    }
    if (kind == Measured::Kind::series) add_trial(bits);
    ++n_runs_;
  }

  void write(std::size_t trial, const DataShape& shape, std::vector<float>& out) const {
    if (n_runs_ == 0) return;
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      if (shape.known_cells[trial * frame_.sensors.size() + sensor] == 0) continue;
      for (std::size_t i = 0; i < n_cell_statistics; ++i) {
        const auto statistic = static_cast<CellStatistic>(i);
        if (!known(sensor, statistic, shape.kind)) continue;
        out[cell_index(frame_, trial, sensor, statistic)] = static_cast<float>(value_of(sensor, statistic));
      }
    }
    if (shape.kind != Measured::Kind::series) return;
    for (std::size_t i = 0; i < n_trial_statistics; ++i) {
      out[trial_index(frame_, trial, static_cast<TrialStatistic>(i))] = static_cast<float>(trial_[i] / n_runs_);
    }
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      out[pair_index(frame_, trial, 0, 1) + i] = static_cast<float>(pairs_[i] / n_runs_);
    }
  }

 private:
  [[nodiscard]] bool knows(const DataShape::Run& shape, std::size_t sensor) const {
    return knows_main_part(shape, sensor, frame_.sensors.size());
  }
  [[nodiscard]] bool known(std::size_t sensor, CellStatistic statistic, Measured::Kind kind) const {
    if (statistic == CellStatistic::run_variance) return seconds_[sensor].size() > 1;
    if (statistic == CellStatistic::seconds) return true;
    if (kind == Measured::Kind::sums) return false;
    if (statistic == CellStatistic::lead_seconds) return lead_known_[sensor] != 0;
    if (statistic != CellStatistic::tail_seconds && statistic != CellStatistic::late_tail_seconds) return true;
    return tail_known_[sensor] != 0;
  }
  [[nodiscard]] double value_of(std::size_t sensor, CellStatistic statistic) const {
    const auto n_runs = static_cast<double>(seconds_[sensor].size());
    if (statistic != CellStatistic::run_variance) {
      return cells_[sensor][static_cast<std::size_t>(statistic)] / n_runs;
    }
    const double mean = cells_[sensor][static_cast<std::size_t>(CellStatistic::seconds)] / n_runs;
    double squares = 0.0;
    for (const double seconds : seconds_[sensor]) squares += (seconds - mean) * (seconds - mean);
    return squares / (n_runs - 1.0);
  }

  void add_cell(const Series& run, const DataShape::Run& shape, const std::vector<std::uint8_t>& bits,
                std::size_t sensor) {
    const std::size_t n = frame_.sensors.size();
    const std::vector<std::uint8_t> own = column(bits, n, sensor);
    std::vector<float> expected = column(profile_.expected, n, sensor);
    std::vector<std::uint8_t> busy = profile_.busy;
    expected.resize(shape.n_main, 0.0F);
    busy.resize(shape.n_main, 0);
    CellValues values{};
    add_main_statistics({own, expected, busy, profile_.cycle_rows}, frame_.window_s, values);
    const std::size_t n_rows = run.n_rows(n), half_tail = run.main_end + (n_rows - run.main_end) / 2;
    const auto set = [&](CellStatistic statistic, std::size_t begin, std::size_t end) {
      values[static_cast<std::size_t>(statistic)] = seconds_between(run, begin, end, sensor, n, frame_.window_s);
    };
    set(CellStatistic::lead_seconds, 0, run.main_begin);
    set(CellStatistic::tail_seconds, run.main_end, n_rows);
    set(CellStatistic::late_tail_seconds, half_tail, n_rows);
    for (std::size_t i = 0; i < n_cell_statistics; ++i) cells_[sensor][i] += values[i];
    seconds_[sensor].push_back(values[static_cast<std::size_t>(CellStatistic::seconds)]);
  }

  void add_trial(const std::vector<std::uint8_t>& bits) {
    const std::size_t n = frame_.sensors.size(), n_rows = bits.size() / n;
    std::vector<double> active(n_rows, 0.0), share(n, 0.0);
    for (std::size_t i = 0; i < bits.size(); ++i) {
      if (bits[i] != 1) continue;
      active[i / n] += 1.0;
      share[i % n] += 1.0 / static_cast<double>(n_rows);
      trial_[first_slice + i / n * n_slices / n_rows] += frame_.window_s;
    }
    add_pairs(bits);
    add_lags(active);
    const auto with_at_least = [&](double least) {
      return static_cast<double>(std::ranges::count_if(active, [&](double a) { return a >= least; }));
    };
    trial_[static_cast<std::size_t>(TrialStatistic::any_active)] += with_at_least(1.0);
    trial_[static_cast<std::size_t>(TrialStatistic::two_active)] += with_at_least(2.0);
    trial_[static_cast<std::size_t>(TrialStatistic::three_active)] += with_at_least(3.0);
    double mean = 0.0, independent = 0.0, variance = 0.0;
    for (const double s : share) {
      mean += s;
      independent += s * (1.0 - s);
    }
    for (const double a : active) variance += (a - mean) * (a - mean) / static_cast<double>(n_rows);
    trial_[static_cast<std::size_t>(TrialStatistic::coactivation)] += variance / (independent + 0.01);
  }

  void add_pairs(const std::vector<std::uint8_t>& bits) {
    const std::size_t n = frame_.sensors.size();
    std::size_t pair = 0;
    for (std::size_t first = 0; first < n; ++first) {
      for (std::size_t second = 0; second < n; ++second) {
        if (first == second) continue;
        std::uint32_t rows = 0;  // counted without branches: bits are hard to foresee
        for (std::size_t row = 0; row < bits.size(); row += n)
          rows += (bits[row + second] == 1 ? 1U : 0U) & (bits[row + first] == 0 ? 1U : 0U);
        pairs_[pair++] += rows;
      }
    }
  }

  void add_lags(const std::vector<double>& active) {
    const auto n_rows = static_cast<std::ptrdiff_t>(std::min(active.size(), profile_.movement.size()));
    for (std::size_t i = 0; i < lags.size(); ++i) {
      double sum = 0.0;
      for (std::ptrdiff_t row = std::max(0, lags[i]); row < std::min(n_rows, n_rows + lags[i]); ++row) {
        sum += active[static_cast<std::size_t>(row)] *
               static_cast<double>(profile_.movement[static_cast<std::size_t>(row - lags[i])]);
      }
      trial_[i] += sum;
    }
  }

  const StudyFrame& frame_;
  const Profile::Trial& profile_;
  std::vector<CellValues> cells_;             ///< (n_sensors) sums over runs
  std::vector<std::vector<double>> seconds_;  ///< (n_sensors x n_runs that know anything of the sensor)
  std::array<double, n_trial_statistics> trial_{};
  std::vector<double> pairs_;                          ///< (n_pairs) sums over runs
  std::vector<std::uint8_t> lead_known_, tail_known_;  ///< (n_sensors) in all runs
  int n_runs_ = 0;
};

/// Of the first desk work in a trial; any other number where there is none.
double arm_period_s(const TrialSpec& trial) {
  for (const PersonSpec& person : trial.people) {
    for (const ScriptedAction& action : person.actions) {
      if (const auto* work = std::get_if<action::Work>(&action.what)) return work->arm_period_s;
    }
  }
  return action::Work{}.arm_period_s;
}

/// Rows of the runs of one trial.
struct Lengths {
  std::size_t shortest_lead = 0, shortest_tail = 0, shortest_main = 0, longest_main = 0;
};

Lengths lengths_of(std::size_t trial, std::span<const Series> runs, std::size_t n_sensors) {
  Lengths lengths;
  bool any = false;
  for (const Series& run : runs) {
    if (run.trial != trial) continue;
    const std::size_t tail = run.n_rows(n_sensors) - run.main_end, main = run.main_end - run.main_begin;
    const auto shortest = [&](std::size_t& least, std::size_t length) {
      least = any ? std::min(least, length) : length;
    };
    shortest(lengths.shortest_lead, run.main_begin);
    shortest(lengths.shortest_tail, tail);
    shortest(lengths.shortest_main, main);
    lengths.longest_main = std::max(lengths.longest_main, main);
    any = true;
  }
  return lengths;
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

/// All faults at once.
void refuse_longer_than_study(const StudyFrame& frame, const Measured& measured, std::span<const Series> pilot) {
  if (frame.counted_phases.empty()) return;  // then there is no part that could be taken for another
  const std::string phases = boost::algorithm::join(frame.counted_phases, ", ");
  Diagnostics faults;
  for (std::size_t trial = 0; trial < frame.trials.size(); ++trial) {
    const auto longest = static_cast<double>(lengths_of(trial, pilot, frame.sensors.size()).longest_main);
    if (longest == 0.0) continue;
    const auto refuse = [&](const std::string& what, const std::string& hint) {
      faults.error({measured.file, 0, 0}, "trial '" + frame.trials[trial] + "': " + what + ", but '" + phases +
                                              "' lasts at most " + io::csv_number(longest * frame.window_s) +
                                              " s in the simulation; " + hint);
    };
    for (const Measured::Sum& sum : measured.sums) {
      if (sum.trial != trial || sum.seconds <= longer_by * longest * frame.window_s) continue;
      refuse("'" + frame.sensors[sum.sensor] + "' has " + io::csv_number(sum.seconds) + " s with motion",
             "give the sum of one run, of that part only");
    }
    for (const Series& run : measured.runs) {
      const std::size_t n_main = run.main_end - run.main_begin;
      if (measured.tells_phases || run.trial != trial || static_cast<double>(n_main) <= longer_by * longest) continue;
      refuse(std::to_string(n_main) + " rows without a column 'phase'", "leave out the others, or give the phases");
    }
  }
  faults.throw_if_errors();
}

}  // namespace

std::string name(CellStatistic statistic) {
  const auto index = static_cast<std::size_t>(statistic);
  return index < first_sixth ? std::string(cell_names[index]) : "sixth_" + std::to_string(index - first_sixth + 1);
}
std::string name(TrialStatistic statistic) {
  const auto index = static_cast<std::size_t>(statistic);
  return index < first_slice ? std::string(trial_names[index]) : "slice_" + std::to_string(index - first_slice + 1);
}

std::size_t n_statistics(const StudyFrame& frame) noexcept {
  return frame.n_cells() * n_cell_statistics + frame.trials.size() * (n_trial_statistics + n_pairs(frame));
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
  for (const Measured::Sum& sum : measured.sums) shape.known_cells[sum.trial * n + sum.sensor] = 1;
  if (measured.kind == Measured::Kind::sums) {
    shape.runs = summed(measured, n, shape.runs);
    return shape;
  }
  shape.runs.clear();
  for (const Series& run : measured.runs) {
    const Lengths usual = lengths_of(run.trial, pilot, n);
    shape.runs.push_back(shape_of_run(run, n_main_of(run, usual), usual, n));
    for (std::size_t i = run.main_begin * n; i < run.main_end * n; ++i) {
      if (run.bits[i] != unknown_bit) shape.known_cells[run.trial * n + i % n] = 1;
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
  const auto runs = [](std::size_t count) { return std::to_string(count) + (count == 1 ? " run" : " runs"); };
  const auto left_out = [&](std::size_t count, const std::string& which, const std::string& because) {
    if (count == 0) return;
    notes.push_back("What comes " + which + " the counted phases is left out of the comparison in " + runs(count) +
                    ", of all sensors or some: " + because + ", or some readings are unknown.");
  };
  left_out(leads, "before", "the recording begins later than any simulated one");
  left_out(tails, "after", "the recording ends earlier than any simulated one");
  if (begun > 0)
    notes.push_back(runs(begun) + " of the file " + (begun == 1 ? "begins" : "begin") +
                    " in a counted phase: the first row is taken for its beginning.");
  if (shorter > 0)
    notes.push_back("The main part of " + runs(shorter) + " of the file ends before any simulated one, by a " +
                    "twentieth or more: compared as far as it goes.");
  if (longer > 0)
    notes.push_back("What goes on after the end of the longest simulated run is left out of the comparison in " +
                    runs(longer) + ".");
  return notes;
}

Profile profile_of(const StudyFrame& frame, const ScriptSpec& script, std::span<const Series> runs) {
  const std::size_t n = frame.sensors.size();
  Profile profile;
  profile.trials.resize(frame.trials.size());
  std::vector<double> n_runs(frame.trials.size(), 0.0);
  for (const Series& run : runs) {
    Profile::Trial& trial = profile.trials[run.trial];
    trial.n_main = std::max(trial.n_main, run.main_end - run.main_begin);
    trial.expected.resize(trial.n_main * n, 0.0F);
    for (std::size_t i = run.main_begin * n; i < run.main_end * n; ++i) {
      if (run.bits[i] == 1) trial.expected[i - run.main_begin * n] += 1.0F;
    }
    n_runs[run.trial] += 1.0;
  }
  for (std::size_t t = 0; t < profile.trials.size(); ++t) {
    Profile::Trial& trial = profile.trials[t];
    trial.movement.assign(trial.n_main, 0.0F);
    for (std::size_t i = 0; i < trial.expected.size(); ++i) {
      trial.expected[i] /= static_cast<float>(n_runs[t]);
      trial.movement[i / n] += trial.expected[i];
    }
    std::vector<float> sorted = trial.movement;
    std::ranges::sort(sorted, std::greater<>());
    const auto last_busy = static_cast<std::size_t>(busy_share * static_cast<double>(trial.n_main));
    float mean = 0.0F;
    for (const float m : sorted) mean += m / static_cast<float>(trial.n_main);
    for (float& m : trial.movement) {
      trial.busy.push_back(!sorted.empty() && m > 0.0F && m >= sorted[last_busy] ? 1 : 0);
      m -= mean;
    }
    trial.cycle_rows = arm_period_s(script.trials[t]) / frame.window_s;
  }
  return profile;
}

std::vector<float> statistics_of(const StudyFrame& frame, const DataShape& shape, const Profile& profile,
                                 std::span<const Series> runs) {
  std::vector<TrialStatistics> trials;
  trials.reserve(frame.trials.size());
  for (std::size_t t = 0; t < frame.trials.size(); ++t) trials.emplace_back(frame, profile.trials[t]);
  for (const DataShape::Run& wanted : shape.runs) {
    const auto run = std::ranges::find_if(
        runs, [&](const Series& s) { return s.trial == wanted.trial && s.replicate == wanted.replicate; });
    if (run != runs.end()) trials[wanted.trial].add(*run, wanted, shape.kind);
  }
  std::vector<float> values(n_statistics(frame), nothing_known);
  for (std::size_t t = 0; t < trials.size(); ++t) trials[t].write(t, shape, values);
  return values;
}

std::vector<float> statistics_of(const StudyFrame& frame, const DataShape& shape, const Profile& profile,
                                 const Measured& measured) {
  if (measured.kind == Measured::Kind::series) return statistics_of(frame, shape, profile, measured.runs);
  std::vector<std::vector<double>> sums(frame.n_cells());
  for (const Measured::Sum& sum : measured.sums)
    sums[sum.trial * frame.sensors.size() + sum.sensor].push_back(sum.seconds);
  std::vector<float> values(n_statistics(frame), nothing_known);
  for (std::size_t cell = 0; cell < sums.size(); ++cell) {
    if (sums[cell].empty()) continue;
    double mean = 0.0, squares = 0.0;
    for (const double seconds : sums[cell]) mean += seconds / static_cast<double>(sums[cell].size());
    for (const double seconds : sums[cell]) squares += (seconds - mean) * (seconds - mean);
    const std::size_t first = cell * n_cell_statistics;
    values[first + static_cast<std::size_t>(CellStatistic::seconds)] = static_cast<float>(mean);
    if (sums[cell].size() < 2) continue;
    values[first + static_cast<std::size_t>(CellStatistic::run_variance)] =
        static_cast<float>(squares / static_cast<double>(sums[cell].size() - 1));
  }
  return values;
}

}  // namespace pirsim::reconcile
