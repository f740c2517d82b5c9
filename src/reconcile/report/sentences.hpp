// Results in words. Private to reconcile.
#pragma once

#include <string>

#include "reconcile/inference/outcome.hpp"

namespace pirsim::reconcile {

[[nodiscard]] std::string verdict_sentence(const Outcome& outcome, double alpha);
[[nodiscard]] std::string reason_of(const Candidate& candidate, double alpha);
/// Of one that isn't ruled out while another is named.
[[nodiscard]] std::string reason_of_unlikely(const Candidate& candidate, const Candidate& named);
/// Of the one that would be named, if the model with it can't have made the data: look, of that model.
[[nodiscard]] std::string reason_of_refused(const Look& look);
/// The verdict then.
[[nodiscard]] std::string sentence_of_refused(const Outcome& outcome, double alpha);
/// Of the likeliest effect if it was dropped, though the model with it passes; reason: its reason_of, "Dropped: ...".
[[nodiscard]] std::string sentence_of_nearest(const Look& look, const std::string& reason);
[[nodiscard]] std::string in_words(const FittedEffect& fitted);
/// Of the model with effects applied.
[[nodiscard]] std::string what_a_look_showed(const Look& look);
/// What a reader may do with the verdict.
[[nodiscard]] std::string next_step(const Outcome& outcome);
/// "a, b or c"
[[nodiscard]] std::string joined(const std::vector<std::string>& names, const std::string& last);
/// Three significant digits.
[[nodiscard]] std::string short_number(double value);
/// So many digits after the point; never "-0".
[[nodiscard]] std::string fixed(double value, int digits);
/// Of a share: "12 %".
[[nodiscard]] std::string percent(double share);

}  // namespace pirsim::reconcile
