#include "stats/classes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "model/core/parallel.hpp"
#include "pirsim/random.hpp"
#include "stats/linear_algebra.hpp"
#include "stats/matrix.hpp"

namespace pirsim::stats {
namespace {

using detail::as_eigen;

/// rows must have mean 0.
ShrunkCovariance shrink(const Eigen::MatrixXd& rows) {
  const auto n = static_cast<double>(rows.rows()), p = static_cast<double>(rows.cols());
  Eigen::MatrixXd sample = Eigen::MatrixXd::Zero(rows.cols(), rows.cols());
  sample.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose(), 1.0 / n);
  sample.triangularView<Eigen::StrictlyUpper>() = sample.transpose();
  const double mean_variance = sample.trace() / p;
  const double sample_norm = sample.squaredNorm();
  const double distance = sample_norm - p * mean_variance * mean_variance;  // squared, of the sample from the target
  const double error = (rows.rowwise().squaredNorm().array().square().sum() / n - sample_norm) / n;
  ShrunkCovariance shrunk;
  shrunk.shrinkage = distance > 0.0 ? std::clamp(error / distance, 0.0, 1.0) : 1.0;
  sample *= 1.0 - shrunk.shrinkage;
  sample.diagonal().array() += shrunk.shrinkage * mean_variance;
  shrunk.covariance = detail::to_matrix(sample);
  return shrunk;
}

Eigen::VectorXd off_centre(std::span<const float> features, std::span<const double> centre) {
  require(features.size() == centre.size(), "discriminant: another number of features than was fitted");
  return as_eigen(features).cast<double>() - as_eigen(centre);
}

NormalLayers::Layer fit_layer(const Matrix<double>& rows) {
  const ShrunkCovariance shrunk = ledoit_wolf(rows);
  Eigen::MatrixXd covariance = as_eigen(shrunk.covariance);
  // Coordinates have variance 1 within classes; a layer that doesn't vary at all along one still has a width.
  covariance.diagonal().array() += 1e-6;
  const Eigen::MatrixXd whitening =
      detail::Cholesky(covariance).solve_lower(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols()));
  return {shrunk.mean, detail::to_matrix(whitening), whitening.diagonal().array().log().sum()};
}

double squared_distance(const NormalLayers::Layer& layer, std::span<const double> place) {
  const Eigen::VectorXd off = as_eigen(place) - as_eigen(std::span<const double>(layer.mean));
  return (as_eigen(layer.whitening).triangularView<Eigen::Lower>() * off).squaredNorm();
}

double log_density(const NormalLayers::Layer& layer, std::span<const double> place) {
  return layer.log_determinant - 0.5 * squared_distance(layer, place);
}

/// Leading right singular vectors by subspace iteration from random directions. Ref: [Halko2011]
Eigen::MatrixXd leading_directions(const Eigen::MatrixXd& rows, Eigen::Index count, Stream stream) {
  Eigen::MatrixXd basis(rows.cols(), std::min(rows.cols(), count + 10));
  for (double& value : basis.reshaped()) value = stream.normal();
  for (int iteration = 0; iteration < 4; ++iteration) {
    basis = detail::orthonormal(rows.transpose() * (rows * basis));
  }
  return basis * detail::right_singular_vectors(rows * basis).leftCols(count);
}

/// 1 and the squares and products of the first coordinates, each in its standard deviations.
Eigen::VectorXd products(const Eigen::VectorXd& place, std::span<const double> spread, std::size_t curved) {
  const auto count = static_cast<Eigen::Index>(std::min(curved, spread.size()));
  Eigen::VectorXd values(1 + count * (count + 1) / 2);
  values(0) = 1.0;
  Eigen::Index next = 1;
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      values(next++) =
          place(i) * place(j) / (spread[static_cast<std::size_t>(i)] * spread[static_cast<std::size_t>(j)]);
  return values;
}

/// Takes the bend off the residuals and returns it, (1 + n_products x n_columns).
Eigen::MatrixXd take_off_bend(const Eigen::MatrixXd& places, std::span<const double> spread, std::size_t curved,
                              Eigen::MatrixXd& residuals) {
  Eigen::MatrixXd design(places.rows(), products(places.row(0), spread, curved).size());
  for (Eigen::Index r = 0; r < places.rows(); ++r) design.row(r) = products(places.row(r), spread, curved);
  const Eigen::MatrixXd bend = detail::shortest_least_squares(design, residuals);
  residuals -= design * bend;
  return bend;
}

