#include "reconcile/data/data_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "reconcile/data/measured.hpp"

namespace pirsim::reconcile {
namespace {

using What = DataFinding::What;

/// Runs of one dataset, measured or simulated: they outlive it.
struct DatasetRows {
  std::span<const Series> runs;
  std::size_t n_sensors = 0;

  [[nodiscard]] std::size_t n_rows() const noexcept {
    std::size_t n = 0;
    for (const Series& run : runs) n += run.n_rows(n_sensors);
    return n;
  }
};
std::uint8_t bit_of(const Series& run, std::size_t row, std::size_t sensor, std::size_t n_sensors) noexcept {
  return run.bits[row * n_sensors + sensor];
}

// By chance: by how much less likely than this level something must be to be told. Rows that follow one another aren't
// independent, so that a chance that is computed as if they were is too small: hence a level so low (assumed).
constexpr double log_level = -20.7;  ///< natural logarithm of 1e-9

constexpr std::size_t fewest_edges = 20;    ///< by which columns are compared, and a logger's clock is read
constexpr double may_differ = 0.02;         ///< share of edges by which nearly equal columns may differ (assumed)
constexpr std::size_t longest_period = 60;  ///< rows: gateways report once a minute at least (assumed)
constexpr double model_has_it = 0.9;        ///< of a share that is 1 in the data: the model's own runs come near it

/// Rows that stand in two places, from `row` and `other_row` on.
struct Repeat {
  std::size_t run = 0, row = 0;
  std::size_t other_run = 0, other_row = 0;
  std::size_t n_rows = 0;
  /// Bits in these rows after Lempel and Ziv: what follows from rows before it, as a steady beat does, adds nothing.
  double information = 0.0;
};
/// Those with most information first, one of a pair of runs and a shift. Rows that go on as their own repeat don't
/// count, as a fan's to and fro, nor do two runs of one trial, whose choreography comes again, nor parts that stand at
/// the same time in both runs: what goes by the clock does that. A whole run that stands in another trial counts.
struct Repeats {
  static constexpr std::size_t most = 3;
  std::vector<Repeat> between_runs, in_a_run;  ///< at most so many
};
/// How far the model's own datasets go; 0 without any.
double greatest_of(std::span<const DatasetRows> pilot, const std::function<double(const DatasetRows&)>& of) {
  double greatest = 0.0;
  for (const DatasetRows& dataset : pilot) greatest = std::max(greatest, of(dataset));
  return greatest;
}

/// Each realization is a dataset, in which trials ascend.
std::vector<DatasetRows> datasets_of(std::span<const Series> pilot, std::size_t n_sensors) {
  std::vector<DatasetRows> datasets;
  for (std::size_t begin = 0, end = 0; begin < pilot.size(); begin = end) {
    for (end = begin + 1; end < pilot.size() && pilot[end].trial > pilot[end - 1].trial;) ++end;
    datasets.push_back({pilot.subspan(begin, end - begin), n_sensors});
  }
  return datasets;
}

constexpr std::size_t fewest_beats = 12;  ///< in a run: what sweeps to and fro keeps to a grid of rows for a while

// Two columns: rows in which one of them changes, and those in which both do.

struct Edges {
  std::size_t n = 0, n_alike = 0;
  [[nodiscard]] double share() const noexcept {
    return (static_cast<double>(n_alike) + 1.0) / (static_cast<double>(n) + 2.0);
  }
};

Edges edges_of(const DatasetRows& data, std::size_t one, std::size_t other, What what) {
  Edges edges;
  for (const Series& run : data.runs) {
    for (std::size_t row = 1; row < run.n_rows(data.n_sensors); ++row) {
      const auto bit = [&](std::size_t back, std::size_t sensor) {
        return bit_of(run, row - back, sensor, data.n_sensors);
      };
      const std::uint8_t a = bit(0, one), b = bit(0, other), a_before = bit(1, one), b_before = bit(1, other);
      if (std::max({a, b, a_before, b_before}) == unknown_bit || (a == a_before && b == b_before)) continue;
      ++edges.n;
      const bool both = a != a_before && b != b_before;
      edges.n_alike += both && (a == b) == (what == What::equal_columns) ? 1 : 0;
    }
  }
  return edges;
}

/// Logarithm of the chance that so many of them or more are alike, each with probability q: a bound.
double log_chance(const Edges& edges, double q) {
  const auto n = static_cast<double>(edges.n), k = static_cast<double>(edges.n - edges.n_alike);
  return std::log(k + 1.0) + std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
         (n - k) * std::log(q);
}

void compare_columns(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                     std::vector<DataFinding>& findings) {
  for (std::size_t other = 1; other < data.n_sensors; ++other) {
    for (std::size_t one = 0; one < other; ++one) {
      for (const What what : {What::equal_columns, What::opposite_columns}) {
        const Edges edges = edges_of(data, one, other, what);
        const auto n_unlike = static_cast<double>(edges.n - edges.n_alike);
        if (edges.n < fewest_edges || n_unlike > may_differ * static_cast<double>(edges.n)) continue;
        const double usual =
            greatest_of(pilot, [&](const DatasetRows& d) { return edges_of(d, one, other, what).share(); });
        const double chance = log_chance(edges, usual);
        if (chance > log_level) continue;
        findings.push_back({.what = what,
                            .sensors = {frame.sensors[one], frame.sensors[other]},
                            .n_rows = data.n_rows(),
                            .n_exceptions = edges.n - edges.n_alike,
                            .chance = std::exp(chance)});
      }
    }
  }
}

// One column.

struct BitCounts {
  std::size_t n_known = 0, n_ones = 0;
};

BitCounts counts_of(const DatasetRows& data, std::size_t sensor) {
  BitCounts counts;
  for (const Series& run : data.runs) {
    for (std::size_t row = 0; row < run.n_rows(data.n_sensors); ++row) {
      const std::uint8_t bit = bit_of(run, row, sensor, data.n_sensors);
      counts.n_known += bit != unknown_bit ? 1 : 0;
      counts.n_ones += bit == 1 ? 1 : 0;
    }
  }
  return counts;
}

/// All known rows are 1, the first ones too, though the model's runs of these trials begin without.
void find_constant(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                   std::vector<DataFinding>& findings) {
  for (std::size_t sensor = 0; sensor < data.n_sensors; ++sensor) {
    const auto [n_known, n_ones] = counts_of(data, sensor);
    if (n_known == 0 || n_ones < n_known) continue;
    double chance = 0.0;
    for (const Series& run : data.runs) {
      double n = 0.0, n_begin_so = 0.0;
      for (const DatasetRows& dataset : pilot) {
        for (const Series& simulated : dataset.runs) {
          if (simulated.trial != run.trial || simulated.bits.empty()) continue;
          n += 1.0;
          n_begin_so += bit_of(simulated, 0, sensor, data.n_sensors) == 1 ? 1.0 : 0.0;
        }
      }
      if (!run.bits.empty() && run.bits[sensor] == 1) chance += std::log((n_begin_so + 1.0) / (n + 2.0));
    }
    if (chance > log_level) continue;
    findings.push_back({.what = What::constant_column,
                        .sensors = {frame.sensors[sensor]},
                        .n_rows = n_known,
                        .chance = std::exp(chance)});
  }
}

/// No row is 1, though every realization of the model has some: a dead sensor is in the catalogue.
void find_silent(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                 std::vector<DataFinding>& findings) {
  for (std::size_t sensor = 0; sensor < data.n_sensors; ++sensor) {
    const auto [n_known, n_ones] = counts_of(data, sensor);
    if (n_known == 0 || n_ones > 0) continue;
    const auto moves = [&](const DatasetRows& d) { return counts_of(d, sensor).n_ones > 0; };
    if (!std::ranges::all_of(pilot, moves)) continue;
    findings.push_back(
        {.what = What::silent_column, .sensors = {frame.sensors[sensor]}, .n_rows = n_known, .is_impossible = false});
  }
}

bool is_alone(const Series& run, std::size_t row, std::size_t sensor, std::size_t n_sensors) {
  return row > 0 && row + 1 < run.n_rows(n_sensors) && bit_of(run, row, sensor, n_sensors) == 1 &&
         bit_of(run, row - 1, sensor, n_sensors) == 0 && bit_of(run, row + 1, sensor, n_sensors) == 0;
}

/// Of a run: ones on a grid of so many rows, which begins anywhere.
struct Beat {
  std::size_t n = 0, n_missing = 0;  ///< rows of the grid, those without a 1
  std::size_t n_alone = 0;           ///< those with a 1 between two zeros
};

Beat beat_of(const Series& run, std::size_t sensor, std::size_t n_sensors, std::size_t period, std::size_t first) {
  Beat beat;
  const std::size_t n_rows = run.n_rows(n_sensors);
  for (std::size_t row = first; row < n_rows; row += period) {
    const std::uint8_t bit = bit_of(run, row, sensor, n_sensors);
    if (bit == unknown_bit) continue;
    ++beat.n;
    if (bit == 0 && ++beat.n_missing > 1 + n_rows / period / 50) return {n_rows / period, n_rows / period, 0};
    beat.n_alone += is_alone(run, row, sensor, n_sensors) ? 1 : 0;
  }
  return beat;
}

struct Beats {
  double share = 0.0;   ///< of the grids' rows with a 1, in each run with the best grid
  double chance = 0.0;  ///< logarithm: that as many of the ones that stand alone are on the grid
};

Beats beats_of(const DatasetRows& data, std::size_t sensor, std::size_t period) {
  Beats beats;
  double n = 0.0, n_missing = 0.0;
  const double grids = std::log(static_cast<double>(period));
  for (const Series& run : data.runs) {
    Edges alone;
    for (std::size_t row = 0; row < run.n_rows(data.n_sensors); ++row)
      alone.n += is_alone(run, row, sensor, data.n_sensors) ? 1 : 0;
    Beat best;
    double least = 2.0;
    for (std::size_t first = 0; first < std::min(period, run.n_rows(data.n_sensors)); ++first) {
      const Beat beat = beat_of(run, sensor, data.n_sensors, period, first);
      const double missing = beat.n == 0 ? 2.0 : static_cast<double>(beat.n_missing) / static_cast<double>(beat.n);
      if (missing > least || (missing == least && beat.n_alone <= best.n_alone)) continue;
      best = beat;
      least = missing;
    }
    if (best.n < fewest_beats) continue;
    n += static_cast<double>(best.n);
    n_missing += static_cast<double>(best.n_missing);
    alone.n_alike = best.n_alone;
    beats.chance += std::min(0.0, grids + log_chance(alone, 1.0 / static_cast<double>(period)));
  }
  beats.share = n > 0.0 ? 1.0 - n_missing / n : 0.0;
  return beats;
}

void find_beats(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                std::vector<DataFinding>& findings) {
  for (std::size_t sensor = 0; sensor < data.n_sensors; ++sensor) {
    for (std::size_t period = 2; period <= longest_period; ++period) {
      const Beats beats = beats_of(data, sensor, period);
      if (beats.share < 1.0 - may_differ / 2.0 || beats.chance > log_level) continue;
      const double usual = greatest_of(pilot, [&](const DatasetRows& d) { return beats_of(d, sensor, period).share; });
      if (usual > model_has_it) continue;
      findings.push_back({.what = What::beats,
                          .sensors = {frame.sensors[sensor]},
                          .n_rows = data.n_rows(),
                          .every_s = static_cast<double>(period) * frame.window_s,
                          .chance = std::exp(beats.chance)});
      break;  // its multiples beat as well
    }
  }
}

// Finds rows that stand in a dataset twice: windows of rows by their hash, then as far as they go on alike.

constexpr std::size_t window_rows = 12;     ///< shorter repeats aren't looked at
constexpr std::size_t fewest_changes = 4;   ///< in such a window
constexpr std::size_t most_places = 16;     ///< of the same window are compared: steady beats have thousands
constexpr std::size_t most_parsed = 400;    ///< rows whose information is counted
constexpr std::size_t aligned_within = 30;  ///< rows by which one run may begin earlier than another (assumed)
constexpr double least_information = 8.0;   ///< bits; less isn't kept
constexpr double whole_run = 0.95;          ///< of the shorter run's rows

using Symbol = std::uint64_t;

/// (n_rows) A number for the bits of each row; a row that isn't known all over is like no other.
std::vector<Symbol> symbols_of(const Series& run, std::size_t n_sensors, Symbol& next_unknown) {
  std::vector<Symbol> symbols;
  for (std::size_t row = 0; row < run.n_rows(n_sensors); ++row) {
    Symbol symbol = 1469598103934665603U;
    bool known = true;
    for (std::size_t sensor = 0; sensor < n_sensors; ++sensor) {
      const std::uint8_t bit = bit_of(run, row, sensor, n_sensors);
      known = known && bit != unknown_bit;
      symbol = (symbol ^ bit) * 1099511628211U;
    }
    symbols.push_back(known ? symbol : next_unknown++);
  }
  return symbols;
}

/// Phrases that Lempel's and Ziv's parsing of 1977 needs: each is what stood there before, and one symbol.
double information_of(std::span<const Symbol> symbols) {
  symbols = symbols.first(std::min(symbols.size(), most_parsed));
  double n_phrases = 0.0;
  for (std::size_t at = 0; at < symbols.size();) {
    std::size_t longest = 0;
    for (std::size_t from = 0; from < at; ++from) {
      std::size_t length = 0;
      while (at + length < symbols.size() && symbols[from + length] == symbols[at + length]) ++length;
      longest = std::max(longest, length);
    }
    at += longest + 1;
    n_phrases += 1.0;
  }
  return n_phrases * std::log2(std::max(n_phrases, 1.0));
}

/// Of those of a pair of runs and a shift, the first.
void keep_greatest(std::vector<Repeat>& repeats) {
  std::ranges::stable_sort(repeats, std::ranges::greater{}, &Repeat::information);
  std::set<std::tuple<std::size_t, std::size_t, std::size_t>> seen;
  std::vector<Repeat> kept;
  for (const Repeat& repeat : repeats) {
    if (kept.size() == Repeats::most) break;
    if (seen.insert({repeat.run, repeat.other_run, repeat.row - repeat.other_row}).second) kept.push_back(repeat);
  }
  repeats = std::move(kept);
}

struct RowPlace {
  std::size_t run = 0, row = 0;
};

class RepeatFinder {
 public:
  explicit RepeatFinder(const DatasetRows& data) : data_(data) {
    Symbol next_unknown = 1;
    for (const Series& run : data.runs) symbols_.push_back(symbols_of(run, data.n_sensors, next_unknown));
  }

