// Which classes a row may belong to, with a guaranteed error rate; and whether a row that is taken for a class is one
// of its own, or one of a class that nobody knows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/classes.hpp"
#include "stats/matrix.hpp"
#include "stats/trees.hpp"

namespace pirsim::stats {

// How strange a row is among others by the strangest of several measures.

/// Share of the calibration scores and the score itself that are at least as great (strange) as the score. If the score
/// and the calibration scores are exchangeable, P(p <= a) <= a. Ref: [Vovk2005]
[[nodiscard]] double conformal_p(std::span<const double> calibration, double score);

/// How far a measure reaches upwards, from its median to its 95 % quantile, is taken from the known rows and the one
/// that is asked for together. Taken from the known ones alone, a row that stretches a scale would be less strange
/// among them than it is by itself, and p too small.
class StrangestMeasure {
 public:
  /// known: (n_rows x n_measures), one row or more; the greater, the stranger.
  explicit StrangestMeasure(const Matrix<double>& known);
  /// row: (n_measures). If it and the known ones are exchangeable, P(p <= a) <= a.
  [[nodiscard]] double p(std::span<const double> row) const;

 private:
  Matrix<double> known_;                     ///< (n_measures x n_rows)
  std::vector<std::vector<double>> sorted_;  ///< (n_measures) each (n_rows), ascending
};

struct ConformalSettings {
  PooledClassifierSettings pooled = {};
  ClassShapesSettings shapes = {};
  /// Columns whose shapes are looked at together, each block by itself: {} or all columns as one. A block of sums over
  /// many cells sees a small change that all cells share, which drowns among the cells themselves.
  std::vector<std::vector<std::size_t>> blocks = {};
};

/// What is said of one row; each list is (n_classes).
struct Classification {
  std::vector<double> probabilities;  ///< calibrated, classes equally likely beforehand
  std::vector<double> p_relative;     ///< of the margin of the best other class over this one
  std::vector<double> p_absolute;     ///< of the row's strangeness for the class: can it make this row at all
  std::vector<double> p;              ///< min(1, 2 min(p_relative, p_absolute)): both tests in one
};

/// A pooled classifier and the shapes of the classes. For a row that class k made, P(p[k] <= a) <= a for each k, up to
/// the three pool weights being taken from the calibration rows.
class ConformalClassifier {
 public:
  ConformalClassifier() = default;
  /// features: (n_rows x n_columns), finite; labels: (n_rows) in [0, n_classes); each class ten times or more among the
  /// fitting rows and once or more among the calibration rows. Rows that depend on each other must be on one side of
  /// the split. subclasses: of PooledClassifier::fit().
  [[nodiscard]] static ConformalClassifier fit(const Matrix<float>& features, std::span<const int> labels,
                                               int n_classes, const Split& split,
                                               const ConformalSettings& settings = {},
                                               std::span<const int> subclasses = {});
  [[nodiscard]] Classification classify(std::span<const float> features) const;

  /// The least p that class k can have: that of a row stranger than all of its calibration rows.
  [[nodiscard]] double least_p(std::size_t k) const noexcept {
    return 2.0 / static_cast<double>(margins_[k].size() + 1);
  }

  /// The classifier by itself, without the tests.
  [[nodiscard]] const PooledClassifier& pooled() const noexcept { return pooled_; }
  [[nodiscard]] const Matrix<double>& calibration_probabilities() const noexcept {
    return pooled_.calibration_probabilities();
  }
  [[nodiscard]] int n_classes() const noexcept { return pooled_.n_classes(); }

 private:
  /// (n_blocks + 1) of the row for class k: by block the cube root of its squared distance from the class's shape,
  /// which has a tail as the normal distribution whatever the number of columns [WilsonHilferty1931], and how unlikely
  /// the class's layers make it.
  [[nodiscard]] std::vector<double> measures(std::span<const float> features, std::span<const double> log_densities,
                                             std::size_t k) const;
  void calibrate(const Matrix<float>& features, std::span<const int> labels, unsigned threads);

  PooledClassifier pooled_;
  std::vector<std::vector<std::size_t>> blocks_;
  std::vector<ClassShapes> shapes_;           ///< per block
  std::vector<std::vector<double>> margins_;  ///< per class, of its calibration rows
  std::vector<StrangestMeasure> strangest_;   ///< per class, of its calibration rows
};

// Is a row that is taken for a class one of its own, or one of a class that nobody knows?

/// Rows of another class that would be taken for class k if their own were unknown are *impostors* of k. For each class
/// a logistic regression on the log densities of all classes tells its own rows from its impostors. A row of a class
/// that is really unknown looks like an impostor more often than like an own row. Outlier exposure, with classes that
/// are left out in turn. Ref: [Hendrycks2019]
class ImpostorTests {
 public:
  ImpostorTests() = default;
  /// log_densities: (n_rows x n_classes >= 2); labels: (n_rows). Class 0 has no impostors and is none: that something
  /// is there is asked elsewhere. The split's fitting rows teach, its calibration rows are compared with.
  [[nodiscard]] static ImpostorTests fit(const Matrix<double>& log_densities, std::span<const int> labels,
                                         const Split& split, unsigned threads = 0);
  /// log_densities: (n_classes) of a row that is taken for class k. If k made it, P(p <= a) <= a; 1 for a class that
  /// has too few impostors to tell.
  [[nodiscard]] double p(std::size_t k, std::span<const double> log_densities) const;

 private:
  struct Test {
    double centre = 0.0;              ///< log density that is usual in the class itself
    std::vector<double> slopes;       ///< (n_classes); none without enough impostors
    std::vector<double> calibration;  ///< scores of own rows
    [[nodiscard]] double score(std::span<const double> log_densities) const;  ///< greater: more like an impostor
  };
  [[nodiscard]] static Test learn(std::size_t k, const Matrix<double>& log_densities, std::span<const int> labels,
                                  const Split& split);
  std::vector<Test> tests_;  ///< per class
};

}  // namespace pirsim::stats
