#include "reconcile/inference/locate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/effects/catalogue.hpp"
#include "model/core/text.hpp"
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

/// Of all sensors, of one, or of a trial. What is unknown adds nothing.
Deviation strongest_deviation(const StudyFrame& frame, const stats::Matrix<float>& plain,
                              std::span<const float> measured, const std::vector<std::size_t>& trials) {
  constexpr std::array parts{CellStatistic::lead_seconds, CellStatistic::seconds, CellStatistic::tail_seconds};
  Deviation strongest;
  const auto look = [&](const std::string& who, const auto& of_trials, const auto& of_sensors) {
    const auto n_trials = static_cast<double>(of_trials.size());
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const auto mean_of = [&](std::span<const float> dataset) {
        double seconds = 0.0;
        for (const std::size_t trial : of_trials) {
          for (const std::size_t sensor : of_sensors) {
            const auto known = DatasetStatistics(frame, measured).cell(trial, sensor, parts[part]);
            const auto own = DatasetStatistics(frame, dataset).cell(trial, sensor, parts[part]);
            seconds += std::isnan(known) || std::isnan(own) ? 0.0 : static_cast<double>(own);
          }
        }
        return seconds / n_trials;
      };
      Deviation one{who, static_cast<Deviation::Part>(part), mean_of(measured)};
      double squares = 0.0;
      for (std::size_t row = 0; row < plain.rows(); ++row) {
        const double seconds = mean_of(plain.row(row));
        one.expected_s += seconds / static_cast<double>(plain.rows());
        squares += seconds * seconds / static_cast<double>(plain.rows());
      }
      const double a_row = frame.window_s * std::sqrt(static_cast<double>(of_sensors.size()) / n_trials);
      const double variance = std::max(0.0, squares - one.expected_s * one.expected_s);
      one.scatters = (one.measured_s - one.expected_s) / std::sqrt(variance + a_row * a_row);
      if (std::abs(one.scatters) > std::abs(strongest.scatters)) strongest = one;
    }
  };
  const std::vector<std::size_t> sensors = stats::numbers_to(frame.sensors.size());
  look("", trials, sensors);
  for (const std::size_t sensor : sensors) look(frame.sensors[sensor], trials, std::array{sensor});
  for (const std::size_t trial : trials) look(frame.trials[trial], std::array{trial}, sensors);
  return strongest;
}

constexpr std::uint32_t n_pilot_realizations = 40;

/// Refuses an effect that was asked for by name and means nothing here.
void require_meaning(const SceneSpec& scene, const ScriptSpec& script, const std::vector<std::string>& asked) {
  for (const std::string& name : asked) {
    const effects::EffectInfo& info = effects::find(name).info;
    if (effects::means_anything(info, scene, script.sensing)) continue;
    throw Error(ErrorCode::usage, "effects: " + name +
                                      " can't be looked for: it acts on sensors with response: zones, "
                                      "and every sensor's response is analog");
  }
}

}  // namespace

std::vector<std::size_t> rows_of(const ReferenceTable& table, std::size_t hypothesis, Subset subset) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (table.rows[i].hypothesis != hypothesis) continue;
    const bool held_back = is_for_calibration(table.rows[i].realization);
    if (subset == Subset::all || held_back == (subset == Subset::calibration)) rows.push_back(i);
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
  std::ranges::copy(features.select_columns(map.envelope_columns()).values(), tested.values().begin());
  return tested;
}

std::string p_in_words(double p, double least_p) {
  return (least_p > 0.0 && p <= least_p ? "p <= " : "p = ") + short_number(p);
}

Location locate(const StudyFrame& frame, const FeatureMap& map, const stats::Matrix<float>& plain,
                std::span<const float> measured, double alpha, const Context& context) {
  const std::vector<std::size_t>& columns = map.envelope_columns();
  const stats::Matrix<double> simulated = tested_features(map, map.features(plain, context.threads));
  const std::vector<double> observed = tested_features(map, map.features(measured));
  const stats::GlobalEnvelope test = stats::global_envelope_test(observed, simulated, {alpha, context.threads});

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
      location.cells.back().scatters = std::sinh(observed[next]);  // as the map scales them
      location.cells.back().adjusted_p = test.adjusted_p[next++];
      location.band_s += 0.5 * (location.cells.back().high_s - location.cells.back().low_s);
    }
  }
  location.strongest = strongest_deviation(frame, plain, measured, map.trials());
  location.band_s /= static_cast<double>(std::max<std::size_t>(1, location.cells.size()));
  return location;
}

TableView::TableView(const ReferenceStudy& study, std::vector<std::size_t> trials, unsigned threads)
    : study_(study),
      map_(study.map(std::move(trials))),
      threads_(threads),
      plain_(study.table.statistics.select_rows(rows_of(study.table, 0, Subset::all))),
      plain_reference_(tested_features(map_, map_.features(plain_, threads))) {}

const TableView::Rows& TableView::rows() const {
  std::call_once(rows_known_, [this] {
    rows_.features = map_.features(table().statistics, threads_);
    rows_.p.assign(table().rows.size(), 1.0);
    std::vector<std::size_t> seen;
    for (std::size_t hypothesis = 1; hypothesis < table().n_hypotheses(); ++hypothesis) {
      const std::vector<std::size_t> own = rows_of(table(), hypothesis, Subset::calibration);
      seen.insert(seen.end(), own.begin(), own.end());
    }
    const auto p_of = [&](std::size_t i) {
      return plain_reference_.p(tested_features(map_, rows_.features.row(seen[i])));
    };
    for (std::size_t next = 0; const double p : in_parallel<double>(seen.size(), threads_, p_of))
      rows_.p[seen[next++]] = p;
  });
  return rows_;
}

double TableView::p(std::span<const float> statistics) const {
  return plain_reference_.p(tested_features(map_, map_.features(statistics)));
}

ReferenceStudy make_reference_study(
    const SceneSpec& scene, const ScriptSpec& script, const Settings& settings,
    const std::function<DataShape(const StudyFrame&, std::span<const Series>)>& shape_of_data, const Context& context) {
  require_meaning(scene, script, settings.table.effects);
  ReferenceStudy reference{{scene, script, settings.nuisance, context.seed, model_to_share(scene, script)},
                           frame_of(scene, script),
                           cell_knowledge(scene, script),
                           {},
                           {}};
  context.begin("pilot runs");
  const std::vector<Series> pilot = pilot_runs(reference.source, reference.frame, n_pilot_realizations, context);
  reference.shape = shape_of_data(reference.frame, pilot);
  context.begin("reference table");
  reference.table =
      make_reference_table(reference.source, reference.frame, reference.shape,
                           profile_of(reference.frame, script, pilot), settings.table, settings.table_folder, context);
  return reference;
}

ReferenceStudy make_full_study(const SceneSpec& scene, const ScriptSpec& script, const Settings& settings,
                               Measured::Kind kind, int n_replicates, const Context& context) {
  const auto shape_of_data = [&](const StudyFrame& frame, std::span<const Series> pilot) {
    return full_shape(frame, kind, n_replicates, pilot);
  };
  return make_reference_study(scene, script, settings, shape_of_data, context);
}

FeatureMap ReferenceStudy::map(std::vector<std::size_t> trials) const {
  return {frame, knowledge, table.statistics.select_rows(rows_of(table, 0, Subset::training)), std::move(trials)};
}

std::shared_ptr<const TableView> ReferenceStudy::view(std::vector<std::size_t> trials, unsigned threads) const {
  return std::make_shared<const TableView>(*this, std::move(trials), threads);
}

}  // namespace pirsim::reconcile
