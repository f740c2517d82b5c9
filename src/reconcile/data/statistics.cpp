#include "reconcile/data/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "model/schema/actions.hpp"
#include "pirsim/geometry.hpp"

namespace pirsim::reconcile {
namespace {

constexpr float nothing_known = std::numeric_limits<float>::quiet_NaN();
constexpr double busy_share = 0.12;  ///< of the rows

constexpr auto first_sixth = static_cast<std::size_t>(CellStatistic::sixth_1);
constexpr std::array<std::string_view, first_sixth> cell_names{
    "seconds",       "busy_seconds",  "silent_seconds", "half_difference",   "onsets",        "longest_run",
    "isolated",      "single_gaps",   "double_gaps",    "again_after_1",     "again_after_2", "again_after_3",
    "again_after_4", "again_after_6", "longest_gap",    "dispersion",        "period_power",  "cycle_strength",
    "agreement",     "lead_seconds",  "tail_seconds",   "late_tail_seconds", "run_variance"};
constexpr auto first_slice = static_cast<std::size_t>(TrialStatistic::slice_1);
constexpr std::size_t n_slices = n_trial_statistics - first_slice;
constexpr std::array<std::string_view, first_slice> trial_names{
    "lag_minus_4", "lag_minus_2",  "lag_minus_1",  "lag_0",      "lag_1",          "lag_2",
    "lag_3",       "lag_5",        "lag_8",        "lag_11",     "lag_15",         "any_active",
    "two_active",  "three_active", "coactivation", "joint_loss", "loss_in_company"};
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
        sure_(frame.sensors.size()),
        lead_known_(frame.sensors.size(), 1),
        tail_known_(frame.sensors.size(), 1) {}

  void add(const Series& run, const DataShape::Run& shape, Measured::Kind kind) {
    const std::vector<std::uint8_t> bits = main_bits(run, shape, frame_.sensors.size());
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      if (!knows_main_part(shape, sensor, frame_.sensors.size())) continue;
      add_cell(run, shape, bits, sensor);
      lead_known_[sensor] &= shape.lead_known[sensor];
      tail_known_[sensor] &= shape.tail_known[sensor];
    }
    if (kind == Measured::Kind::series) {
      add_trial(bits);
      add_sure_rows(run, shape, bits);
    }
    ++n_runs_;
  }

  void write(std::size_t trial, const DataShape& shape, const Statistics<std::span<float>>& out) const {
    if (n_runs_ == 0) return;
    for (std::size_t sensor = 0; sensor < frame_.sensors.size(); ++sensor) {
      if (shape.known_cells[frame_.cell(trial, sensor)] == 0) continue;
      for (std::size_t i = 0; i < n_cell_statistics; ++i) {
        const auto statistic = static_cast<CellStatistic>(i);
        if (!known(sensor, statistic, shape.kind)) continue;
        out.cell(trial, sensor, statistic) = static_cast<float>(value_of(sensor, statistic));
      }
    }
    if (shape.kind != Measured::Kind::series) return;
    for (std::size_t i = 0; i < n_trial_statistics; ++i) {
      out.trial(trial, static_cast<TrialStatistic>(i)) = static_cast<float>(trial_[i] / n_runs_);
    }
    out.trial(trial, TrialStatistic::joint_loss) = static_cast<float>(sure_.joint_loss());
    out.trial(trial, TrialStatistic::loss_in_company) = static_cast<float>(sure_.loss_in_company());
    for (std::size_t i = 0; i < pairs_.size(); ++i) out.pairs(trial)[i] = static_cast<float>(pairs_[i] / n_runs_);
  }

