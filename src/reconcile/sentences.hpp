// Results in words. Private to reconcile.
#pragma once

#include <string>

#include "pirsim/reconcile/outcome.hpp"

namespace pirsim::reconcile {

[[nodiscard]] std::string verdict_sentence(const Outcome& outcome, double alpha);
[[nodiscard]] std::string reason_of(const Candidate& candidate, double alpha);
[[nodiscard]] std::string in_words(const FittedEffect& fitted);
/// Three significant digits.
[[nodiscard]] std::string short_number(double value);

}  // namespace pirsim::reconcile
