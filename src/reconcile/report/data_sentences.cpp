#include "reconcile/report/data_sentences.hpp"

#include <algorithm>
#include <string_view>

#include "reconcile/report/sentences.hpp"

namespace pirsim::reconcile {
namespace {

using What = DataFinding::What;

/// 1,800
std::string grouped(std::size_t n) {
  std::string digits = std::to_string(n);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
  return digits;
}

std::string place(const DataFinding::Place& place) {
  return "rows " + grouped(place.from_row) + " to " + grouped(place.to_row) + " of " + place.trial + " (run " +
         std::to_string(place.replicate) + ")";
}

std::string alike(const DataFinding& finding, const std::string& how) {
  const std::string both =
      enumerated(finding.sensors, "and") + " " + how + " in all " + grouped(finding.n_rows) + " rows";
  if (finding.n_exceptions == 0) return both;
  return both + " but for " + grouped(finding.n_exceptions) + (finding.n_exceptions == 1 ? " change" : " changes");
}

/// Where to look for the cause.
std::string_view advice(What what) {
  switch (what) {
    case What::equal_columns:
    case What::opposite_columns:
      return "see which input each of the two columns was read from";
    case What::constant_column:
      return "see whether the output or its wire is stuck";
    case What::beats:
      return "see whether the logger writes its sign of life or its polling as motion";
    case What::polled:
      return "see how often the logger asks: if only so often, set window_s to that and resample the rows";
    case What::repeated_rows:
      return "see whether files were joined or saved under a wrong name; take one of the two places out";
    case What::all_silent:
      return "see whether anything was recorded then; leave fields empty that are unknown";
    case What::silent_column:
      break;
  }
  return "see whether the sensor has power and its column is the right one";
}

}  // namespace

std::string in_words(const DataFinding& finding) {
  const std::string every = "every " + short_number(finding.every_s) + " s";
  const std::string& sensor = finding.sensors.empty() ? std::string() : finding.sensors.front();
  switch (finding.what) {
    case What::equal_columns:
      return alike(finding, "are equal");
    case What::opposite_columns:
      return alike(finding, "are opposite");
    case What::constant_column:
      return sensor + " is 1 in all " + grouped(finding.n_rows) + " rows";
    case What::beats:
      return sensor + " is 1 " + every + ", whatever happens";
    case What::polled:
      return "no sensor changes but " + every;
    case What::repeated_rows:
      return place(finding.places.front()) + " stand again as " + place(finding.places.back());
    case What::all_silent:
      return "all sensors are silent together in " + place(finding.places.front()) +
             (finding.is_impossible ? ", far longer than else in that run and than" : ", longer than") +
             " in any simulated one";
    case What::silent_column:
      break;
  }
  return sensor + " has no 1 in " + grouped(finding.n_rows) + " rows, though the model expects some";
}

Outcome as_compared(const Outcome& outcome) {
  Outcome rows = outcome;
  rows.verdict = outcome.verdict_of_rows;
  return rows;
}

std::string sentence_of_file(const Outcome& outcome) {
  std::vector<std::string> told;
  for (const DataFinding& finding : outcome.data_findings) {
    if (finding.is_impossible) told.push_back(in_words(finding));
  }
  std::string text = "Look at the file first: ";
  for (const std::string& finding : told) text += (&finding == &told.front() ? "" : "; ") + finding;
  return text + ", which sensors can't have said.";
}

std::vector<std::string> details_of_faulty(const Outcome& outcome) {
  const Outcome rows = as_compared(outcome);
  std::vector<std::string> texts = details(rows);
  texts.insert(texts.begin(), "With the rows taken as they are: " + sentence(rows));
  return texts;
}

std::string next_step_of_faulty(const Outcome& outcome) {
  std::vector<std::string> steps;
  for (const DataFinding& finding : outcome.data_findings) {
    const std::string step(advice(finding.what));
    if (finding.is_impossible && std::ranges::find(steps, step) == steps.end()) steps.push_back(step);
  }
  std::string text = "What to do next: ";
  for (const std::string& step : steps) text += (&step == &steps.front() ? "" : "; ") + step;
  return text + ". Then mend the file and analyse it again. What else is told here may come from the same fault.";
}

io::ReportSection file_section(const std::vector<DataFinding>& findings) {
  io::ReportSection section{"A look at the file", {}, {}, {}};
  section.paragraphs.emplace_back(
      "Before anything is compared, the rows themselves are looked at: can sensors have said them? What the model's "
      "own "
      "runs do as well, as repeating a movement by the metronome, isn't told.");
  io::Table table{{"finding", "told since", "what to do"}, {}};
  for (const DataFinding& finding : findings) {
    const std::string chance = finding.chance < 1e-12 ? "below 1e-12" : short_number(finding.chance);
    table.rows.push_back({in_words(finding),
                          finding.is_impossible ? "by chance " + chance : "odd, but sensors can do that",
                          std::string(advice(finding.what))});
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace pirsim::reconcile
