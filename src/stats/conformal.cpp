#include "pirsim/stats/conformal.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pirsim/core/random.hpp"
#include "pirsim/stats/envelope.hpp"
#include "stats/require.hpp"
#include "stats/row_blocks.hpp"

namespace pirsim::stats {
namespace {

/// How much likelier the best other class is than class k, in log odds.
double margin(std::span<const double> probabilities, std::size_t k) {
  constexpr double floor = 1e-300;
  double best_other = floor;
  for (std::size_t other = 0; other < probabilities.size(); ++other)
    if (other != k) best_other = std::max(best_other, probabilities[other]);
  return std::log(best_other) - std::log(std::max(probabilities[k], floor));
}

std::vector<float> with_coordinates(std::span<const float> features, const Discriminant& discriminant) {
  std::vector<float> wide(features.begin(), features.end());
  for (const double coordinate : discriminant.project(features)) wide.push_back(static_cast<float>(coordinate));
  return wide;
}

Matrix<float> with_coordinates(const Matrix<float>& features, const Discriminant& discriminant) {
  Matrix<float> wide(features.rows(), features.columns() + discriminant.n_directions());
  for (std::size_t row = 0; row < features.rows(); ++row) {
    const std::vector<float> values = with_coordinates(features.row(row), discriminant);
    std::copy(values.begin(), values.end(), wide.row(row).begin());
  }
  return wide;
}

std::vector<int> select(std::span<const int> labels, std::span<const std::size_t> rows) {
  std::vector<int> selected;
  for (const std::size_t row : rows) selected.push_back(labels[row]);
  return selected;
}

/// p of the row's strangeness among the calibration rows': one test of all measures together.
double absolute_p(const Matrix<double>& calibration, std::span<const double> strangeness) {
  Matrix<double> rows;
  rows.append_row(strangeness);
  for (std::size_t row = 0; row < calibration.rows(); ++row) rows.append_row(calibration.row(row));
  return extremeness(rows, {.rank = PointwiseRank::continuous, .alternative = Alternative::greater, .threads = 1})[0];
}

std::vector<float> pick(std::span<const float> features, std::span<const std::size_t> columns) {
  std::vector<float> picked;
  for (const std::size_t column : columns) picked.push_back(features[column]);
  return picked;
}

Matrix<float> pick(const Matrix<float>& features, std::span<const std::size_t> columns) {
  Matrix<float> picked(features.rows(), columns.size());
  for (std::size_t row = 0; row < features.rows(); ++row)
    for (std::size_t i = 0; i < columns.size(); ++i) picked(row, i) = features(row, columns[i]);
  return picked;
}

std::vector<std::vector<std::size_t>> checked_blocks(std::vector<std::vector<std::size_t>> blocks,
                                                     std::size_t columns) {
  if (blocks.empty()) {
    blocks.emplace_back(columns);
    std::iota(blocks[0].begin(), blocks[0].end(), std::size_t{0});
  }
  for (const auto& block : blocks) {
    require(!block.empty(), "classes: a block without columns");
    for (const std::size_t column : block)
      require(column < columns, "classes: a block names a column that isn't there");
  }
  return blocks;
}

}  // namespace

double conformal_p(std::span<const double> calibration, double score) {
  const auto as_strange = std::count_if(calibration.begin(), calibration.end(), [&](double c) { return c >= score; });
  return static_cast<double>(as_strange + 1) / static_cast<double>(calibration.size() + 1);
}

std::vector<std::size_t> prediction_set(std::span<const double> p, double alpha) {
  std::vector<std::size_t> members;
  for (std::size_t k = 0; k < p.size(); ++k)
    if (p[k] > alpha) members.push_back(k);
  return members;
}

Split split_by_class(std::span<const int> labels, double calibration_share, std::uint64_t seed) {
  require(calibration_share > 0.0 && calibration_share < 1.0, "split: calibration share outside (0, 1)");
  require(!labels.empty(), "split: no row");
  const int n_classes = *std::max_element(labels.begin(), labels.end()) + 1;
  Split split;
  for (int k = 0; k < n_classes; ++k) {
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < labels.size(); ++row)
      if (labels[row] == k) rows.push_back(row);
    if (rows.empty()) continue;
    require(rows.size() > 1, "split: a class with a single row");
    Stream stream({seed, static_cast<std::uint32_t>(k), 0, Purpose::calibration_split});
    for (std::size_t i = rows.size() - 1; i > 0; --i)
      std::swap(rows[i], rows[stream.index(static_cast<std::uint32_t>(i + 1))]);
    const auto wanted = static_cast<std::size_t>(std::lround(calibration_share * static_cast<double>(rows.size())));
    const auto kept = static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(wanted, 1, rows.size() - 1));
    split.calibration.insert(split.calibration.end(), rows.begin(), rows.begin() + kept);
    split.fitting.insert(split.fitting.end(), rows.begin() + kept, rows.end());
  }
  std::sort(split.calibration.begin(), split.calibration.end());
  std::sort(split.fitting.begin(), split.fitting.end());
  return split;
}

ConformalClassifier ConformalClassifier::fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                                             const Split& split, const ConformalSettings& settings) {
  require(labels.size() == features.rows(), "classes: rows and labels differ in number");
  const std::vector<int> fitting_labels = select(labels, split.fitting);
  ConformalClassifier fitted;
  {
    const Matrix<float> fitting = features.select_rows(split.fitting);
    fitted.discriminant_ = Discriminant::fit(fitting, fitting_labels, n_classes);
    fitted.blocks_ = checked_blocks(settings.blocks, features.columns());
    for (const auto& block : fitted.blocks_)
      fitted.shapes_.push_back(ClassShapes::fit(pick(fitting, block), fitting_labels, n_classes, settings.shapes));
    fitted.trees_ =
        ExtraTrees::fit(with_coordinates(fitting, fitted.discriminant_), fitting_labels, n_classes, settings.trees);
  }
  fitted.calibration_rows_ = split.calibration;
  fitted.calibrate(features.select_rows(fitted.calibration_rows_), select(labels, fitted.calibration_rows_),
                   settings.threads);
  return fitted;
}

