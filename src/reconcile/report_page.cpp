#include "pirsim/reconcile/report_page.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace pirsim::reconcile {
namespace {

std::string fixed(double value, int digits) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

std::string with_sign(double value) { return (value > 0.0 ? "+" : "") + fixed(value, 0); }

std::string percent(double share) { return fixed(100.0 * share, 0) + " %"; }

/// Names in the order in which they first come.
std::vector<std::string> distinct(const std::vector<LocatedCell>& cells, std::string LocatedCell::*which) {
  std::vector<std::string> names;
  for (const LocatedCell& cell : cells) {
    if (std::ranges::find(names, cell.*which) == names.end()) names.push_back(cell.*which);
  }
  return names;
}

io::Table difference_table(const Location& location, double alpha) {
  const std::vector<std::string> sensors = distinct(location.cells, &LocatedCell::sensor);
  io::Table table;
  table.headings.push_back("");
  table.headings.insert(table.headings.end(), sensors.begin(), sensors.end());
  for (const std::string& trial : distinct(location.cells, &LocatedCell::trial)) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(trial);
    for (const std::string& sensor : sensors) {
      const auto cell = std::ranges::find_if(
          location.cells, [&](const LocatedCell& c) { return c.trial == trial && c.sensor == sensor; });
      row.push_back(cell == location.cells.end()
                        ? "not measured"
                        : with_sign(cell->measured_s - cell->expected_s) + (cell->adjusted_p < alpha ? " *" : ""));
    }
  }
  return table;
}

io::ReportSection where(const Outcome& outcome, double alpha) {
  const Location& location = outcome.location;
  const auto differing = std::ranges::count_if(location.cells, [&](const auto& c) { return c.adjusted_p < alpha; });
  io::ReportSection section{"Where they differ", {}, {}, {}};
  section.paragraphs = {
      "Measured seconds with motion less what the model expects. A star marks what chance and an inexactly known room "
      "don't explain: " +
          std::to_string(differing) + " of " + std::to_string(location.cells.size()) + ".",
      "The model was run " + std::to_string(location.n_simulated) +
          " times, each time in a slightly different room. On average, a difference below " +
          fixed(location.band_s, 0) + " s can't be told from chance here."};
  section.tables.push_back(difference_table(location, alpha));
  return section;
}

io::ReportSection envelope(const Location& location, double alpha) {
  io::ReportSection section{"Seen as a whole", {}, {}, {}};
  section.paragraphs = {
      "Each line is a number taken from the data, scaled so that all can be compared, that lies outside the range of "
      "all "
      "the model's runs taken together. "
      "If the model were right, this page would show any such line in " +
      percent(alpha) + " of cases only."};
  io::Table table{{"what", "measured", "lowest", "usual", "highest"}, {}};
  for (const EnvelopeEntry& entry : location.envelope) {
    if (entry.adjusted_p >= alpha) continue;
    table.rows.push_back(
        {entry.name, fixed(entry.observed, 2), fixed(entry.lower, 2), fixed(entry.median, 2), fixed(entry.upper, 2)});
  }
  if (table.rows.empty()) {
    section.paragraphs.push_back("Nothing lies outside.");
  } else {
    section.tables.push_back(std::move(table));
  }
  return section;
}

io::ReportSection candidates(const Outcome& outcome) {
  io::ReportSection section{"What it may be", {}, {}, {}};
  io::Table table{{"effect", "family", "probability", "", "why"}, {}};
  for (const Candidate& candidate : outcome.candidates) {
    table.rows.push_back({candidate.score.entry, candidate.family, percent(candidate.score.probability),
                          candidate.kept ? "kept" : "dropped", candidate.reason});
  }
  if (table.rows.empty()) {
    section.paragraphs.push_back("Nothing was looked for, since nothing differs.");
  } else {
    section.paragraphs.push_back(
        "Every effect of the catalogue, the likeliest first. The probability compares them with one another; an effect "
        "is kept only if it can also produce these data by itself.");
    section.tables.push_back(std::move(table));
  }
  return section;
}

io::ReportSection strength(const std::vector<FittedEffect>& fits) {
  io::ReportSection section{"How strong it is", {}, {}, {}};
  section.paragraphs.push_back("The true value lies in the range in about nine cases of ten.");
  io::Table table{{"effect", "parameter", "fitted", "from", "to", "unit", "without the effect"}, {}};
  for (const FittedEffect& fit : fits) {
    for (const FittedParameter& p : fit.parameters) {
      table.rows.push_back({fit.effect.name, p.name, fixed(p.value, 3), fixed(p.interval.low, 3),
                            fixed(p.interval.high, 3), p.unit, p.is_strength ? fixed(p.off, 3) : ""});
    }
  }
  section.tables.push_back(std::move(table));
  return section;
}

io::ReportSection held_out(const Verification& v) {
  io::ReportSection section{"Does it help", {}, {}, {}};
  section.paragraphs = {
      "Trials were set aside, the effect was sought and fitted without them, and then they were compared with the "
      "model "
      "before and after, " +
          std::to_string(v.n_folds) + " times over.",
      v.closed   ? "With the effect, the model agrees with trials that it was not fitted on."
      : v.shrunk ? "With the effect, the model is closer to trials that it was not fitted on, but still differs."
                 : "That the model is closer with the effect is not shown."};
  io::Table table{{"on trials set aside", "before", "after", "at best"}, {}};
  const auto outside = [](const Gap& gap) {
    return std::to_string(gap.cells_outside) + " of " + std::to_string(gap.n_cells);
  };
  table.rows = {{"distance of model and data (energy score)", fixed(v.before.energy_score, 3),
                 fixed(v.after.energy_score, 3), fixed(v.noise_floor, 3)},
                {"seconds between them, mean over cells", fixed(v.before.area_s, 1), fixed(v.after.area_s, 1), ""},
                {"cells outside the model's range", outside(v.before), outside(v.after), ""}};
  if (!v.placebo_effect.empty()) {
    table.rows.push_back(
        {"distance with " + v.placebo_effect + " instead, an effect of another family", "", fixed(v.placebo, 3), ""});
  }
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace

io::Report report_page(const Outcome& outcome, double alpha) {
  io::Report report;
  report.title = "Model and measurement";
  report.paragraphs = {outcome.sentence};
  report.sections = {where(outcome, alpha), envelope(outcome.location, alpha), candidates(outcome)};
  if (!outcome.fits.empty()) report.sections.push_back(strength(outcome.fits));
  if (outcome.verification) report.sections.push_back(held_out(*outcome.verification));
  return report;
}

}  // namespace pirsim::reconcile
