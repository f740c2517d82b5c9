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

/// What was applied helps on no trial set aside, and the folds don't agree on an effect of the verdict's: what is
/// missing may well be none of them.
[[nodiscard]] bool is_unsupported(const Outcome& outcome);
[[nodiscard]] std::string sentence(const PlanResult& result);
[[nodiscard]] std::string sentence(const Residuals& residuals);
/// Beside the effects of a verdict; empty if nothing is left over.
[[nodiscard]] std::string sentence_of_rest(const Residuals& rest);

[[nodiscard]] std::string in_words(const Reason& reason);
/// Without the word that says whether it was kept.
[[nodiscard]] std::string why(const Reason& reason);
/// With its twins.
[[nodiscard]] std::string name_in_words(const FittedEffect& fitted);
/// Its parameters and choices; empty for an effect that is there or not.
[[nodiscard]] std::string strength_in_words(const FittedEffect& fitted);
/// Both.
[[nodiscard]] std::string in_words(const FittedEffect& fitted);
/// On trials that it was not fitted on, whether the model with what was applied is nearer to the data.
[[nodiscard]] std::string seen_on_held_out(const Verification& verification);
/// What else a choice may be, in brackets; empty if the data tell.
[[nodiscard]] std::string rivals_in_words(const FittedEffect& fitted, const std::string& choice,
                                          const std::string& value);
/// Of the model with effects applied.
[[nodiscard]] std::string in_words(const Look& look);
[[nodiscard]] std::string in_words(const LeftOut& left_out);
/// Which sensors or trial, when, and what they do.
[[nodiscard]] std::string who_of(const ResidualDriver& driver);
[[nodiscard]] std::string when_of(const ResidualDriver& driver);
[[nodiscard]] std::string what_of(const ResidualDriver& driver);
[[nodiscard]] std::string_view in_words(Counted counted) noexcept;
/// Short, and as part of a sentence: what is measured.
[[nodiscard]] std::string name(const Design& design);
[[nodiscard]] std::string what_of(const Design& design);
/// What a reader may do with the verdict.
[[nodiscard]] std::string next_step(const Outcome& outcome);
/// The candidates, and after each those that change the model in the same way and were judged as one with it.
[[nodiscard]] std::vector<Candidate> with_twins(const std::vector<Candidate>& candidates);

/// "a, b or c"
[[nodiscard]] std::string enumerated(const std::vector<std::string>& names, const std::string& last);
/// Three significant digits.
[[nodiscard]] std::string short_number(double value);
/// "p = 0.013"; "p <= 0.0099" if no data give a smaller one than `least_p`.
[[nodiscard]] std::string p_in_words(double p, double least_p = 0.0);
/// "3 deg", "0.1 per s".
[[nodiscard]] std::string with_unit(double value, const std::string& unit);
/// So many digits after the point; never "-0".
[[nodiscard]] std::string fixed(double value, int digits);

// What is wrong with the measured rows themselves, in words.

/// The outcome without what was found in the file: its verdict is that of the comparison.
[[nodiscard]] Outcome as_compared(const Outcome& outcome);
/// Of the verdict faulty_data: what is wrong with the file.
[[nodiscard]] std::string sentence_of_file(const Outcome& outcome);
/// Then what the comparison says.
[[nodiscard]] std::vector<std::string> details_of_faulty(const Outcome& outcome);
/// What a reader may do with that verdict.
[[nodiscard]] std::string next_step_of_faulty(const Outcome& outcome);
/// Part of the report.
[[nodiscard]] io::ReportSection file_section(const std::vector<DataFinding>& findings);

}  // namespace pirsim::reconcile