 private:
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
      return cells_[sensor][statistic] / n_runs;
    }
    const double mean = cells_[sensor][CellStatistic::seconds] / n_runs;
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
    CellValues values;
    add_main_statistics({own, expected, busy, profile_.cycle_rows}, frame_.window_s, values);
    const std::size_t n_rows = run.n_rows(n), half_tail = run.main_end + (n_rows - run.main_end) / 2;
    const auto set = [&](CellStatistic statistic, std::size_t begin, std::size_t end) {
      values[statistic] = seconds_between(run, begin, end, sensor, n, frame_.window_s);
    };
    set(CellStatistic::lead_seconds, 0, run.main_begin);
    set(CellStatistic::tail_seconds, run.main_end, n_rows);
    set(CellStatistic::late_tail_seconds, half_tail, n_rows);
    for (std::size_t i = 0; i < n_cell_statistics; ++i) cells_[sensor].values[i] += values.values[i];
    seconds_[sensor].push_back(values[CellStatistic::seconds]);
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

  void add_sure_rows(const Series& run, const DataShape::Run& shape, const std::vector<std::uint8_t>& main) {
    const std::size_t n = frame_.sensors.size();
    const auto add = [&](const std::vector<float>& expected, std::size_t at, std::span<const std::uint8_t> row,
                         const std::vector<std::uint8_t>& known) {
      std::vector<std::uint8_t> bits(row.begin(), row.end());
      for (std::size_t s = 0; s < n; ++s) bits[s] = known.empty() || known[s] != 0 ? bits[s] : unknown_bit;
      if ((at + 1) * n <= expected.size()) sure_.add(std::span(expected).subspan(at * n, n), bits);
    };
    const auto row_of = [&](std::size_t row) { return std::span(run.bits).subspan(row * n, n); };
    for (std::size_t row = 0; row < run.main_begin; ++row)
      add(profile_.lead, run.main_begin - 1 - row, row_of(row), shape.lead_known);
    for (std::size_t row = 0; row < std::min(shape.n_main, run.main_end - run.main_begin); ++row)
      add(profile_.expected, row, std::span(main).subspan(row * n, n), {});
    for (std::size_t row = run.main_end; row < run.n_rows(n); ++row)
      add(profile_.tail, row - run.main_end, row_of(row), shape.tail_known);
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
  std::vector<double> pairs_;  ///< (n_pairs) sums over runs
  SureRows sure_;
  std::vector<std::uint8_t> lead_known_, tail_known_;  ///< (n_sensors) in all runs
  int n_runs_ = 0;
};

/// Of the first desk work in a trial; any other number where there is none.
double arm_period_s(const TrialSpec& trial) {
  const auto* work = first<action::Work>(trial);
  return (work != nullptr ? *work : action::Work{}).arm_period_s;
}

constexpr float silent_below = 0.02F;  ///< expected share of rows with motion
constexpr std::size_t block_rows = 10;
constexpr std::size_t shortest_period_rows = 8;
constexpr double farthest_shift_s = 20.0;  ///< beyond the prior of clock_lag; and so many rows, where they are longer
constexpr double least_likeness = 0.3;     ///< assumed (0.2-0.45): correlation from which a shift is told

void add_counts(const BitSeries& series, double window_s, CellValues& values) {
  const std::size_t n = series.bits.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (series.bits[i] != 1) continue;
    values[CellStatistic::seconds] += window_s;
    if (series.busy[i] != 0) values[CellStatistic::busy_seconds] += window_s;
    if (series.expected[i] < silent_below) values[CellStatistic::silent_seconds] += window_s;
    values[CellStatistic::half_difference] += 2 * i < n ? window_s : -window_s;
    values.values[static_cast<std::size_t>(CellStatistic::sixth_1) + 6 * i / n] += window_s;
  }
}

/// Stretches of equal bits; an unknown bit ends a stretch of either kind.
void add_stretches(const BitSeries& series, CellValues& values) {
  const std::size_t n = series.bits.size();
  double longest_run = 0.0, longest_gap = 0.0;
  for (std::size_t begin = 0; begin < n;) {
    std::size_t end = begin + 1;
    while (end < n && series.bits[end] == series.bits[begin]) ++end;
    const std::size_t length = end - begin;
    const bool inner = begin > 0 && end < n && series.bits[begin - 1] != unknown_bit && series.bits[end] != unknown_bit;
    if (series.bits[begin] == 1) {
      longest_run = std::max(longest_run, static_cast<double>(length));
      if (begin > 0 && series.bits[begin - 1] == 0) values[CellStatistic::onsets] += 1.0;
      if (inner && length == 1) values[CellStatistic::isolated] += 1.0;
    } else if (series.bits[begin] == 0) {
      longest_gap = std::max(longest_gap, static_cast<double>(length));
      if (inner && length == 1) values[CellStatistic::single_gaps] += 1.0;
      if (inner && length == 2) values[CellStatistic::double_gaps] += 1.0;
    }
    begin = end;
  }
  values[CellStatistic::longest_run] += longest_run;
  values[CellStatistic::longest_gap] += longest_gap;
}

double share_again_after(std::span<const std::uint8_t> bits, std::size_t lag) {
  std::uint32_t followed = 0, known = 0;
  for (std::size_t i = 0; i + lag < bits.size(); ++i) {  // without branches: bits are hard to foresee
    const std::uint32_t moved = bits[i] == 1 ? 1 : 0;
    followed += moved & (bits[i + lag] == 1 ? 1U : 0U);
    known += moved & (bits[i + lag] != unknown_bit ? 1U : 0U);
  }
  return known > 0 ? static_cast<double>(followed) / known : 0.0;
}