  Repeats find() {
    for (std::size_t run = 0; run < symbols_.size(); ++run) {
      reached_.clear();
      for (std::size_t row = 0; row + window_rows <= symbols_[run].size(); ++row) look_at({run, row});
    }
    keep_greatest(found_.between_runs);
    keep_greatest(found_.in_a_run);
    return std::move(found_);
  }

 private:
  void look_at(const RowPlace& here) {
    const std::span<const Symbol> window = std::span(symbols_[here.run]).subspan(here.row, window_rows);
    std::size_t n_changes = 0;
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < window_rows; ++i) {
      n_changes += i > 0 && window[i] != window[i - 1] ? 1 : 0;
      hash = (hash ^ window[i]) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 29U;
    }
    if (n_changes < fewest_changes) return;
    std::vector<RowPlace>& places = places_[hash];
    for (const RowPlace& there : places) compare(there, here);
    if (places.size() < most_places) places.push_back(here);
  }

  /// Runs of one trial repeat their choreography, and what goes by the clock is the same in all runs that begin alike.
  [[nodiscard]] bool may_repeat(const RowPlace& there, const RowPlace& here, std::size_t n) const {
    if (there.run == here.run) return there.row + n < here.row;  // or it goes on as its own repeat: a beat
    if (data_.runs[there.run].trial == data_.runs[here.run].trial) return false;
    const std::size_t apart = std::max(there.row, here.row) - std::min(there.row, here.row);
    const std::size_t shorter = std::min(symbols_[there.run].size(), symbols_[here.run].size());
    return apart > aligned_within || static_cast<double>(n) >= whole_run * static_cast<double>(shorter);
  }