/// One over the class's own standard deviations. A feature that hardly varies in the class is taken to vary by a
/// hundredth of what it does in all classes: assumed, so that rounding doesn't make rows strange.
Eigen::RowVectorXd find_scale(const Eigen::MatrixXd& centred, const Eigen::RowVectorXd& pooled_sd) {
  const Eigen::RowVectorXd sd = (centred.colwise().squaredNorm() / static_cast<double>(centred.rows())).cwiseSqrt();
  return sd.cwiseMax(0.01 * pooled_sd).unaryExpr([](double x) { return x > 0.0 ? 1.0 / x : 0.0; });
}

void describe_residuals(const Eigen::MatrixXd& residuals, ClassShapes::Shape& shape) {
  const ShrunkCovariance shrunk = ledoit_wolf(detail::to_matrix(residuals));
  Eigen::MatrixXd covariance = as_eigen(shrunk.covariance);
  covariance.diagonal().array() += 1e-9;
  shape.precision = Matrix<float>(shrunk.covariance.rows(), shrunk.covariance.columns());
  as_eigen(shape.precision) =
      detail::Cholesky(covariance).solve(Eigen::MatrixXd::Identity(covariance.rows(), covariance.cols())).cast<float>();
}

ClassShapes::Shape fit_shape(const Matrix<float>& features, const Eigen::RowVectorXd& pooled_sd,
                             const ClassShapesSettings& settings, std::uint32_t index) {
  Eigen::MatrixXd rows = as_eigen(features).cast<double>();
  const auto n = static_cast<double>(rows.rows());
  // Directions beyond a quarter of the rows would follow their noise, beyond a quarter of the columns leave nothing.
  const Eigen::Index count =
      std::min<Eigen::Index>({static_cast<Eigen::Index>(settings.subspace), rows.rows() / 4, rows.cols() / 4});
  ClassShapes::Shape shape;
  const Eigen::RowVectorXd mean = rows.colwise().mean();
  rows.rowwise() -= mean;
  const Eigen::RowVectorXd scale = find_scale(rows, pooled_sd);
  rows.array().rowwise() *= scale.array();
  shape.mean.assign(mean.begin(), mean.end());
  shape.scale.assign(scale.begin(), scale.end());

  const Eigen::MatrixXd directions =
      leading_directions(rows, count, Stream({settings.seed, index, 0, Purpose::projection}));
  const Eigen::MatrixXd places = rows * directions;
  rows -= places * directions.transpose();
  for (Eigen::Index k = 0; k < count; ++k)
    shape.spread.push_back(std::max(1e-6, std::sqrt(places.col(k).squaredNorm() / n)));
  shape.directions = detail::to_matrix<float>(directions.transpose());
  shape.bend = detail::to_matrix<float>(take_off_bend(places, shape.spread, settings.curved, rows));
  describe_residuals(rows, shape);
  return shape;
}

}  // namespace

ShrunkCovariance ledoit_wolf(const Matrix<double>& rows) {
  require(rows.rows() > 1 && rows.columns() > 0, "covariance: too few rows or no columns");
  require_finite(rows.values(), "covariance: a number is not finite");
  const Eigen::RowVectorXd mean = as_eigen(rows).colwise().mean();
  ShrunkCovariance shrunk = shrink(as_eigen(rows).rowwise() - mean);
  shrunk.mean.assign(mean.begin(), mean.end());
  return shrunk;
}

Discriminant Discriminant::fit(const Matrix<float>& features, std::span<const int> labels, int n_classes) {
  require(n_classes > 1, "discriminant: fewer than two classes");
  detail::check_labelled(features, labels, n_classes, 1);
  detail::Groups groups = detail::group(features, labels, n_classes);
  const Eigen::RowVectorXd inverse = detail::scale_columns(groups.residuals);
  const Eigen::RowVectorXd centre = groups.means.colwise().mean();
  const Eigen::MatrixXd means = ((groups.means.rowwise() - centre).array().rowwise() * inverse.array()).transpose();
  const ShrunkCovariance within = shrink(groups.residuals);
  const detail::Cholesky factor(as_eigen(within.covariance));
  const Eigen::MatrixXd whitened = factor.solve_lower(means);  // (n_columns x n_classes)
  const detail::SingularValues parting = detail::singular_values(whitened, detail::Sides::left);
  const Eigen::Index kept = (parting.s.array() > 1e-9 * parting.s(0)).count();
  const Eigen::MatrixXd basis = parting.u.leftCols(kept);
  const Eigen::MatrixXd unwhitened = factor.solve_upper(basis);

  Discriminant fitted;
  fitted.centre_.assign(centre.begin(), centre.end());
  fitted.directions_ = detail::to_matrix(unwhitened.transpose() * inverse.asDiagonal());
  fitted.class_means_ = detail::to_matrix(whitened.transpose() * basis);
  return fitted;
}