/// Sum of squared deviations of block counts over what independent rows would give; 1 by chance, 0 without motion.
double dispersion(std::span<const std::uint8_t> bits) {
  std::vector<double> counts;
  for (std::size_t begin = 0; begin + block_rows <= bits.size(); begin += block_rows) {
    const auto block = bits.subspan(begin, block_rows);
    counts.push_back(static_cast<double>(std::ranges::count(block, 1)));
  }
  if (counts.size() < 2) return 0.0;
  double mean = 0.0;
  for (const double count : counts) mean += count / static_cast<double>(counts.size());
  double squares = 0.0;
  for (const double count : counts) squares += (count - mean) * (count - mean);
  const double by_chance =
      static_cast<double>(counts.size() - 1) * mean * (1.0 - mean / static_cast<double>(block_rows));
  return mean > 0.0 ? squares / (by_chance + 0.5) : 0.0;
}

/// (n) exp(2 pi i k / n), made once for every n.
const std::vector<std::complex<double>>& roots_of_unity(std::size_t n) {
  thread_local std::map<std::size_t, std::vector<std::complex<double>>> known;
  std::vector<std::complex<double>>& roots = known[n];
  for (std::size_t k = roots.size(); k < n; ++k) {
    const double angle = 2.0 * pi * static_cast<double>(k) / static_cast<double>(n);
    roots.emplace_back(std::cos(angle), std::sin(angle));
  }
  return roots;
}

/// Greatest |sum of exp(2 pi i f t / n)|^2 over the rows t with motion, divided by its expectation by chance: of the
/// frequencies f from 1 on whose period is no shorter than the shortest.
double period_power(std::span<const std::uint8_t> bits) {
  const std::size_t n = bits.size();
  const auto count = static_cast<double>(std::ranges::count(bits, 1));
  if (count < 3.0 || count + 3.0 > static_cast<double>(n)) return 0.0;
  const std::vector<std::complex<double>>& roots = roots_of_unity(n);
  std::vector<std::complex<double>> sums(n / shortest_period_rows);
  for (std::size_t row = 0; row < n; ++row) {
    if (bits[row] != 1) continue;
    std::size_t k = 0;  // f * row modulo n
    for (std::complex<double>& sum : sums) {
      k = k + row < n ? k + row : k + row - n;
      sum += roots[k];
    }
  }
  double greatest = 0.0;
  for (const std::complex<double>& sum : sums) greatest = std::max(greatest, std::norm(sum));
  return greatest / (count * (1.0 - count / static_cast<double>(n)));
}

double cycle_strength(std::span<const std::uint8_t> bits, double cycle_rows) {
  double real = 0.0, imaginary = 0.0, count = 0.0;
  for (std::size_t i = 0; i < bits.size(); ++i) {
    if (bits[i] != 1) continue;
    const double angle = 2.0 * pi * static_cast<double>(i) / cycle_rows;
    real += std::cos(angle);
    imaginary += std::sin(angle);
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(real * real + imaginary * imaginary) / count : 0.0;
}

double agreement(const BitSeries& series) {
  Correlation correlation;
  for (std::size_t i = 0; i < series.bits.size(); ++i) {
    if (series.bits[i] != unknown_bit) correlation.add(series.bits[i], series.expected[i]);
  }
  return correlation.value();
}

/// Rows by which the motion has to be earlier to be most like what is expected, with a parabola between rows.
double shift_rows(const BitSeries& series, double window_s) {
  const auto n = static_cast<std::ptrdiff_t>(series.bits.size());
  double n_known = 0.0, mean_bit = 0.0, mean_expected = 0.0;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const auto row = static_cast<std::size_t>(i);
    if (series.bits[row] == unknown_bit) continue;
    n_known += 1.0;
    mean_bit += series.bits[row];
    mean_expected += static_cast<double>(series.expected[row]);
  }
  if (n_known == 0.0) return 0.0;
  mean_bit /= n_known;
  mean_expected /= n_known;
  std::vector<double> bits, expected;
  double bit_squares = 0.0, expected_squares = 0.0;
  for (std::size_t row = 0; row < series.bits.size(); ++row) {
    bits.push_back(series.bits[row] == unknown_bit ? 0.0 : series.bits[row] - mean_bit);
    expected.push_back(static_cast<double>(series.expected[row]) - mean_expected);
    bit_squares += bits.back() * bits.back();
    expected_squares += expected.back() * expected.back();
  }
  const double farthest_rows = std::ceil(farthest_shift_s / std::min(window_s, 1.0));
  const std::ptrdiff_t farthest = std::min(static_cast<std::ptrdiff_t>(farthest_rows), n / 2);
  std::vector<double> likeness;
  for (std::ptrdiff_t shift = -farthest; shift <= farthest; ++shift) {
    double sum = 0.0;
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, shift); i < std::min(n, n + shift); ++i) {
      sum += bits[static_cast<std::size_t>(i)] * expected[static_cast<std::size_t>(i - shift)];
    }
    likeness.push_back(sum);
  }
  const auto best = std::ranges::max_element(likeness);
  if (*best <= least_likeness * std::sqrt(bit_squares * expected_squares)) return 0.0;
  const auto rows = static_cast<double>(best - likeness.begin() - farthest);
  if (best == likeness.begin() || best + 1 == likeness.end()) return rows;
  const double before = *(best - 1), after = *(best + 1), bend = 2.0 * *best - before - after;
  return bend > 0.0 ? rows + 0.5 * (after - before) / bend : rows;
}

}  // namespace

