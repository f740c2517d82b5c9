#include "studies/summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/text.hpp"
#include "pirsim/error.hpp"

namespace pirsim::studies {

double crps(const Tally& ensemble, double observed) {
  if (ensemble.empty()) throw Error(ErrorCode::usage, "crps: no member");
  double n = 0.0;
  for (const auto& [value, times] : ensemble) n += static_cast<double>(times);
  double error = 0.0, pairs = 0.0, below = 0.0;
  for (const auto& [value, count] : ensemble) {
    const auto x = static_cast<double>(value), times = static_cast<double>(count);
    error += times * std::abs(x - observed);
    pairs += x * times * (2.0 * below + times - n);  // sum over pairs of x_j - x_i, `times` members at once
    below += times;
  }
  return error / n - pairs / (n * n);
}

namespace {

std::optional<std::size_t> index_of(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

/// One cell's simulated distribution against its measured count.
struct Comparison {
  double real, min, max, mean;
  std::optional<double> crps;
};

OverallSummary overall_of(const std::vector<Comparison>& cells) {
  OverallSummary overall;
  if (cells.empty()) return overall;
  std::vector<RangedValue> ranges;
  double crps_sum = 0.0;
  bool all_scored = true;
  for (const Comparison& cell : cells) {
    ranges.push_back({cell.real, cell.min, cell.max});
    overall.real_total += cell.real;
    overall.simulated_total += cell.mean;
    overall.mean_absolute_error += std::abs(cell.mean - cell.real);
    crps_sum += cell.crps.value_or(0.0);
    all_scored = all_scored && cell.crps.has_value();
  }
  const auto n = static_cast<double>(cells.size());
  const InsideCount inside = count_inside(ranges);
  overall.cells = static_cast<int>(cells.size());
  overall.inside = inside.inside;
  overall.shuffled_inside = inside.shuffled_mean;
  overall.shuffled_inside_sd = inside.shuffled_sd;
  overall.bias = (overall.simulated_total - overall.real_total) / n;
  overall.mean_absolute_error /= n;
  if (all_scored) overall.mean_crps = crps_sum / n;
  return overall;
}

}  // namespace

Summary::Summary(std::vector<std::string> trials, std::vector<std::string> sensors, std::vector<MeasuredCell> measured)
    : trials_(std::move(trials)),
      sensors_(std::move(sensors)),
      counts_(trials_.size() * sensors_.size()),
      measured_(counts_.size()) {
  for (MeasuredCell& cell : measured) {
    const auto trial = index_of(trials_, cell.trial);
    const auto sensor = index_of(sensors_, cell.sensor);
    if (trial && sensor) {
      measured_[*trial * sensors_.size() + *sensor] = std::move(cell);
    } else {
      unmatched_.push_back(std::move(cell));
    }
  }
}

void AreaSums::add(int people) {
  ++rows;
  occupied += people > 0 ? 1 : 0;
  person_rows += people;
  most = std::max(most, people);
}

void AreaSums::add(const AreaSums& other) {
  rows += other.rows;
  occupied += other.occupied;
  person_rows += other.person_rows;
  most = std::max(most, other.most);
}

void Summary::add_run(std::string_view trial, std::span<const int> counts, std::span<const AreaSums> areas) {
  const auto index = index_of(trials_, trial);
  if (!index) {
    throw Error(ErrorCode::usage, "summary: no trial '" + std::string(trial) + "'" + near_or_all(trial, trials_));
  }
  if (counts.size() != sensors_.size()) throw Error(ErrorCode::usage, "summary: expected one count a sensor");
  for (std::size_t sensor = 0; sensor < counts.size(); ++sensor) {
    ++counts_[*index * sensors_.size() + sensor][counts[sensor]];
  }
  ++runs_;
  if (areas_.empty()) {
    areas_.assign(areas.begin(), areas.end());
  } else {
    for (std::size_t i = 0; i < areas_.size(); ++i) areas_[i].add(areas[i]);
  }
}

std::vector<CellSummary> Summary::cells() const {
  std::vector<CellSummary> cells;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    CellSummary cell;
    cell.counts = counts_[i];
    cell.trial = trials_[i / sensors_.size()];
    cell.sensor = sensors_[i % sensors_.size()];
    cell.measured = measured_[i];
    if (!cell.counts.empty()) {
      cell.min = cell.counts.begin()->first;
      cell.max = cell.counts.rbegin()->first;
      std::int64_t total = 0;
      for (const auto& [count, times] : cell.counts) {
        cell.runs += times;
        total += count * times;
      }
      cell.mean = static_cast<double>(total) / static_cast<double>(cell.runs);
      if (cell.measured) {
        cell.inside = cell.min <= cell.measured->real && cell.measured->real <= cell.max;
        cell.crps = crps(cell.counts, cell.measured->real);
      }
    }
    cells.push_back(std::move(cell));
  }
  return cells;
}

OverallSummary Summary::overall() const {
  std::vector<Comparison> compared;
  for (const CellSummary& cell : cells()) {
    if (cell.runs == 0 || !cell.measured) continue;
    compared.push_back({static_cast<double>(cell.measured->real), static_cast<double>(cell.min),
                        static_cast<double>(cell.max), cell.mean, cell.crps});
  }
  return overall_of(compared);
}

std::optional<OverallSummary> Summary::published() const {
  std::vector<Comparison> compared;
  for (const std::optional<MeasuredCell>& cell : measured_) {
    if (!cell || !cell->min_sim || !cell->max_sim || !cell->mean_sim) continue;
    compared.push_back({static_cast<double>(cell->real), static_cast<double>(*cell->min_sim),
                        static_cast<double>(*cell->max_sim), *cell->mean_sim, std::nullopt});
  }
  if (compared.empty()) return std::nullopt;
  return overall_of(compared);
}

RunCounts::RunCounts(std::size_t n_sensors, SummarySpec spec, const std::vector<std::string>& areas)
    : spec_(std::move(spec)), counts_(n_sensors, 0) {
  for (const std::string& area : areas) areas_.push_back({.area = area});
}

void RunCounts::reset() {
  std::ranges::fill(counts_, 0);
  for (AreaSums& sums : areas_) sums = {.area = sums.area};
}

void RunCounts::add(const Sample& row) {
  const auto& phases = spec_.phases;
  if (!phases.empty() && std::find(phases.begin(), phases.end(), row.phase) == phases.end()) return;
  for (std::size_t sensor = 0; sensor < counts_.size(); ++sensor) counts_[sensor] += row.bits[sensor] == 1 ? 1 : 0;
  for (std::size_t area = 0; area < areas_.size(); ++area) {
    if (row.people_of_areas[area] >= 0) areas_[area].add(row.people_of_areas[area]);
  }
}

InsideCount count_inside(std::span<const RangedValue> cells) {
  const std::size_t n = cells.size();
  const auto fits = [&](std::size_t value, std::size_t range) {
    return cells[range].min <= cells[value].value && cells[value].value <= cells[range].max;
  };
  InsideCount count;
  if (n == 0) return count;
  std::vector<double> of_value(n, 0.0);  // in how many ranges a value fits
  std::vector<double> of_range(n, 0.0);  // how many values fit in a range
  double fitting = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    count.inside += fits(i, i) ? 1 : 0;
    for (std::size_t j = 0; j < n; ++j) {
      if (!fits(i, j)) continue;
      of_value[i] += 1.0;
      of_range[j] += 1.0;
      fitting += 1.0;
    }
  }
  // Hoeffding (1951): sum over i of a(i, pi(i)) has mean (sum of a) / n and variance (sum of d^2) / (n - 1), where d is
  // a without its row and column means.
  const auto size = static_cast<double>(n);
  count.shuffled_mean = fitting / size;
  double squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double d = (fits(i, j) ? 1.0 : 0.0) - of_value[i] / size - of_range[j] / size + fitting / (size * size);
      squares += d * d;
    }
  }
  if (n > 1) count.shuffled_sd = std::sqrt(squares / (size - 1.0));
  return count;
}

}  // namespace pirsim::studies
