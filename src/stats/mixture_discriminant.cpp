#include "stats/mixture_discriminant.hpp"

#include <algorithm>
#include <cmath>

#include "stats/require.hpp"
#include "stats/softmax.hpp"

namespace pirsim::stats {

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

}  // namespace pirsim::stats