std::string name(CellStatistic statistic) {
  if (statistic == CellStatistic::shift_s) return "shift_s";
  return std::string(cell_names.at(static_cast<std::size_t>(statistic)));
}
std::string name(TrialStatistic statistic) { return std::string(trial_names.at(static_cast<std::size_t>(statistic))); }

std::size_t n_statistics(const StudyFrame& frame) noexcept {
  return frame.n_cells() * n_cell_statistics + frame.trials.size() * (n_trial_statistics + n_pairs(frame));
}

double seconds_of(const DatasetStatistics& dataset, std::size_t trial, std::size_t sensor) {
  return static_cast<double>(dataset.cell(trial, sensor, CellStatistic::seconds));
}

std::vector<double> seconds_of(const StudyFrame& frame, const stats::Matrix<float>& datasets, std::size_t trial,
                               std::size_t sensor) {
  std::vector<double> seconds;
  for (std::size_t row = 0; row < datasets.rows(); ++row) {
    const double of_row = seconds_of(DatasetStatistics(frame, datasets.row(row)), trial, sensor);
    if (!std::isnan(of_row)) seconds.push_back(of_row);
  }
  return seconds;
}

std::vector<std::vector<std::size_t>> alike_places(const StudyFrame& frame) {
  std::vector<std::vector<std::size_t>> alike;
  std::size_t next = 0;
  const auto add_block = [&](std::size_t n_owners, std::size_t n_each) {
    for (std::size_t k = 0; k < n_each; ++k) {
      alike.emplace_back();
      for (std::size_t owner = 0; owner < n_owners; ++owner) alike.back().push_back(next + owner * n_each + k);
    }
    next += n_owners * n_each;
  };
  add_block(frame.n_cells(), n_cell_statistics);
  add_block(frame.trials.size(), n_trial_statistics);
  add_block(frame.trials.size(), n_pairs(frame));
  return alike;
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
    trial.lead.resize(std::max(trial.lead.size(), run.main_begin * n), 0.0F);
    trial.tail.resize(std::max(trial.tail.size(), run.bits.size() - run.main_end * n), 0.0F);
    for (std::size_t i = 0; i < run.bits.size(); ++i) {
      const std::size_t row = i / n;
      float& sum = row < run.main_begin ? trial.lead[(run.main_begin - 1 - row) * n + i % n]
                   : row < run.main_end ? trial.expected[i - run.main_begin * n]
                                        : trial.tail[i - run.main_end * n];
      if (run.bits[i] == 1) sum += 1.0F;
    }
    n_runs[run.trial] += 1.0;
  }
  for (std::size_t t = 0; t < profile.trials.size(); ++t) {
    Profile::Trial& trial = profile.trials[t];
    for (auto* share : {&trial.lead, &trial.tail}) {
      for (float& of_row : *share) of_row /= static_cast<float>(n_runs[t]);
    }
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
    trial.cycle_rows =
        arm_period_s(frame.day_parts.empty() ? script.trials[t] : script.trials.front()) / frame.window_s;
  }
  return profile;
}

std::vector<float> statistics_of(const StudyFrame& frame, const DataShape& shape, const Profile& profile,
                                 std::span<const Series> runs) {
  std::vector<TrialStatistics> trials;
  trials.reserve(frame.trials.size());
  for (std::size_t t = 0; t < frame.trials.size(); ++t) trials.emplace_back(frame, profile.trials[t]);
  for (const DataShape::Run& wanted : shape.runs) {
    const Series* run = run_of(runs, wanted);
    if (run != nullptr) trials[wanted.trial].add(*run, wanted, shape.kind);
  }
  std::vector<float> values(n_statistics(frame), nothing_known);
  for (std::size_t t = 0; t < trials.size(); ++t) trials[t].write(t, shape, {frame, values});
  return values;
}

