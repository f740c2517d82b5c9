#include "stats/class_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "pirsim/random.hpp"
#include "stats/discriminant.hpp"
#include "stats/groups.hpp"
#include "stats/kit.hpp"
#include "stats/linear_algebra.hpp"

namespace pirsim::stats {
namespace {

using detail::as_eigen;

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
