#include "pirsim/reconcile/name.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pirsim/core/parallel.hpp"
#include "pirsim/reconcile/locate.hpp"
#include "pirsim/stats/intervals.hpp"

namespace pirsim::reconcile {
namespace {

constexpr std::size_t n_neighbours = 20;
constexpr std::size_t fewest_datasets = 10;  ///< of an entry, for training and for calibration
constexpr double least_probability = 1e-6;

/// Of several plain datasets in a world only the first trains and calibrates: the others share its room.
std::vector<std::size_t> one_a_world(const ReferenceTable& table, std::size_t entry, Part part) {
  std::vector<std::size_t> rows = rows_of(table, entry, part);
  const auto same_world = [&](std::size_t a, std::size_t b) { return table.rows[a].world == table.rows[b].world; };
  rows.erase(std::unique(rows.begin(), rows.end(), same_world), rows.end());  // clang 14 lacks std::ranges::unique
  return rows;
}

std::vector<float> joined(const std::vector<float>& features, const std::vector<double>& projection) {
  std::vector<float> all = features;
  for (const double value : projection) all.push_back(static_cast<float>(value));
  return all;
}

/// Share of scores (sorted) that are at least as extreme: as small, or as great.
double share_at_most(const std::vector<double>& sorted, double score) {
  const auto n = std::upper_bound(sorted.begin(), sorted.end(), score) - sorted.begin();
  return (1.0 + static_cast<double>(n)) / (1.0 + static_cast<double>(sorted.size()));
}
double share_at_least(const std::vector<double>& sorted, double score) {
  const auto n = sorted.end() - std::lower_bound(sorted.begin(), sorted.end(), score);
  return (1.0 + static_cast<double>(n)) / (1.0 + static_cast<double>(sorted.size()));
}

double margin(const std::vector<double>& log_probabilities, std::size_t entry) {
  double best_other = std::log(least_probability);
  for (std::size_t i = 0; i < log_probabilities.size(); ++i) {
    if (i != entry) best_other = std::max(best_other, log_probabilities[i]);
  }
  return log_probabilities[entry] - best_other;
}

}  // namespace

Namer::Namer(const ReferenceTable& table, const FeatureMap& map, const NamerSettings& settings)
    : map_(&map), threads_(settings.threads) {
  for (std::size_t entry = 0; entry < table.n_entries(); ++entry) names_.push_back(table.entry_name(entry));
  entries_.resize(names_.size());
  train(table, settings);
  calibrate(table);
}

void Namer::train(const ReferenceTable& table, const NamerSettings& settings) {
  std::vector<std::size_t> rows;
  std::vector<int> labels;
  for (std::size_t entry = 0; entry < names_.size(); ++entry) {
    const std::vector<std::size_t> own = one_a_world(table, entry, Part::training);
    if (own.size() < fewest_datasets) {
      if (entry > 0) continue;
      throw Error(ErrorCode::infeasible, "reconcile: people could get about in too few worlds of the plain model (" +
                                             std::to_string(own.size()) + "): simulate more worlds");
    }
    rows.insert(rows.end(), own.begin(), own.end());
    labels.insert(labels.end(), own.size(), static_cast<int>(trained_.size()));
    trained_.push_back(entry);
  }
  const auto n_classes = static_cast<int>(trained_.size());
  const stats::Matrix<float> features = map_->features(table.statistics.select_rows(rows), threads_);
  discriminant_ = stats::Discriminant::fit(features, labels, n_classes);
  const stats::Matrix<double> projections = discriminant_.project(features, threads_);
  stats::Matrix<float> all(features.rows(), features.columns() + projections.columns());
  for (std::size_t row = 0; row < all.rows(); ++row) {
    std::ranges::copy(features.row(row), all.row(row).begin());
    std::ranges::transform(projections.row(row), all.row(row).begin() + static_cast<std::ptrdiff_t>(features.columns()),
                           [](double value) { return static_cast<float>(value); });
    EntryModel& model = entries_[trained_[static_cast<std::size_t>(labels[row])]];
    model.features.append_row(features.row(row));
    model.projections.append_row(projections.row(row));
  }
  trees_ = stats::ExtraTrees::fit(all, labels, n_classes, {settings.trees, 0, 3, settings.seed, settings.threads});
}

Namer::Judged Namer::look_at_features(std::vector<float> features) const {
  Judged data{std::move(features), {}, {}};
  data.projection = discriminant_.project(data.features);
  const std::vector<std::vector<double>> sources{trees_.probabilities(joined(data.features, data.projection)),
                                                 discriminant_.probabilities(data.features)};
  const std::vector<double> of_classes = pool_.combine(sources);
  data.log_probabilities.assign(names_.size(), std::log(least_probability));
  for (std::size_t c = 0; c < of_classes.size(); ++c) {
    data.log_probabilities[trained_[c]] = std::log(std::max(of_classes[c], least_probability));
  }
  return data;
}

Namer::Judged Namer::look_at(std::span<const float> statistics) const {
  return look_at_features(map_->features(statistics));
}

/// How far a dataset lies from its nearest neighbours of an entry: along the directions that part entries, and in all
/// features, on the whole and in the worst one.
std::vector<double> Namer::distances(const EntryModel& model, const Judged& data) const {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t row = 0; row < model.projections.rows(); ++row) {
    double squares = 0.0;
    for (std::size_t i = 0; i < data.projection.size(); ++i) {
      const double d = model.projections(row, i) - data.projection[i];
      squares += d * d;
    }
    near.emplace_back(squares, row);
  }
  const std::size_t k = std::min(n_neighbours, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(k), near.end());
  near.resize(k);
  double along = 0.0, worst = 0.0, squares = 0.0;
  for (const auto& [square, row] : near) along += std::sqrt(square) / static_cast<double>(k);
  for (std::size_t i = 0; i < data.features.size(); ++i) {
    double mean = 0.0, square = 0.0;
    for (const auto& [distance, row] : near) {
      const auto value = static_cast<double>(model.features(row, i));
      mean += value / static_cast<double>(k);
      square += value * value / static_cast<double>(k);
    }
    const double d = static_cast<double>(data.features[i]) - mean;
    const double variance = std::max(square - mean * mean, 0.0) + 0.01;
    squares += d * d / variance;
    worst = std::max(worst, std::abs(d) / std::sqrt(variance));
  }
  return {std::log(along + 1e-6), std::log(squares + 1e-6), std::log(worst + 1e-6)};
}

