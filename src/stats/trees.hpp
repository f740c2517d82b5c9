// Extremely randomised trees: which of some classes made this row of features. Ref: [Geurts2006]
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "stats/classes.hpp"
#include "stats/matrix.hpp"

namespace pirsim::stats {

struct ExtraTreesSettings {
  std::size_t trees = 300;
  std::size_t tries = 0;     ///< columns tried at a node; 0: the square root of their number, rounded up
  std::size_t min_leaf = 3;  ///< fewest rows of a leaf
  std::uint64_t seed = 0;
  unsigned threads = 0;  ///< 0: all cores; never changes the result
};

/// An immutable forest. All rows grow every tree; at a node some columns are tried, each with one random threshold,
/// and the split with the greatest gain in Gini's index is taken. Classes weigh the same however many rows they have.
class ExtraTrees {
 public:
  ExtraTrees() = default;
  /// features: (n_rows x n_columns), finite; labels: (n_rows) in [0, n_classes), each class at least once.
  /// Throws Error(usage) otherwise.
  [[nodiscard]] static ExtraTrees fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                                      const ExtraTreesSettings& settings = {});

  /// (n_classes) mean over trees of the leaf's class shares; sums to 1.
  [[nodiscard]] std::vector<double> probabilities(std::span<const float> features) const;
  /// (n_columns) share of the total gain that each column's splits made; sums to 1 unless no tree has a split.
  [[nodiscard]] const std::vector<double>& importance() const noexcept { return importance_; }
  [[nodiscard]] int n_classes() const noexcept { return n_classes_; }

  bool operator==(const ExtraTrees&) const = default;

  /// One tree as arrays over its nodes; node 0 is the root.
  struct Tree {
    std::vector<std::int32_t> column;    ///< of a leaf: minus how many classes it holds
    std::vector<float> threshold;        ///< rows with a value <= it go to node `next`, others to `next + 1`
    std::vector<std::uint32_t> next;     ///< of a leaf: where its classes begin
    std::vector<std::uint16_t> classes;  ///< of all leaves, one after another
    std::vector<float> shares;           ///< beside `classes`
    bool operator==(const Tree&) const = default;
  };

 private:
  int n_classes_ = 0;
  std::size_t n_columns_ = 0;
  std::vector<Tree> trees_;
  std::vector<double> importance_;
};

// Which class made a row: what three kinds of classifier say, as one calibrated probability; whether probabilities mean
// what they say.

/// Several classifiers' probabilities as one: p_k proportional to the product over sources of p_(source,k)^weight.
/// With one source this is temperature scaling, weight = 1 / temperature. Ref: [Guo2017]
class LogPool {
 public:
  LogPool() = default;
  explicit LogPool(std::vector<double> weights) : weights_(std::move(weights)) {}
  /// The weights of least log loss; the problem is convex. sources: per source (n_rows x n_classes) probabilities of
  /// rows that the sources were not fitted on; labels: (n_rows) in [0, n_classes).
  [[nodiscard]] static LogPool fit(std::span<const Matrix<double>> sources, std::span<const int> labels);
  /// Per source (n_classes) probabilities -> (n_classes).
  [[nodiscard]] std::vector<double> combine(std::span<const std::vector<double>> sources) const;
  [[nodiscard]] const std::vector<double>& weights() const noexcept { return weights_; }  ///< (n_sources)

 private:
  std::vector<double> weights_;
};

/// One bin of a reliability diagram: rows whose greatest probability lies in it.
struct ReliabilityBin {
  std::size_t rows = 0;
  double mean_probability = 0.0;  ///< of the likeliest class
  double share_right = 0.0;       ///< how often the likeliest class was the true one
};
struct Reliability {
  std::vector<ReliabilityBin> bins;         ///< of equal width from 0 to 1; an empty bin has zeros
  double expected_calibration_error = 0.0;  ///< mean over rows of |mean_probability - share_right| of their bin
};
/// probabilities: (n_rows x n_classes), labels: (n_rows). Ref: [Guo2017]
[[nodiscard]] Reliability reliability(const Matrix<double>& probabilities, std::span<const int> labels,
                                      std::size_t n_bins = 15);

