// A reconciliation as a page for a reader who knows no statistics.
#pragma once

#include "io/report.hpp"
#include "reconcile/inference/outcome.hpp"

namespace pirsim::reconcile {

/// The verdict first; then where model and measurement differ, which effects were looked at and why each was kept or
/// dropped, how strong the named ones are, and whether held-out trials are predicted better with them.
[[nodiscard]] io::Report report_page(const Outcome& outcome, double alpha);

}  // namespace pirsim::reconcile
