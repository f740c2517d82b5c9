// Results in words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pirsim/reconcile.hpp"
#include "reconcile/selftest/plan.hpp"
#include "reconcile/selftest/selftest.hpp"
#include "show/report.hpp"

namespace pirsim::reconcile {

[[nodiscard]] std::string sentence(const PlanResult& result);

/// Its name with its twins, its parameters and choices.
[[nodiscard]] std::string in_words(const FittedEffect& fitted);
/// On trials that it was not fitted on, whether the model with what was applied is nearer to the data.
[[nodiscard]] std::string seen_on_held_out(const Outcome& outcome);
/// What was applied there.
[[nodiscard]] std::string applied_to_held_out(const Outcome& outcome);
/// What else a choice may be, in brackets; empty if the data tell.
[[nodiscard]] std::string rivals_in_words(const FittedEffect& fitted, const std::string& choice,
                                          const std::string& value);
[[nodiscard]] std::string in_words(const Look& look);
/// What a reader may do with the verdict.
[[nodiscard]] std::string next_step(const Outcome& outcome);
/// The candidates, and after each those that change the model in the same way and were judged as one with it.
[[nodiscard]] std::vector<Candidate> with_twins(const std::vector<Candidate>& candidates);

/// "a, b or c"
[[nodiscard]] std::string enumerated(const std::vector<std::string>& names, const std::string& last);
/// "3 deg", "0.1 per s".
[[nodiscard]] std::string with_unit(double value, const std::string& unit);

/// The outcome with the verdict of the comparison, whatever was found in the file.
[[nodiscard]] Outcome as_compared(const Outcome& outcome);
/// Part of the report: a look at the file.
[[nodiscard]] io::ReportSection file_section(const std::vector<DataFinding>& findings);

}  // namespace pirsim::reconcile