std::array<std::vector<double>, 2> ConformalClassifier::sources(std::span<const float> features) const {
  return {trees_.probabilities(with_coordinates(features, discriminant_)), discriminant_.probabilities(features)};
}

std::vector<double> ConformalClassifier::strangeness(std::span<const float> features, std::size_t k) const {
  std::vector<double> all;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto measures = shapes_[b].strangeness(pick(features, blocks_[b]), k).values();
    all.insert(all.end(), measures.begin(), measures.end());
  }
  return all;
}

void ConformalClassifier::calibrate(const Matrix<float>& features, std::span<const int> labels, unsigned threads) {
  const auto classes = static_cast<std::size_t>(n_classes());
  const std::size_t n_measures = strangeness(features.row(0), 0).size();
  // Per row the two sources' probabilities and the strangeness for its own class.
  const Matrix<double> found =
      detail::map_rows(features.rows(), 2 * classes + n_measures, threads, [&](std::size_t row) {
        const auto both = sources(features.row(row));
        std::vector<double> values = both[0];
        values.insert(values.end(), both[1].begin(), both[1].end());
        const auto own = strangeness(features.row(row), static_cast<std::size_t>(labels[row]));
        values.insert(values.end(), own.begin(), own.end());
        return values;
      });
  std::array<Matrix<double>, 2> tables{Matrix<double>(features.rows(), classes),
                                       Matrix<double>(features.rows(), classes)};
  for (std::size_t row = 0; row < features.rows(); ++row)
    for (std::size_t k = 0; k < 2 * classes; ++k) tables[k / classes](row, k % classes) = found(row, k);
  pool_ = LogPool::fit(tables, labels);

  margins_.assign(classes, {});
  strangeness_.assign(classes, {});
  probabilities_ = Matrix<double>(features.rows(), classes);
  for (std::size_t row = 0; row < features.rows(); ++row) {
    const auto own = static_cast<std::size_t>(labels[row]);
    const auto both = found.row(row);
    const std::array<std::vector<double>, 2> pair{
        std::vector<double>(both.begin(), both.begin() + static_cast<std::ptrdiff_t>(classes)),
        std::vector<double>(both.begin() + static_cast<std::ptrdiff_t>(classes),
                            both.begin() + static_cast<std::ptrdiff_t>(2 * classes))};
    const std::vector<double> pooled = pool_.combine(pair);
    std::copy(pooled.begin(), pooled.end(), probabilities_.row(row).begin());
    margins_[own].push_back(margin(pooled, own));
    strangeness_[own].append_row(found.row(row).subspan(2 * classes));
  }
}

std::vector<double> ConformalClassifier::probabilities(std::span<const float> features) const {
  return pool_.combine(sources(features));
}

Classification ConformalClassifier::classify(std::span<const float> features) const {
  Classification result;
  result.probabilities = probabilities(features);
  for (std::size_t k = 0; k < result.probabilities.size(); ++k) {
    result.p_relative.push_back(conformal_p(margins_[k], margin(result.probabilities, k)));
    result.p_absolute.push_back(absolute_p(strangeness_[k], strangeness(features, k)));
    result.p.push_back(std::min(1.0, 2.0 * std::min(result.p_relative[k], result.p_absolute[k])));
  }
  return result;
}

std::vector<Classification> ConformalClassifier::classify(const Matrix<float>& features, unsigned threads) const {
  std::vector<Classification> all;
  ordered_parallel<Classification>(
      features.rows(), threads, [&](std::size_t row) { return classify(features.row(row)); },
      [&](Classification& one) { all.push_back(std::move(one)); });
  return all;
}

void ConformalClassifier::write(BinaryWriter& out) const {
  discriminant_.write(out);
  trees_.write(out);
  out.write(pool_.weights());
  out.write(static_cast<std::uint64_t>(blocks_.size()));
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    out.write(std::vector<std::uint64_t>(blocks_[b].begin(), blocks_[b].end()));
    shapes_[b].write(out);
  }
  out.write(std::vector<std::uint64_t>(calibration_rows_.begin(), calibration_rows_.end()));
  out.write(probabilities_);
  out.write(static_cast<std::uint64_t>(margins_.size()));
  for (std::size_t k = 0; k < margins_.size(); ++k) {
    out.write(margins_[k]);
    out.write(strangeness_[k]);
  }
}

ConformalClassifier ConformalClassifier::read(BinaryReader& in) {
  ConformalClassifier read;
  read.discriminant_ = Discriminant::read(in);
  read.trees_ = ExtraTrees::read(in);
  read.pool_ = LogPool(in.read_vector<double>());
  const auto blocks = in.read<std::uint64_t>();
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const auto columns = in.read_vector<std::uint64_t>();
    read.blocks_.emplace_back(columns.begin(), columns.end());
    read.shapes_.push_back(ClassShapes::read(in));
  }
  const auto rows = in.read_vector<std::uint64_t>();
  read.calibration_rows_.assign(rows.begin(), rows.end());
  read.probabilities_ = in.read_matrix<double>();
  const auto classes = in.read<std::uint64_t>();
  for (std::uint64_t k = 0; k < classes; ++k) {
    read.margins_.push_back(in.read_vector<double>());
    read.strangeness_.push_back(in.read_matrix<double>());
  }
  return read;
}

}  // namespace pirsim::stats
