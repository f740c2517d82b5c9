#include "reconcile/inference/locate.hpp"

#include <algorithm>
#include <cmath>

#include "stats/envelope.hpp"
#include "stats/intervals.hpp"

namespace pirsim::reconcile {
namespace {

LocatedCell cell_of(const StudyFrame& frame, const stats::Matrix<float>& plain, std::span<const float> measured,
                    std::size_t trial, std::size_t sensor) {
  LocatedCell cell{.trial = frame.trials[trial],
                   .sensor = frame.sensors[sensor],
                   .measured_s = seconds_of(DatasetStatistics(frame, measured), trial, sensor)};
  const std::vector<double> simulated = seconds_of(frame, plain, trial, sensor);
  if (simulated.empty()) return cell;
  for (const double seconds : simulated) cell.expected_s += seconds / static_cast<double>(simulated.size());
  cell.low_s = stats::quantile(simulated, 0.025);
  cell.high_s = stats::quantile(simulated, 0.975);
  return cell;
}

}  // namespace

std::vector<std::size_t> rows_of(const ReferenceTable& table, std::size_t hypothesis, Part part) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i].hypothesis != hypothesis) continue;
    const bool held_back = is_for_calibration(table.rows[i].realization);
    if (part == Part::all || held_back == (part == Part::calibration)) rows.push_back(i);
  }
  return rows;
}

std::size_t hypothesis_of(const ReferenceTable& table, const std::string& effect) {
  return 1 + static_cast<std::size_t>(std::ranges::find(table.effects, effect) - table.effects.begin());
}

std::vector<double> tested_features(const FeatureMap& map, std::span<const float> features) {
  std::vector<double> tested;
  for (const std::size_t column : map.envelope_columns()) tested.push_back(static_cast<double>(features[column]));
  return tested;
}

stats::Matrix<double> tested_features(const FeatureMap& map, const stats::Matrix<float>& features) {
  stats::Matrix<double> tested(features.rows(), map.envelope_columns().size());
  for (std::size_t row = 0; row < features.rows(); ++row)
    std::ranges::copy(tested_features(map, features.row(row)), tested.row(row).begin());
  return tested;
}

std::vector<double> tested_statistics(const FeatureMap& map, std::span<const float> statistics) {
  return tested_features(map, map.features(statistics));
}

stats::Matrix<double> tested_statistics(const FeatureMap& map, const stats::Matrix<float>& statistics,
                                        unsigned threads) {
  return tested_features(map, map.features(statistics, threads));
}

Location locate(const StudyFrame& frame, const FeatureMap& map, const stats::Matrix<float>& plain,
                std::span<const float> measured, double alpha, const Context& context) {
  const std::vector<std::size_t>& columns = map.envelope_columns();
  const stats::Matrix<double> simulated = tested_statistics(map, plain, context.threads);
  const std::vector<double> observed = tested_statistics(map, measured);
  const stats::GlobalEnvelope test = stats::global_envelope_test(
      observed, simulated, {alpha, stats::PointwiseRank::continuous, context.seed, context.threads});

  Location location;
  location.p = test.p;
  location.n_simulated = plain.rows();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    location.envelope.push_back(
        {map.names()[columns[i]], observed[i], test.median[i], test.lower[i], test.upper[i], test.adjusted_p[i]});
  }
  std::size_t next = 0;  // the cells' seconds come first
  for (const std::size_t trial : map.trials()) {
    for (std::size_t sensor = 0; sensor < frame.sensors.size(); ++sensor) {
      if (!map.knows_cell(trial, sensor)) continue;
      location.cells.push_back(cell_of(frame, plain, measured, trial, sensor));
      location.cells.back().adjusted_p = test.adjusted_p[next++];
      location.band_s += 0.5 * (location.cells.back().high_s - location.cells.back().low_s);
    }
  }
  location.band_s /= static_cast<double>(std::max<std::size_t>(1, location.cells.size()));
  return location;
}

}  // namespace pirsim::reconcile