std::vector<double> Discriminant::project(std::span<const float> features) const {
  const Eigen::VectorXd place = as_eigen(directions_) * off_centre(features, centre_);
  return {place.begin(), place.end()};
}

Matrix<double> Discriminant::project(const Matrix<float>& features, std::size_t n_coordinates, unsigned threads) const {
  require(n_coordinates <= n_directions(), "discriminant: more coordinates than directions");
  const auto n = static_cast<Eigen::Index>(n_coordinates);
  return detail::map_rows(features.rows(), n_coordinates, threads, [&](std::size_t row) {
    const Eigen::VectorXd place = as_eigen(directions_).topRows(n) * off_centre(features.row(row), centre_);
    return std::vector<double>(place.begin(), place.end());
  });
}

std::vector<double> Discriminant::log_densities(std::span<const float> features) const {
  return log_densities_at(project(features));
}

std::vector<double> Discriminant::log_densities_at(std::span<const double> place) const {
  require(place.size() == n_directions(), "discriminant: another number of coordinates than was fitted");
  std::vector<double> logs;
  for (std::size_t k = 0; k < class_means_.rows(); ++k) {
    double squares = 0.0;
    for (std::size_t i = 0; i < place.size(); ++i) {
      const double off = place[i] - class_means_(k, i);
      squares += off * off;
    }
    logs.push_back(-0.5 * squares);
  }
  return logs;
}

NormalLayers NormalLayers::fit(const Matrix<double>& places, std::span<const int> labels, int n_classes,
                               const NormalLayersSettings& settings) {
  require(settings.layers > 0 && settings.fewest_rows > 1, "layers: none, or too few rows in one");
  require(n_classes > 0 && labels.size() == places.rows(), "layers: rows and labels differ in number");
  std::vector<std::vector<std::size_t>> rows_of(static_cast<std::size_t>(n_classes));
  for (std::size_t row = 0; row < labels.size(); ++row) {
    require(labels[row] >= 0 && labels[row] < n_classes, "layers: a label is outside [0, n_classes)");
    rows_of[static_cast<std::size_t>(labels[row])].push_back(row);
  }
  NormalLayers fitted;
  Layer first;
  for (std::vector<std::size_t>& rows : rows_of) {
    require(rows.size() >= 10, "layers: a class has too few rows");
    std::size_t n_layers = 1;
    if (fitted.classes_.empty()) {
      first = fit_layer(places.select_rows(rows));
    } else {
      n_layers = std::clamp<std::size_t>(rows.size() / settings.fewest_rows, 1, settings.layers);
      std::vector<std::pair<double, std::size_t>> by_distance;
      for (const std::size_t row : rows) by_distance.emplace_back(squared_distance(first, places.row(row)), row);
      std::ranges::sort(by_distance);
      std::ranges::transform(by_distance, rows.begin(), [](const auto& entry) { return entry.second; });
    }
    std::vector<Layer>& layers = fitted.classes_.emplace_back();
    for (std::size_t l = 0; l < n_layers; ++l) {
      const std::size_t begin = l * rows.size() / n_layers, end = (l + 1) * rows.size() / n_layers;
      layers.push_back(fit_layer(places.select_rows(std::span(rows).subspan(begin, end - begin))));
    }
  }
  return fitted;
}

std::vector<double> NormalLayers::log_densities(std::span<const double> place) const {
  std::vector<double> densities;
  for (const std::vector<Layer>& layers : classes_) {
    require(place.size() == layers.front().mean.size(), "layers: another number of coordinates than was fitted");
    std::vector<double> logs;
    for (const Layer& layer : layers) logs.push_back(log_density(layer, place));
    const double largest = std::ranges::max(logs);
    double sum = 0.0;
    for (const double log : logs) sum += std::exp(log - largest);
    densities.push_back(largest + std::log(sum / static_cast<double>(logs.size())));
  }
  return densities;
}

