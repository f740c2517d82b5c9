#include "stats/logistic.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "stats/kit.hpp"
#include "stats/linear_algebra.hpp"

namespace pirsim::stats {
namespace {

struct Problem {
  Eigen::MatrixXd design;  ///< (n_rows x 1 + n_columns) a column of ones first
  Eigen::VectorXd outcomes, offset, penalty;
};

struct Terms {
  double log_likelihood = 0.0;
  Eigen::VectorXd residuals, gradient;
  Eigen::MatrixXd information;
};

Problem pose(const Matrix<double>& columns, std::span<const std::uint8_t> outcomes, const LogisticSettings& settings) {
  const auto n = static_cast<Eigen::Index>(columns.rows()), d = static_cast<Eigen::Index>(columns.columns());
  Problem problem{Eigen::MatrixXd::Ones(n, d + 1), Eigen::VectorXd(n), Eigen::VectorXd::Zero(n),
                  Eigen::VectorXd::Constant(d + 1, settings.ridge)};
  problem.design.rightCols(d) = detail::as_eigen(columns);
  problem.penalty(0) = settings.intercept_ridge;
  for (Eigen::Index i = 0; i < n; ++i) problem.outcomes(i) = outcomes[static_cast<std::size_t>(i)];
  if (!settings.offset.empty()) problem.offset = detail::as_eigen(settings.offset);
  return problem;
}

Terms terms_at(const Problem& problem, const Eigen::VectorXd& coefficients) {
  const Eigen::VectorXd odds = problem.design * coefficients + problem.offset;
  const Eigen::VectorXd shares = odds.unaryExpr([](double x) { return 1.0 / (1.0 + std::exp(-x)); });
  Terms terms;
  for (Eigen::Index i = 0; i < odds.size(); ++i) {
    // log(1 + e^x) without overflow
    const double log_sum = std::max(odds(i), 0.0) + std::log1p(std::exp(-std::abs(odds(i))));
    terms.log_likelihood += problem.outcomes(i) * odds(i) - log_sum;
  }
  terms.residuals = problem.outcomes - shares;
  terms.gradient = problem.design.transpose() * terms.residuals - problem.penalty.cwiseProduct(coefficients);
  const Eigen::VectorXd weights = shares.array() * (1.0 - shares.array());
  terms.information = problem.design.transpose() * weights.asDiagonal() * problem.design;
  terms.information.diagonal() += problem.penalty;
  return terms;
}

double penalised(const Problem& problem, const Terms& terms, const Eigen::VectorXd& coefficients) {
  return terms.log_likelihood - 0.5 * problem.penalty.dot(coefficients.cwiseAbs2());
}

Eigen::MatrixXd covariance(const Problem& problem, const Terms& terms, std::span<const int> cluster) {
  const Eigen::MatrixXd inverse = detail::inverse_of_symmetric(terms.information);
  if (cluster.empty()) return inverse;
  std::map<int, Eigen::VectorXd> scores;
  for (std::size_t i = 0; i < cluster.size(); ++i) {
    auto [score, fresh] = scores.try_emplace(cluster[i], Eigen::VectorXd::Zero(problem.design.cols()));
    const auto row = static_cast<Eigen::Index>(i);
    score->second += problem.design.row(row).transpose() * terms.residuals(row);
  }
  require(scores.size() > 1, "logistic: fewer than two clusters");
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(inverse.rows(), inverse.cols());
  for (const auto& [name, score] : scores) meat += score * score.transpose();
  const auto n = static_cast<double>(scores.size());
  return inverse * meat * inverse * (n / (n - 1.0));
}

}  // namespace

LogisticFit fit_logistic(const Matrix<double>& columns, std::span<const std::uint8_t> outcomes,
                         const LogisticSettings& settings) {
  require(columns.rows() == outcomes.size() && !outcomes.empty(), "logistic: rows and outcomes differ in number");
  require(settings.offset.empty() || settings.offset.size() == outcomes.size(), "logistic: length of the offset");
  require(settings.cluster.empty() || settings.cluster.size() == outcomes.size(), "logistic: length of the clusters");
  require(settings.ridge >= 0.0 && settings.intercept_ridge >= 0.0, "logistic: negative ridge");
  require_finite(columns.values(), "logistic: a number is not finite");
  require_finite(settings.offset, "logistic: a number is not finite");
  for (const std::uint8_t outcome : outcomes) require(outcome <= 1, "logistic: an outcome is neither 0 nor 1");

  const Problem problem = pose(columns, outcomes, settings);
  Eigen::VectorXd at = Eigen::VectorXd::Zero(problem.design.cols());
  Terms terms = terms_at(problem, at);
  constexpr int most_iterations = 60;
  int iteration = 0;
  for (; iteration < most_iterations; ++iteration) {
    Eigen::VectorXd step = detail::solve_symmetric(terms.information, terms.gradient);
    const double before = penalised(problem, terms, at);
    Terms next = terms_at(problem, at + step);
    for (int halving = 0; penalised(problem, next, at + step) < before && halving < 40; ++halving) {
      step *= 0.5;
      next = terms_at(problem, at + step);
    }
    at += step;
    terms = std::move(next);
    if (step.norm() < 1e-9 * (1.0 + at.norm())) break;
  }
  require(iteration < most_iterations && at.allFinite(), "logistic: no maximum (separable outcomes); give a ridge");
  const Eigen::VectorXd errors = covariance(problem, terms, settings.cluster).diagonal().cwiseSqrt();
  return {{at.begin(), at.end()}, {errors.begin(), errors.end()}, terms.log_likelihood, iteration + 1};
}

}  // namespace pirsim::stats