// Which class made a row: what three kinds of classifier say, as one calibrated probability.

/// Indices of rows: the first part for fitting, the second for calibration.
struct Split {
  std::vector<std::size_t> fitting, calibration;  ///< ascending
};

struct PooledClassifierSettings {
  ExtraTreesSettings trees = {};     ///< grown on the features and the discriminant's coordinates. Ref: [Pudlo2016]
  NormalLayersSettings layers = {};  ///< in the discriminant's coordinates
  std::size_t coordinates = 60;      ///< at most, the first of the discriminant's; 26, 40 and 60 were tried
  unsigned threads = 0;              ///< 0: all cores; never changes the result
};

/// Trees, a discriminant and layers of normal distributions in its coordinates, pooled and calibrated.
class PooledClassifier {
 public:
  PooledClassifier() = default;
  /// features: (n_rows x n_columns), finite; labels: (n_rows) in [0, n_classes); each class ten times or more among the
  /// fitting rows and once or more among the calibration rows. Rows that depend on each other must be on one side of
  /// the split. subclasses: (n_rows) in [0, n), of the fitting rows each at least once and within one class, anything
  /// for the others; or empty: the classes themselves.
  [[nodiscard]] static PooledClassifier fit(const Matrix<float>& features, std::span<const int> labels, int n_classes,
                                            const Split& split, const PooledClassifierSettings& settings = {},
                                            std::span<const int> subclasses = {});
  /// (n_classes) calibrated, classes equally likely beforehand.
  [[nodiscard]] std::vector<double> probabilities(std::span<const float> features) const;
  /// (n_classes) of the layers: log density at the row's place, up to a number that all classes share.
  [[nodiscard]] std::vector<double> log_densities(std::span<const float> features) const;
  /// (n_rows x n_classes) of many rows.
  [[nodiscard]] Matrix<double> log_densities(const Matrix<float>& features, unsigned threads = 0) const;

  /// (n_calibration_rows x n_classes) calibrated, of the rows that were kept for calibration.
  [[nodiscard]] const Matrix<double>& calibration_probabilities() const noexcept { return probabilities_; }
  [[nodiscard]] const ExtraTrees& trees() const noexcept { return trees_; }
  [[nodiscard]] int n_classes() const noexcept { return trees_.n_classes(); }

 private:
  /// (3 x n_classes) what each kind says of a row.
  [[nodiscard]] std::vector<std::vector<double>> sources(std::span<const float> features) const;

  MixtureDiscriminant mixture_;
  std::size_t n_coordinates_ = 0;  ///< the first of the discriminant's
  ExtraTrees trees_;
  NormalLayers layers_;
  LogPool pool_;  ///< weights of trees, discriminant, layers
  Matrix<double> probabilities_;
};

// Logistic regression: what a yes or no depends on, and how surely.

struct LogisticSettings {
  /// Half of it times the sum of squared slopes is added to the loss; 0 or more.
  double ridge = 0.0;
  /// Half of it times the intercept's square is added too; keeps it finite if all outcomes are equal.
  double intercept_ridge = 0.0;
  /// (n_rows) added to the log-odds, not fitted; empty: none.
  std::span<const double> offset = {};
  /// (n_rows) rows with one number depend on each other (a trial, say), and the standard errors are the sandwich's;
  /// empty: all rows are independent. Ref: [LiangZeger1986]
  std::span<const int> cluster = {};
};

struct LogisticFit {
  std::vector<double> coefficients;     ///< (1 + n_columns) intercept, then slopes, in log-odds per unit of the column
  std::vector<double> standard_errors;  ///< (1 + n_columns)
  double log_likelihood = 0.0;          ///< without the ridge's part
};

/// outcomes: (n_rows) of 0 and 1; columns: (n_rows x n_columns). Maximum (penalised) likelihood by Newton's method.
/// Throws Error(usage) for sizes that differ, other outcomes, or if there is no maximum because the classes are
/// separable and a ridge is 0.
[[nodiscard]] LogisticFit fit_logistic(const Matrix<double>& columns, std::span<const std::uint8_t> outcomes,
                                       const LogisticSettings& settings = {});

}  // namespace pirsim::stats