  void compare(const RowPlace& there, const RowPlace& here) {
    // What began earlier has been looked at as far as it goes.
    const auto line =
        std::pair(there.run, static_cast<std::ptrdiff_t>(here.row) - static_cast<std::ptrdiff_t>(there.row));
    std::size_t& reached = reached_[line.first * 1000003U + static_cast<std::size_t>(line.second)];
    if (here.row < reached) return;
    const std::vector<Symbol>&one = symbols_[there.run], &other = symbols_[here.run];
    const std::size_t most = std::min(one.size() - there.row, other.size() - here.row);
    std::size_t n = 0;
    while (n < most && one[there.row + n] == other[here.row + n]) ++n;
    reached = here.row + n;
    if (n < window_rows || !may_repeat(there, here, n)) return;
    const double information = information_of(std::span(other).subspan(here.row, n));
    if (information < least_information) return;
    (there.run == here.run ? found_.in_a_run : found_.between_runs)
        .push_back({there.run, there.row, here.run, here.row, n, information});
  }

  const DatasetRows& data_;
  std::vector<std::vector<Symbol>> symbols_;                         ///< of each run
  std::unordered_map<std::uint64_t, std::vector<RowPlace>> places_;  ///< of each window's hash, up to here
  std::unordered_map<std::size_t, std::size_t> reached_;  ///< row of this run, by the other run and how far apart
  Repeats found_;
};

// Rows of all sensors together that no logger hears.

constexpr double beyond_model = 1.5;          ///< times as much as any of the model's runs has (assumed)
constexpr std::size_t shortest_silence = 20;  ///< rows: what is shorter isn't told
constexpr std::size_t fewest_gaps = 5;        ///< in a run, by which its longest one is judged

// All columns together.

constexpr std::size_t most_timed = 600;  ///< rows of a run by which a clock is read: of more, it takes long

/// (n_runs) Rows in which any sensor changes.
using Changes = std::vector<std::vector<double>>;

Changes changes_of(const DatasetRows& data) {
  Changes changes;
  for (const Series& run : data.runs) {
    std::vector<double>& rows = changes.emplace_back();
    for (std::size_t row = 1; row < std::min(run.n_rows(data.n_sensors), most_timed); ++row) {
      const auto changed = [&](std::size_t sensor) {
        const std::uint8_t bit = bit_of(run, row, sensor, data.n_sensors);
        const std::uint8_t before = bit_of(run, row - 1, sensor, data.n_sensors);
        return bit != before && std::max(bit, before) != unknown_bit;
      };
      std::size_t sensor = 0;
      while (sensor < data.n_sensors && !changed(sensor)) ++sensor;
      if (sensor < data.n_sensors) rows.push_back(static_cast<double>(row));
    }
  }
  return changes;
}

/// The most rows that hardly any change comes sooner after another than.
std::size_t spacing_of(const Changes& changes) {
  std::vector<std::size_t> n_after(longest_period + 1, 0);
  std::size_t n = 0;
  for (const std::vector<double>& rows : changes) {
    for (std::size_t i = 1; i < rows.size(); ++i)
      ++n_after[std::min(longest_period, static_cast<std::size_t>(rows[i] - rows[i - 1]))];
    n += rows.size();
  }
  std::size_t spacing = 1, n_sooner = n_after[1];
  while (spacing < longest_period && static_cast<double>(n_sooner) <= may_differ / 2.0 * static_cast<double>(n))
    n_sooner += n_after[++spacing];
  return spacing;
}

/// Of a clock with a period of so many rows, which needn't be whole: changes in rows that it may end in, wherever it
/// begins in each run.
Edges on_clock(const Changes& changes, double period) {
  constexpr double one_row = 1.0 - 1e-9;
  Edges edges;
  for (std::vector<double> rows : changes) {
    const std::size_t n = rows.size();
    for (double& row : rows) row = std::fmod(row, period);
    std::ranges::sort(rows);
    const auto later = [&](std::size_t i) { return i < n ? rows[i] : rows[i - n] + period; };
    std::size_t most = 0;
    for (std::size_t begin = 0, end = 0; begin < n; ++begin) {
      while (end < begin + n && later(end) < rows[begin] + one_row) ++end;
      most = std::max(most, end - begin);
    }
    edges.n += n;
    edges.n_alike += most;
  }
  return edges;
}

void find_polls(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                std::vector<DataFinding>& findings) {
  const Changes changes = changes_of(data);
  const std::size_t spacing = spacing_of(changes);
  if (spacing < 2) return;
  const double step = may_differ / static_cast<double>(most_timed / spacing);  // so little that a run keeps its rows
  double period = 0.0;
  Edges best;
  for (double tried = static_cast<double>(spacing); tried < static_cast<double>(spacing + 1); tried += step) {
    const Edges edges = on_clock(changes, tried);
    if (edges.n_alike <= best.n_alike) continue;
    best = edges;
    period = tried;
  }
  const auto n = static_cast<double>(best.n), n_on = static_cast<double>(best.n_alike);
  if (best.n < fewest_edges || n - n_on > may_differ * n) return;
  const double n_tried = std::log(1.0 / step) + static_cast<double>(data.runs.size()) * std::log(period);
  const double chance = n_tried - n_on * std::log(period);
  if (chance > log_level) return;
  if (greatest_of(pilot, [&](const DatasetRows& d) { return on_clock(changes_of(d), period).share(); }) > model_has_it)
    return;
  findings.push_back(
      {.what = What::polled, .n_rows = data.n_rows(), .every_s = period * frame.window_s, .chance = std::exp(chance)});
}

DataFinding::Rows place(const StudyFrame& frame, const Series& run, std::size_t row, std::size_t n_rows) {
  return {frame.trials[run.trial], run.replicate, row + 1, row + n_rows};
}

/// Two beats together repeat rows in many places, so that one repeat must be beyond the third of the data as well; in a
/// single run, it is merely odd.
void find_repeat(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                 const WholeDatasets& periodic, std::vector<DataFinding>& findings) {
  const Repeats repeats = RepeatFinder(data).find();
  std::optional<std::vector<std::vector<Series>>> whole;
  for (const auto which : {&Repeats::between_runs, &Repeats::in_a_run}) {
    const std::vector<Repeat>& own = repeats.*which;
    if (own.empty()) continue;
    const Repeat& repeat = own.front();
    const double n_pairs = 2.0 * std::log(static_cast<double>(data.n_rows()));
    const double chance = n_pairs - repeat.information * std::log(2.0);
    if (chance > log_level) continue;
    const double third = own.size() == Repeats::most ? own.back().information : 0.0;
    const auto repeated_in = [&](const DatasetRows& d) {
      const Repeats simulated = RepeatFinder(d).find();
      return (simulated.*which).empty() ? 0.0 : (simulated.*which).front().information;
    };
    if (repeat.information < beyond_model * std::max(greatest_of(pilot, repeated_in), third)) continue;
    if (!whole) whole = periodic ? periodic() : std::vector<std::vector<Series>>{};
    if (std::ranges::any_of(*whole, [&](const std::vector<Series>& runs) {
          return repeat.information < beyond_model * repeated_in({runs, data.n_sensors});
        }))
      continue;
    findings.push_back({.what = What::repeated_rows,
                        .places = {place(frame, data.runs[repeat.run], repeat.row, repeat.n_rows),
                                   place(frame, data.runs[repeat.other_run], repeat.other_row, repeat.n_rows)},
                        .n_rows = repeat.n_rows,
                        .chance = std::exp(chance),
                        .is_impossible = which == &Repeats::between_runs});
    return;
  }
}

/// Rows without any motion between two with some: of a run, the longest.
struct Silence {
  std::size_t run = 0, row = 0, n_rows = 0;
  std::size_t n_gaps = 0;    ///< in the run
  double times_usual = 0.0;  ///< as long as the mean of the other gaps; 0 where these are few
};

Silence silence_of(const DatasetRows& data, std::size_t number) {
  const Series& run = data.runs[number];
  Silence longest{number};
  std::size_t after_last = 0;  // row after the last one with motion; 0: none, or unknown rows since
  double sum = 0.0;
  for (std::size_t row = 0; row < run.n_rows(data.n_sensors); ++row) {
    const auto bits = std::span(run.bits).subspan(row * data.n_sensors, data.n_sensors);
    if (std::ranges::find(bits, unknown_bit) != bits.end()) after_last = 0;
    if (std::ranges::find(bits, 1) == bits.end()) continue;
    const std::size_t n_rows = after_last > 0 ? row - after_last : 0;
    sum += static_cast<double>(n_rows);
    longest.n_gaps += n_rows > 0 ? 1 : 0;
    if (n_rows > longest.n_rows) longest = {number, after_last, n_rows, longest.n_gaps};
    after_last = row + 1;
  }
  if (longest.n_gaps <= fewest_gaps) return longest;
  const auto length = static_cast<double>(longest.n_rows);
  longest.times_usual = length / std::max(1.0, (sum - length) / static_cast<double>(longest.n_gaps - 1));
  return longest;
}

std::vector<Silence> silences_of(const DatasetRows& data) {
  std::vector<Silence> all;
  for (std::size_t number = 0; number < data.runs.size(); ++number) all.push_back(silence_of(data, number));
  return all;
}

/// Impossible if gaps end by chance and none is so long among so many; odd if it is longer than in any of the model's
/// runs of that trial: where sensors see less than in the model, that is no fault of the file.
void find_silence(const StudyFrame& frame, const DatasetRows& data, std::span<const DatasetRows> pilot,
                  std::vector<DataFinding>& findings) {
  const std::vector<Silence> silences = silences_of(data);
  if (silences.empty()) return;
  const auto add = [&](const Silence& silence, double chance, bool is_impossible) {
    findings.push_back({.what = What::all_silent,
                        .places = {place(frame, data.runs[silence.run], silence.row, silence.n_rows)},
                        .n_rows = silence.n_rows,
                        .chance = chance,
                        .is_impossible = is_impossible});
  };
  const auto times_usual = [](const DatasetRows& d) {
    double most = 0.0;
    for (const Silence& silence : silences_of(d)) most = std::max(most, silence.times_usual);
    return most;
  };
  double n_gaps = 0.0;
  for (const Silence& silence : silences) n_gaps += static_cast<double>(silence.n_gaps);
  const Silence& greatest = *std::ranges::max_element(silences, {}, &Silence::times_usual);
  const double chance = std::log(n_gaps) - greatest.times_usual;
  if (n_gaps > 0.0 && chance <= log_level && greatest.times_usual >= beyond_model * greatest_of(pilot, times_usual))
    return add(greatest, std::exp(chance), true);

  const Silence* longest = nullptr;
  double most = 1.0;
  for (const Silence& silence : silences) {
    if (pilot.empty() || silence.n_rows < shortest_silence) continue;
    const double usual = greatest_of(pilot, [&](const DatasetRows& d) {
      std::size_t there = 0;
      for (const Silence& one : silences_of(d)) {
        if (d.runs[one.run].trial == data.runs[silence.run].trial) there = std::max(there, one.n_rows);
      }
      return static_cast<double>(there);
    });
    const double times = static_cast<double>(silence.n_rows) / (beyond_model * std::max(1.0, usual));
    if (times <= most) continue;
    most = times;
    longest = &silence;
  }
  if (longest != nullptr) add(*longest, 0.0, false);
}

}  // namespace

std::vector<DataFinding> check_data(const StudyFrame& frame, const Measured& measured, std::span<const Series> pilot,
                                    const WholeDatasets& periodic) {
  std::vector<DataFinding> findings;
  if (measured.kind != Measured::Kind::series) return findings;
  const DatasetRows data{measured.runs, frame.sensors.size()};
  const std::vector<DatasetRows> sets = datasets_of(pilot, frame.sensors.size());
  compare_columns(frame, data, sets, findings);
  find_constant(frame, data, sets, findings);
  find_beats(frame, data, sets, findings);
  find_polls(frame, data, sets, findings);
  find_repeat(frame, data, sets, periodic, findings);
  find_silence(frame, data, sets, findings);
  find_silent(frame, data, sets, findings);
  return findings;
}

bool any_impossible(std::span<const DataFinding> findings) noexcept {
  return std::ranges::any_of(findings, &DataFinding::is_impossible);
}

}  // namespace pirsim::reconcile
