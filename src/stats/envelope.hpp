// Is this vector of statistics one of those the model makes, and if not, which entries stand out: the global envelope
// test. Ref: [Myllymaki2017], [Myllymaki2024]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/matrix.hpp"

namespace pirsim::stats {

/// How extreme one entry is among those of the other rows. A row's extremeness is its sorted vector of pointwise
/// ranks, compared as words in a dictionary are (extreme rank length), whichever of these it is made of.
enum class PointwiseRank {
  random_ties,  ///< 1, 2, ...: equal values are put in random order; the test's level is exact for discrete data too
  middle_ties,  ///< equal values share the middle rank; more power for discrete data, p a little too large with ties
  continuous,   ///< the gap to the neighbour counts too, so one entry far outside suffices however many entries
                ///< there are. Ref: [Hahn2015]
};

struct EnvelopeSettings {
  double alpha = 0.05;  ///< level of the drawn envelope; in (0, 1)
  PointwiseRank rank = PointwiseRank::random_ties;
  std::uint64_t seed = 0;  ///< of the random order of ties
  unsigned threads = 0;    ///< 0: all cores; never changes the result
};

struct GlobalEnvelope {
  double p = 1.0;                    ///< of the whole vector: P(p <= a) <= a if the model is right
  std::vector<double> adjusted_p;    ///< (n_entries) smallest alpha whose envelope excludes the entry; its minimum is p
                                     ///< with random ties
  std::vector<double> lower, upper;  ///< (n_entries) envelope of the rows that are not among the alpha most extreme
  std::vector<double> median;        ///< (n_entries) of the simulated rows
};

/// observed: (n_entries); simulated: (n_simulated x n_entries), exchangeable with the observed row if the model is
/// right. p is a multiple of 1 / (n_simulated + 1). Entries that are the same in all rows say nothing and do no harm
/// but cost time. Throws Error(usage) for lengths that don't match, no simulated row, or a number that isn't finite.
[[nodiscard]] GlobalEnvelope global_envelope_test(std::span<const double> observed, const Matrix<double>& simulated,
                                                  const EnvelopeSettings& settings = {});

/// The p of global_envelope_test() for many observed rows and one set of simulated ones, without random ties. What
/// doesn't depend on the observed row is done once; a row then costs one pass over the table.
class EnvelopeReference {
 public:
  /// simulated: (n_simulated x n_entries), finite, two rows or more. Throws Error(usage) otherwise.
  explicit EnvelopeReference(Matrix<double> simulated, PointwiseRank rank = PointwiseRank::continuous);
  [[nodiscard]] double p(std::span<const double> observed) const;  ///< of (n_entries) finite numbers

 private:
  struct Column;
  [[nodiscard]] Column insert(std::size_t entry, double observed) const;

  Matrix<double> simulated_;
  Matrix<double> sorted_;      ///< (n_entries x n_simulated) values of each entry
  Matrix<double> from_below_;  ///< (n_simulated x n_entries) ranks among the simulated rows
  std::vector<double> least_;  ///< (n_simulated) the least of their ranks, from below or above
  PointwiseRank rank_;
};

}  // namespace pirsim::stats
