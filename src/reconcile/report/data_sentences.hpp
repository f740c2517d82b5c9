// What is wrong with the measured rows themselves, in words.
#pragma once

#include <string>
#include <vector>

#include "io/pages/report.hpp"
#include "pirsim/reconcile.hpp"

namespace pirsim::reconcile {

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
