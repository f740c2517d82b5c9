// Numbers about samples: quantiles, intervals of shares and of means, the sign test; how well an ensemble predicts what
// was observed, and how far two samples lie apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pirsim/interval.hpp"
#include "stats/matrix.hpp"

namespace pirsim::stats {

/// Quantile of a sample that needn't be sorted, linear between order statistics (type 7 of [Hyndman1996]).
/// probability in [0, 1]. Throws Error(usage) for an empty sample.
[[nodiscard]] double quantile(std::span<const double> sample, double probability);
/// Quantile of an ascending sample.
[[nodiscard]] double sorted_quantile(std::span<const double> sample, double probability);

/// Exact interval of a probability after `hits` of `trials` (1 or more), at least `confidence` sure.
/// Ref: [ClopperPearson1934]
[[nodiscard]] Interval clopper_pearson(std::size_t hits, std::size_t trials, double confidence = 0.95);

/// P(at least `positive` of `positive + negative` signs are positive) if both signs are equally likely; zeros are to be
/// left out by the caller. 1 without any sign.
[[nodiscard]] double sign_test_greater(std::size_t positive, std::size_t negative);

/// Student's interval of the mean of independent values (2 or more), `confidence` sure if they are normally
/// distributed.
[[nodiscard]] Interval mean_interval(std::span<const double> values, double confidence = 0.95);

// How well an ensemble predicts what was observed, and how far two samples lie apart.

/// The energy score of an ensemble (n_members x n_entries, at least one member): mean |x - y| - 1/2 mean |x - x'|, over
/// all pairs of members, each with itself too, by Euclidean distances. 0 is perfect; with one member it is the error.
/// Scale the entries first if their units differ. Ref: [Gneiting2007] equation 22.
[[nodiscard]] double energy_score(const Matrix<double>& ensemble, std::span<const double> observed);

/// Area between two empirical distribution functions (1-Wasserstein distance), in the unit of the values; the samples
/// may differ in size, neither may be empty.
[[nodiscard]] double area_between(std::span<const double> a, std::span<const double> b);

// Parameters of a simulator from data, without a likelihood: regression-adjusted ABC.

/// Statistics chosen for the parameters: the best linear estimate of each parameter from many statistics (ridge
/// regression, its strength by generalised cross-validation). Estimates are few, so ABC on them loses least.
/// Ref: [FearnheadPrangle2012]
class ParameterEstimator {
 public:
  ParameterEstimator() = default;
  /// statistics: (n_rows x n_statistics); parameters: (n_rows x n_parameters); two rows or more.
  [[nodiscard]] static ParameterEstimator fit(const Matrix<double>& statistics, const Matrix<double>& parameters);
  [[nodiscard]] std::vector<double> estimate(std::span<const double> statistics) const;  ///< (n_parameters)

 private:
  std::vector<double> intercept_;
  Matrix<double> slopes_;  ///< (n_parameters x n_statistics)
};

struct AbcSettings {
  double accepted = 0.2;              ///< share of rows nearest to the observed statistics that are kept; (0, 1]
  std::vector<Interval> bounds = {};  ///< per parameter, its prior's range, never left; empty: no bounds
};

/// A weighted sample of the posterior.
struct AbcPosterior {
  Matrix<double> values;        ///< (n_accepted x n_parameters) after regression adjustment
  std::vector<double> weights;  ///< (n_accepted) Epanechnikov's kernel of the distance; sum 1
  [[nodiscard]] double quantile(std::size_t parameter, double probability) const;
  /// Equal tails; `widening` stretches the interval about the median (1: as it is).
  [[nodiscard]] Interval interval(std::size_t parameter, double confidence, double widening = 1.0) const;
};

/// Local-linear regression adjustment. parameters: (n_rows x n_parameters) drawn from the prior; statistics: (n_rows x
/// n_statistics) simulated with them, few (use ParameterEstimator); observed: (n_statistics). Bounded parameters are
/// adjusted on the logit scale of their range. Throws Error(usage) for sizes that differ or fewer than
/// n_statistics + 2 accepted rows. Ref: [Beaumont2002]
[[nodiscard]] AbcPosterior abc_posterior(const Matrix<double>& parameters, const Matrix<double>& statistics,
                                         std::span<const double> observed, const AbcSettings& settings = {});

// Is this vector of statistics one of those the model makes, and if not, which entries stand out: the global envelope
// test. A row's extremeness is its sorted vector of the ranks of its entries, compared as words in a dictionary are
// (extreme rank length). Ranks are continuous: the gap to the neighbour counts too, so that one entry far outside
// suffices however many entries there are. Ref: [Myllymaki2017], [Myllymaki2024], [Hahn2015]

struct EnvelopeSettings {
  double alpha = 0.05;   ///< level of the drawn envelope; in (0, 1)
  unsigned threads = 0;  ///< 0: all cores; never changes the result
};

struct GlobalEnvelope {
  double p = 1.0;                    ///< of the whole vector: P(p <= a) <= a if the model is right
  std::vector<double> adjusted_p;    ///< (n_entries) smallest alpha whose envelope excludes the entry
  std::vector<double> lower, upper;  ///< (n_entries) envelope of the rows that are not among the alpha most extreme
  std::vector<double> median;        ///< (n_entries) of the simulated rows
};

/// observed: (n_entries); simulated: (n_simulated x n_entries), exchangeable with the observed row if the model is
/// right. p is a multiple of 1 / (n_simulated + 1). Entries that are the same in all rows say nothing and do no harm
/// but cost time. Throws Error(usage) for lengths that don't match, no simulated row, or a number that isn't finite.
[[nodiscard]] GlobalEnvelope global_envelope_test(std::span<const double> observed, const Matrix<double>& simulated,
                                                  const EnvelopeSettings& settings = {});

/// The p of global_envelope_test() for many observed rows and one set of simulated ones. What doesn't depend on the
/// observed row is done once; a row then costs one pass over the table.
class EnvelopeReference {
 public:
  /// simulated: (n_simulated x n_entries), finite, two rows or more. Throws Error(usage) otherwise.
  explicit EnvelopeReference(Matrix<double> simulated);
  [[nodiscard]] double p(std::span<const double> observed) const;  ///< of (n_entries) finite numbers

 private:
  struct Column;
  [[nodiscard]] Column insert(std::size_t entry, double observed) const;

  Matrix<double> simulated_;
  Matrix<double> sorted_;      ///< (n_entries x n_simulated) values of each entry
  Matrix<double> from_below_;  ///< (n_simulated x n_entries) ranks among the simulated rows
  std::vector<double> least_;  ///< (n_simulated) the least of their ranks, from below or above
};

}  // namespace pirsim::stats