MixtureDiscriminant MixtureDiscriminant::fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                                             std::span<const int> subclasses) {
  require(labels.size() == subclasses.size() && !labels.empty(), "subclasses: not one a row");
  const int n_subclasses = std::ranges::max(subclasses) + 1;
  MixtureDiscriminant fitted;
  fitted.discriminant_ = Discriminant::fit(features, subclasses, n_subclasses);
  fitted.n_classes_ = static_cast<std::size_t>(n_classes);

  const auto none = fitted.n_classes_;
  fitted.class_of_.assign(static_cast<std::size_t>(n_subclasses), none);
  std::vector<double> rows_of_class(fitted.n_classes_, 0.0), rows_of(fitted.class_of_.size(), 0.0);
  for (std::size_t row = 0; row < labels.size(); ++row) {
    require(labels[row] >= 0 && labels[row] < n_classes, "classes: a label is outside [0, n_classes)");
    const auto own = static_cast<std::size_t>(labels[row]), part = static_cast<std::size_t>(subclasses[row]);
    require(fitted.class_of_[part] == none || fitted.class_of_[part] == own, "subclasses: one belongs to two classes");
    fitted.class_of_[part] = own;
    rows_of_class[own] += 1.0;
    rows_of[part] += 1.0;
  }
  require(std::ranges::min(rows_of_class) > 0.0, "classes: one has no rows");
  for (std::size_t part = 0; part < rows_of.size(); ++part)
    fitted.log_share_.push_back(std::log(rows_of[part] / rows_of_class[fitted.class_of_[part]]));
  return fitted;
}

std::vector<double> MixtureDiscriminant::probabilities_at(std::span<const double> place) const {
  std::vector<double> parts = discriminant_.log_densities_at(place);
  for (std::size_t part = 0; part < parts.size(); ++part) parts[part] += log_share_[part];
  parts = detail::softmax(std::move(parts));
  std::vector<double> probabilities(n_classes_, 0.0);
  for (std::size_t part = 0; part < parts.size(); ++part) probabilities[class_of_[part]] += parts[part];
  return probabilities;
}

ClassShapes ClassShapes::fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                             const ClassShapesSettings& settings) {
  require(settings.subspace > 0, "class shapes: no direction");
  detail::check_labelled(features, labels, n_classes, 10);
  const Eigen::MatrixXf all = as_eigen(features).rowwise() - as_eigen(features).colwise().mean();
  const Eigen::RowVectorXd pooled_sd =
      (all.colwise().squaredNorm() / static_cast<float>(all.rows())).cwiseSqrt().cast<double>();
  std::vector<std::vector<std::size_t>> rows_of(static_cast<std::size_t>(n_classes));
  for (std::size_t row = 0; row < labels.size(); ++row) rows_of[static_cast<std::size_t>(labels[row])].push_back(row);
  ClassShapes fitted;
  fitted.curved_ = settings.curved;
  ordered_parallel<Shape>(
      rows_of.size(), settings.threads,
      [&](std::size_t k) {
        return fit_shape(features.select_rows(rows_of[k]), pooled_sd, settings, static_cast<std::uint32_t>(k));
      },
      [&](Shape& shape) { fitted.classes_.push_back(std::move(shape)); });
  return fitted;
}

double ClassShapes::strangeness(std::span<const float> features, std::size_t class_index) const {
  require(class_index < classes_.size(), "class shapes: no such class");
  const Shape& shape = classes_[class_index];
  require(features.size() == shape.mean.size(), "class shapes: another number of features than was fitted");
  const auto vector = [](const std::vector<double>& values) { return as_eigen(std::span<const double>(values)); };
  const Eigen::VectorXd off =
      (as_eigen(features).cast<double>() - vector(shape.mean)).cwiseProduct(vector(shape.scale));
  const Eigen::VectorXf place = as_eigen(shape.directions) * off.cast<float>();
  const Eigen::VectorXd bend = products(place.cast<double>(), shape.spread, curved_);
  const Eigen::VectorXf residual = off.cast<float>() - as_eigen(shape.directions).transpose() * place -
                                   as_eigen(shape.bend).transpose() * bend.cast<float>();
  const Eigen::VectorXf pulled = as_eigen(shape.precision) * residual;
  return static_cast<double>(residual.dot(pulled));
}

}  // namespace pirsim::stats