std::vector<float> statistics_of(const StudyFrame& frame, const DataShape& shape, const Profile& profile,
                                 const Measured& measured) {
  if (measured.kind == Measured::Kind::series) return statistics_of(frame, shape, profile, measured.runs);
  std::vector<std::vector<double>> sums(frame.n_cells());
  for (const Measured::Sum& sum : measured.sums) sums[frame.cell(sum.trial, sum.sensor)].push_back(sum.seconds);
  std::vector<float> values(n_statistics(frame), nothing_known);
  const Statistics out(frame, std::span(values));
  for (std::size_t trial = 0; trial < frame.trials.size(); ++trial) {
    for (std::size_t sensor = 0; sensor < frame.sensors.size(); ++sensor) {
      const std::vector<double>& own = sums[frame.cell(trial, sensor)];
      if (own.empty()) continue;
      double mean = 0.0, squares = 0.0;
      for (const double seconds : own) mean += seconds / static_cast<double>(own.size());
      for (const double seconds : own) squares += (seconds - mean) * (seconds - mean);
      out.cell(trial, sensor, CellStatistic::seconds) = static_cast<float>(mean);
      if (own.size() < 2) continue;
      out.cell(trial, sensor, CellStatistic::run_variance) =
          static_cast<float>(squares / static_cast<double>(own.size() - 1));
    }
  }
  return values;
}

SureRows::SureRows(std::size_t n_sensors) : n_sensors_(n_sensors), pairs_(n_sensors * n_sensors) {}

void SureRows::add(std::span<const float> expected, std::span<const std::uint8_t> bits) {
  constexpr float sure = 0.85F, unlikely = 0.15F;  // assumed: of simulated datasets
  std::array<std::size_t, 2> n{};                  // sensors that are sure to move, those that may
  for (const float share : expected) {
    n[0] += share >= sure ? 1 : 0;
    n[1] += share > unlikely ? 1 : 0;
  }
  if (n[0] == 0) return;
  for (std::size_t first = 0; first < n_sensors_; ++first) {
    if (expected[first] < sure || bits[first] == unknown_bit) continue;
    const double lost = bits[first] == 0 ? 1.0 : 0.0;
    if (n[0] > 1 || n[1] == 1) {
      Share& share = n[0] > 1 ? company_ : alone_;
      share.rows += 1.0;
      share.lost += lost;
    }
    for (std::size_t second = first + 1; second < n_sensors_; ++second) {
      if (expected[second] < sure || bits[second] == unknown_bit) continue;
      const double second_lost = bits[second] == 0 ? 1.0 : 0.0;
      Pair& pair = pairs_[first * n_sensors_ + second];
      pair.rows += 1.0;
      pair.first_lost += lost;
      pair.second_lost += second_lost;
      pair.both_lost += lost * second_lost;
    }
  }
}

double SureRows::joint_loss() const {
  double rows = 0.0, beyond_chance = 0.0;
  for (const Pair& pair : pairs_) {
    if (pair.rows == 0.0) continue;
    rows += pair.rows;
    beyond_chance += pair.both_lost - pair.first_lost * pair.second_lost / pair.rows;
  }
  return rows > 0.0 ? beyond_chance / rows : 0.0;
}

double SureRows::loss_in_company() const {
  if (company_.rows == 0.0 || alone_.rows == 0.0) return 0.0;
  return company_.lost / company_.rows - alone_.lost / alone_.rows;
}

void add_main_statistics(const BitSeries& series, double window_s, CellValues& values) {
  add_counts(series, window_s, values);
  add_stretches(series, values);
  constexpr std::array<std::pair<CellStatistic, std::size_t>, 5> lags{{{CellStatistic::again_after_1, 1},
                                                                       {CellStatistic::again_after_2, 2},
                                                                       {CellStatistic::again_after_3, 3},
                                                                       {CellStatistic::again_after_4, 4},
                                                                       {CellStatistic::again_after_6, 6}}};
  for (const auto& [statistic, lag] : lags) values[statistic] += share_again_after(series.bits, lag);
  values[CellStatistic::dispersion] += dispersion(series.bits);
  values[CellStatistic::period_power] += period_power(series.bits);
  values[CellStatistic::cycle_strength] += cycle_strength(series.bits, series.cycle_rows);
  values[CellStatistic::agreement] += agreement(series);
  values[CellStatistic::shift_s] += shift_rows(series, window_s) * window_s;
}

}  // namespace pirsim::reconcile
