#include "reconcile/report/pages.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "core/text.hpp"
#include "reconcile/report/data_sentences.hpp"
#include "reconcile/report/sentences.hpp"

namespace pirsim::reconcile {
namespace {

std::string count_of(std::size_t n, std::size_t of) { return std::to_string(n) + " of " + std::to_string(of); }

/// A word that a shell takes as it stands.
std::string shell_word(const std::string& text) {
  constexpr std::string_view plain_marks = "_-./=,:";
  const auto plain = [&](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || plain_marks.find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::ranges::all_of(text, plain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// As part of a file's name.
std::string file_word(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c < 128; }, '_');
  return text;
}

/// Of the framed cells, the first ones: the command, and where the page that it writes is opened.
io::Table pages_to_watch(const Location& location, double alpha, const Watched& watched) {
  constexpr std::size_t most = 3;
  io::Table table{{"trial", "sensor", "command", "then open"}, {}};
  if (!watched.whole_trials) return table;
  std::string study;
  for (const std::string& word : watched.model_options) study += ' ' + shell_word(word);
  for (const LocatedCell& cell : location.cells) {
    if (cell.adjusted_p > alpha || table.rows.size() == most) continue;
    const std::string page = file_word(cell.trial) + ".html";
    table.rows.push_back(
        {cell.trial, cell.sensor, "pirsim view" + study + " --trial " + shell_word(cell.trial) + " -o " + page,
         page + "#" + (watched.phase.empty() ? "" : "phase=" + watched.phase + "&") + "sensor=" + cell.sensor});
  }
  return table;
}

io::ReportSection where(const Outcome& outcome, const Watched& watched) {
  const double alpha = outcome.alpha;
  const Location& location = outcome.location;
  const auto differing = std::ranges::count_if(location.cells, [&](const auto& c) { return c.adjusted_p <= alpha; });
  io::ReportSection section{"Where they differ", {}, {}, {}};
  section.paragraphs = {
      count_of(static_cast<std::size_t>(differing), location.cells.size()) +
          " cells (one trial and one sensor) differ by more than chance.",
      "The model was run " + std::to_string(location.n_simulated) +
          " times, each time in a slightly different room, since nobody knows seats and sensors exactly. On average, a "
          "difference below " +
          fixed(location.band_s, 0) +
          " s in one cell can't be told from chance here. Of so many cells some lie outside their usual range "
          "by chance alone; a frame marks those that do with that allowed for."};
  if (io::Table pages = pages_to_watch(location, alpha, watched); !pages.rows.empty()) {
    section.paragraphs.emplace_back(
        "What the model does there can be watched, in a page that plays the run. These commands work in the folder in "
        "which the analysis was started:");
    section.tables.push_back(std::move(pages));
  }
  section.charts.emplace_back(difference_chart(location, alpha));
  return section;
}

io::ReportSection envelope(const Location& location, double alpha) {
  io::ReportSection section{"Seen as a whole", {}, {}, {}};
  const auto outside = std::ranges::count_if(location.envelope, [&](const auto& e) { return e.adjusted_p <= alpha; });
  section.paragraphs = {
      "The global test, and its picture: if the model were right, any red dot would appear in only " +
      short_number(100.0 * alpha) + " % of cases. Here, " +
      count_of(static_cast<std::size_t>(outside), location.envelope.size()) + " lie outside (" +
      p_in_words(location.p, location.least_p()) +
      "). Each number is counted in units of its own scatter in the model, not in seconds; large deviations are "
      "compressed."};
  section.charts.emplace_back(envelope_chart(location, alpha));
  return section;
}

io::ReportSection candidates(const Outcome& outcome) {
  io::ReportSection section{"What it may be", {}, {}, {}};
  if (outcome.verdict == Verdict::no_disagreement) {
    section.paragraphs.push_back("Nothing was looked for, since nothing differs.");
    return section;
  }
  section.paragraphs.push_back(std::string("Every effect ") +
                               (outcome.looked_for.empty() ? "of the catalogue" : "looked for") +
                               " was simulated many times in rooms like this one.");
  section.charts.emplace_back(ranking_chart(outcome));
  for (const Look& look : outcome.looks) section.paragraphs.push_back(in_words(look));
  return section;
}

io::ReportSection reasons(const Outcome& outcome) {
  io::ReportSection section{"Every candidate, and why it was kept or dropped", {}, {}, {}};
  section.paragraphs = {
      "p: twice the smaller p of two tests. One asks whether the effect's own data look like these, the other whether "
      "another effect explains these better. At most " +
      short_number(outcome.alpha) + " speaks against the effect."};
  io::Table table{{"effect", "family", "probability", "p", "why"}, {}};
  for (const Candidate& candidate : with_twins(outcome.candidates)) {
    table.rows.push_back({candidate.score.hypothesis, std::string(name(candidate.family)),
                          percent(candidate.score.probability), short_number(candidate.score.p), in_words(candidate)});
  }
  section.tables.push_back(std::move(table));
  return section;
}

io::ReportSection strength(const Outcome& outcome) {
  io::ReportSection section{"How strong it is", {}, {}, {}};
  io::Table table{{"effect", "parameter", "fitted", "from", "to", "unit", "without the effect"}, {}};
  for (const FittedEffect& fit : outcome.fits) {
    for (const FittedParameter& p : fit.parameters) {
      table.rows.push_back({fit.effect.name, p.name, short_number(p.value), short_number(p.interval.low),
                            short_number(p.interval.high), p.unit, p.is_strength ? short_number(p.off) : ""});
    }
    for (const auto& [choice, value] : fit.effect.choices) {
      table.rows.push_back({fit.effect.name, choice, value + rivals_in_words(fit, choice, value), "", "", "", ""});
    }
    for (io::DotsChart& chart : posterior_charts(fit, outcome.range_end)) section.charts.emplace_back(std::move(chart));
  }
  section.paragraphs.push_back(table.rows.empty() ? "The effect is there or not: nothing about it can be stronger."
                                                  : "Fitted to these data, with the room's uncertainty included.");
  if (!table.rows.empty()) section.tables.push_back(std::move(table));
  return section;
}

std::string what_is_shown(const Verification& v) {
  const std::string seen = seen_on_held_out(v);
  if (v.closed || !v.shrunk) return seen;
  if (v.refused)
    return seen + " But the test of everything still finds a difference there (" +
           p_in_words(v.after.p, v.after.least_p) + ").";
  return seen + " But these trials alone are too few to tell even the model as it is from the data.";
}

/// Chance carries a share beyond all that can be closed.
std::string what_is_closed(const Verification& v) {
  if (v.before.energy_score <= v.noise_floor)
    return "the model as it is was as near to these trials already as two runs of the new one are to each other.";
  if (v.share_closed >= 1.0)
    return "with it, the data are as near to the model as two of its own runs are to each other, on average.";
  if (v.share_closed < 0.0) return "on average these trials are farther from the model with it than without.";
  return fixed(100.0 * v.share_closed, 0) +
         " % of what can be closed is closed; how far two runs of the model are apart can't be.";
}

io::ReportSection held_out(const Verification& v, const std::string& named) {
  io::ReportSection section{"Does it help", {}, {}, {}};
  section.paragraphs = {
      what_is_shown(v),
      "Trials were set aside, what is missing was sought and fitted without them, and then they were compared with the "
      "model before and after, " +
          std::to_string(v.n_folds) + " times over. A trial gets nearer by " + short_number(v.gain.low) + " to " +
          short_number(v.gain.high) + " on average (95 % interval); " + what_is_closed(v)};
  section.charts.emplace_back(held_out_chart(v, named));
  io::Table table{{"on trials set aside", "before", "after"}, {}};
  table.rows = {
      {"seconds between model and data, mean", fixed(v.before.area_s, 1), fixed(v.after.area_s, 1)},
      {"cells outside the model's range", count_of(v.before.cells_outside, v.before.n_cells),
       count_of(v.after.cells_outside, v.after.n_cells)},
      {"test of everything", p_in_words(v.before.p, v.before.least_p), p_in_words(v.after.p, v.after.least_p)}};
  section.tables.push_back(std::move(table));
  return section;
}

}  // namespace

io::Report report_page(const Outcome& outcome, const Watched& watched) {
  if (!outcome.data_findings.empty()) {
    Outcome rows = as_compared(outcome);
    rows.data_findings.clear();
    io::Report report = report_page(rows, watched);
    report.finding = sentence(outcome);
    report.paragraphs = details(outcome);
    report.paragraphs.push_back(next_step(outcome));
    report.sections.insert(report.sections.begin(), file_section(outcome.data_findings));
    return report;
  }
  io::Report report;
  report.title = "Model and measurement";
  report.finding = sentence(outcome);
  report.paragraphs = details(outcome);
  report.paragraphs.push_back(next_step(outcome));
  report.sections = {where(outcome, watched), envelope(outcome.location, outcome.alpha), candidates(outcome)};
  if (!outcome.fits.empty()) report.sections.push_back(strength(outcome));
  if (outcome.verification) {
    const bool undecided = outcome.fits.empty();
    const std::string applied = undecided ? "the likeliest of each fold" : enumerated(outcome.named, "and");
    report.sections.push_back(held_out(*outcome.verification, applied));
  }
  if (outcome.verdict != Verdict::no_disagreement) report.sections.push_back(reasons(outcome));
  return report;
}

}  // namespace pirsim::reconcile