double Namer::absolute_score(const EntryModel& model, const std::vector<double>& distances) const {
  double score = -1e9;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    score = std::max(score, (distances[i] - model.usual[i]) / model.spread[i]);
  }
  return score;
}

void Namer::calibrate(const ReferenceTable& table) {
  std::vector<std::size_t> rows;
  std::vector<int> labels;
  for (std::size_t c = 0; c < trained_.size(); ++c) {
    const std::vector<std::size_t> own = one_a_world(table, trained_[c], Part::calibration);
    rows.insert(rows.end(), own.begin(), own.end());
    labels.insert(labels.end(), own.size(), static_cast<int>(c));
  }
  const stats::Matrix<float> features = map_->features(table.statistics.select_rows(rows), threads_);
  std::vector<stats::Matrix<double>> sources(2, stats::Matrix<double>(rows.size(), trained_.size()));
  std::vector<std::vector<double>> far(rows.size());
  ordered_parallel<int>(
      rows.size(), threads_,
      [&](std::size_t i) {
        Judged data{{features.row(i).begin(), features.row(i).end()}, {}, {}};
        data.projection = discriminant_.project(data.features);
        std::ranges::copy(trees_.probabilities(joined(data.features, data.projection)), sources[0].row(i).begin());
        std::ranges::copy(discriminant_.probabilities(data.features), sources[1].row(i).begin());
        far[i] = distances(entries_[trained_[static_cast<std::size_t>(labels[i])]], data);
        return 0;
      },
      [](int&) {});
  pool_ = stats::LogPool::fit(sources, labels);

  stats::Matrix<double> pooled(rows.size(), trained_.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<std::vector<double>> both{{sources[0].row(i).begin(), sources[0].row(i).end()},
                                                {sources[1].row(i).begin(), sources[1].row(i).end()}};
    const std::vector<double> p = pool_.combine(both);
    std::ranges::copy(p, pooled.row(i).begin());
    std::vector<double> logs;
    for (const double value : p) logs.push_back(std::log(std::max(value, least_probability)));
    const auto c = static_cast<std::size_t>(labels[i]);
    entries_[trained_[c]].relative.push_back(margin(logs, c));
  }
  reliability_ = stats::reliability(pooled, labels);

  for (std::size_t c = 0; c < trained_.size(); ++c) {
    EntryModel& model = entries_[trained_[c]];
    std::vector<std::vector<double>> own(3);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (labels[i] != static_cast<int>(c)) continue;
      for (std::size_t d = 0; d < own.size(); ++d) own[d].push_back(far[i][d]);
    }
    if (own[0].size() < fewest_datasets) continue;
    for (const std::vector<double>& values : own) {
      model.usual.push_back(stats::quantile(values, 0.5));
      model.spread.push_back(std::max(stats::quantile(values, 0.9) - model.usual.back(), 1e-3));
    }
    for (std::size_t i = 0; i < own[0].size(); ++i) {
      model.absolute.push_back(absolute_score(model, {own[0][i], own[1][i], own[2][i]}));
    }
    std::ranges::sort(model.relative);
    std::ranges::sort(model.absolute);
  }
}

std::vector<double> Namer::probabilities(std::span<const float> statistics) const {
  std::vector<double> p = look_at(statistics).log_probabilities;
  double sum = 0.0;
  for (double& value : p) sum += value = std::exp(value);
  for (double& value : p) value /= sum;
  return p;
}

std::vector<EntryScore> Namer::judge(std::span<const float> statistics) const {
  const Judged data = look_at(statistics);
  std::vector<EntryScore> scores;
  for (std::size_t entry = 0; entry < entries_.size(); ++entry) {
    const EntryModel& model = entries_[entry];
    EntryScore score{names_[entry], std::exp(data.log_probabilities[entry]), 0.0, 0.0, 0.0};
    if (!model.absolute.empty()) {
      score.p_relative = share_at_most(model.relative, margin(data.log_probabilities, entry));
      score.p_absolute = share_at_least(model.absolute, absolute_score(model, distances(model, data)));
      score.p = std::min(1.0, 2.0 * std::min(score.p_relative, score.p_absolute));
    }
    scores.push_back(std::move(score));
  }
  return scores;
}

std::vector<std::string> Namer::telling_features(std::size_t n) const {
  std::vector<std::size_t> order(map_->names().size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::vector<double>& importance = trees_.importance();
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return importance[a] > importance[b]; });
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(n, order.size()); ++i) names.push_back(map_->names()[order[i]]);
  return names;
}

}  // namespace pirsim::reconcile
