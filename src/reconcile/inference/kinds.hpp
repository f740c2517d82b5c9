// An effect is several things: on this sensor or that, to the left or to the right, hardly or strongly.
#pragma once

#include <span>
#include <vector>

#include "effects/catalogue.hpp"
#include "reconcile/ensemble/reference_table.hpp"
#include "stats/discriminant.hpp"

namespace pirsim::reconcile {

/// A value beyond the prior is moved to its end.
[[nodiscard]] double to_flat(const effects::ParameterInfo& info, double value);
/// Whole where it must be, and within what is accepted.
[[nodiscard]] double from_flat(const effects::ParameterInfo& info, double value);

// An effect is several things: on this sensor or that, to the left or to the right, hardly or strongly.

/// (n) numbers from 0 on of datasets of one hypothesis that are alike: with the same choices, strengths on the same
/// side of `off`, and, as far as ten datasets remain in each, in the same third by the parameter that names the
/// strength. Kinds with fewer than `fewest` datasets are one group.
[[nodiscard]] std::vector<int> number_alike(const ReferenceTable& table, std::span<const std::size_t> rows,
                                            std::size_t fewest);

/// Finds what of an effect isn't a matter of more or less, by a discriminant between the kinds of its training
/// datasets.
class KindFinder {
 public:
  /// rows: of one hypothesis of the table; features: (n_rows x n_features).
  KindFinder(const ReferenceTable& table, std::span<const std::size_t> rows, const stats::Matrix<float>& features);
  /// Place in `rows` of a dataset with the likeliest choices and sides.
  [[nodiscard]] std::size_t one_like(std::span<const float> features) const;
  /// One of each kind, as a place in `rows`, with the probability that the dataset is of that kind.
  struct Share {
    std::size_t example = 0;
    double probability = 0.0;
  };
  [[nodiscard]] std::vector<Share> shares(std::span<const float> features) const;

 private:
  std::vector<std::size_t> examples_;  ///< (n_kinds) places in rows
  std::vector<double> n_;              ///< (n_kinds) datasets of the kind
  stats::Discriminant discriminant_;   ///< between kinds, if there are several
};

}  // namespace pirsim::reconcile
