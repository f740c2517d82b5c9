// Is a row that is taken for a class one of its own, or one of a class that nobody knows?
#pragma once

#include <span>
#include <vector>

#include "stats/matrix.hpp"
#include "stats/pooled_classifier.hpp"

namespace pirsim::stats {

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
