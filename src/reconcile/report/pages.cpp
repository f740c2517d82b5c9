#include "reconcile/report/pages.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "engine/effects/catalogue.hpp"
#include "files/disk/file.hpp"
#include "model/core/text.hpp"
#include "reconcile/report/sentences.hpp"

namespace pirsim::reconcile {
namespace {

using Json = nlohmann::ordered_json;

io::BarChart gain_chart(const PlanResult& result) {
  io::BarChart chart;
  chart.title = "What more measuring would tell";
  chart.note =
      "Longer bars tell more about which effect it is; lines show how sure the bar is (95 %). A line that "
      "reaches 0 may be no gain at all.";
  chart.label = "bits more than what is planned";
  for (std::size_t i = 1; i < result.designs.size(); ++i) {
    const Design& d = result.designs[i];
    chart.bars.push_back(
        {d.what, d.more_bits, short_number(d.more_bits) + " bits in " + short_number(d.minutes) + " min",
         d.more_bits_95.low > 0.0 ? io::BarChart::Weight::strong : io::BarChart::Weight::faint, d.more_bits_95.low,
         d.more_bits_95.high,
         "right effect the likeliest in " + percent(d.right) + "\n" +
             (d.minutes > 0.0 ? short_number(d.more_bits / d.minutes) + " bits a minute" : "takes no time")});
  }
  return chart;
}

io::GridChart power_grid(const PlanResult& result) {
  io::GridChart chart;
  chart.title = "How often a disagreement would be seen, % of simulated cases";
  chart.note =
      "Dark: surely seen. Pale: an effect of this strength would stay hidden in what is planned. Strengths are "
      "thirds of what was thought possible; effects without a strength are listed under medium.";
  chart.label = "share seen";
  chart.columns = {"weak", "medium", "strong"};
  for (const PlannedPower& one : result.power) {
    if (chart.rows.empty() || chart.rows.back() != one.effect) chart.rows.push_back(one.effect);
    chart.cells.push_back(share_cell(one.seen));
  }
  return chart;
}

io::GridChart confusion_chart(const PlanResult& result) {
  return confusion_grid(
      result.hypotheses, result.confusion,
      "What would be hidden (rows), and what it would look like most (columns), % of cases",
      "Dark squares on the diagonal are right; dark squares beside it are pairs that what is planned can "
      "hardly tell apart.");
}

constexpr Column<Design> design_columns[]{
    {{"design", Holds::text, "what would be measured"}, [](const Design& design) -> Cell { return design.name; }},
    {{"minutes", Holds::number, "more than what is planned; of the plan itself all of it", "min"},
     [](const Design& design) -> Cell { return design.minutes; }},
    {{"bits", Holds::number, "told about which effect it is, mean over datasets"},
     [](const Design& design) -> Cell { return design.bits; }},
    {{"right", Holds::number, "share of datasets whose effect is the likeliest"},
     [](const Design& design) -> Cell { return design.right; }},
    {{"more_bits", Holds::number, "than what is planned"},
     [](const Design& design) -> Cell { return design.more_bits; }},
    {{"more_bits_low", Holds::number, "low end of their 95 % interval"},
     [](const Design& design) -> Cell { return design.more_bits_95.low; }},
    {{"more_bits_high", Holds::number, "high end of their 95 % interval"},
     [](const Design& design) -> Cell { return design.more_bits_95.high; }},
};

std::string with_sign(double value) {
  const std::string text = fixed(value, 0);
  return text == "-0" ? "0" : (value > 0.0 && text != "0" ? "+" : "") + text;
}

/// Names in the order in which they first come.
std::vector<std::string> distinct(const std::vector<LocatedCell>& cells, std::string LocatedCell::*which) {
  std::vector<std::string> names;
  for (const LocatedCell& cell : cells) {
    if (std::ranges::find(names, cell.*which) == names.end()) names.push_back(cell.*which);
  }
  return names;
}

io::GridChart::Cell square(const LocatedCell& cell, double alpha) {
  const double difference = cell.measured_s - cell.expected_s;
  return {difference, with_sign(difference),
          "measured " + fixed(cell.measured_s, 1) + " s, model " + fixed(cell.expected_s, 1) + " s, usually " +
              fixed(cell.low_s, 0) + " to " + fixed(cell.high_s, 0) + " s",
          cell.differs(alpha) ? io::GridChart::Mark::framed : io::GridChart::Mark::none};
}

/// Where a number lies if its envelope is stretched to reach from -1 to 1, with the median at 0.
double beside_band(const EnvelopeFeature& feature) {
  const double d = feature.observed - feature.median;
  const double half = d > 0.0 ? feature.upper - feature.median : feature.median - feature.lower;
  constexpr double beyond_any_limit = 1e3;
  if (half > 0.0) return std::clamp(d / half, -beyond_any_limit, beyond_any_limit);
  return d == 0.0 ? 0.0 : std::copysign(beyond_any_limit, d);
}

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
    if (!cell.differs(alpha) || table.rows.size() == most) continue;
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
  const auto differing = std::ranges::count_if(location.cells, [&](const auto& c) { return c.differs(alpha); });
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
  const auto outside = std::ranges::count_if(location.envelope, [&](const auto& e) { return e.adjusted_p <= alpha; });
  return {"Seen as a whole",
          {"The global test, and its picture: if the model were right, any red dot would appear in only " +
           short_number(100.0 * alpha) + " % of cases. Here, " +
           count_of(static_cast<std::size_t>(outside), location.envelope.size()) + " lie outside (" +
           p_in_words(location.p, location.least_p()) +
           "). Each number is counted in units of its own scatter in the model, not in seconds; large deviations are "
           "compressed."},
          {},
          {envelope_chart(location, alpha)}};
}

io::ReportSection candidates(const Outcome& outcome) {
  const std::string heading = "What it may be";
  if (outcome.verdict == Verdict::no_disagreement)
    return {heading, {"Nothing was looked for, since nothing differs."}, {}, {}};
  io::ReportSection section{
      heading,
      {std::string("Every effect ") + (outcome.looked_for.empty() ? "of the catalogue" : "looked for") +
       " was simulated many times in rooms like this one."},
      {},
      {ranking_chart(outcome)}};
  for (const Look& look : outcome.looks) section.paragraphs.push_back(in_words(look));
  return section;
}

io::ReportSection reasons(const Outcome& outcome) {
  io::Table table{{"effect", "family", "probability", "p", "why"}, {}};
  for (const Candidate& candidate : with_twins(outcome.candidates)) {
    table.rows.push_back({candidate.score.hypothesis, std::string(name(candidate.family)),
                          percent(candidate.score.probability), short_number(candidate.score.p), in_words(candidate)});
  }
  return {"Every candidate, and why it was kept or dropped",
          {"p: twice the smaller p of two tests. One asks whether the effect's own data look like these, the other "
           "whether another effect explains these better. At most " +
           short_number(outcome.alpha) + " speaks against the effect."},
          {std::move(table)},
          {}};
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

std::string what_is_shown(const Outcome& outcome) {
  const Verification& v = *outcome.verification;
  const std::string seen = seen_on_held_out(outcome);
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

/// Distance of model and trials set aside: before, after, with another effect instead, and at best.
io::BarChart held_out_chart(const Verification& v, const std::string& named) {
  io::BarChart chart;
  chart.title = "How far the model is from trials that it was not fitted on";
  chart.note =
      "Shorter is better. The last bar is what a right model comes to on average, since runs differ by chance; "
      "single data may lie nearer or farther.";
  chart.label = "distance (energy score)";
  const auto add = [&](const std::string& name, double value, io::BarChart::Weight weight) {
    chart.bars.push_back({name, value, fixed(value, 3), weight, {}, {}});
  };
  add("before: the model as it is", v.before.energy_score, io::BarChart::Weight::plain);
  add("after: with " + named, v.after.energy_score, io::BarChart::Weight::strong);
  if (!v.placebo_effect.empty()) {
    add("placebo: with " + v.placebo_effect + " instead", v.placebo, io::BarChart::Weight::faint);
  }
  add("the new model against itself", v.noise_floor, io::BarChart::Weight::faint);
  return chart;
}

io::ReportSection held_out(const Outcome& outcome) {
  const Verification& v = *outcome.verification;
  io::Table table{{"on trials set aside", "before", "after"}, {}};
  table.rows = {
      {"seconds between model and data, mean", fixed(v.before.area_s, 1), fixed(v.after.area_s, 1)},
      {"cells outside the model's range", count_of(v.before.cells_outside, v.before.n_cells),
       count_of(v.after.cells_outside, v.after.n_cells)},
      {"test of everything", p_in_words(v.before.p, v.before.least_p), p_in_words(v.after.p, v.after.least_p)}};
  return {"Does it help",
          {what_is_shown(outcome),
           "Trials were set aside, what is missing was sought and fitted without them, and then they were compared "
           "with the model before and after, " +
               std::to_string(v.n_folds) + " times over. A trial gets nearer by " + short_number(v.gain.low) + " to " +
               short_number(v.gain.high) + " on average (95 % interval); " + what_is_closed(v)},
          {std::move(table)},
          {held_out_chart(v, applied_to_held_out(outcome))}};
}

/// A statistic's name for a reader who doesn't know the program.
std::string in_plain_words(const std::string& statistic) {
  static const std::map<std::string, std::string> words{{"seconds", "seconds with motion"},
                                                        {"busy_seconds", "motion when people change posture"},
                                                        {"silent_seconds", "motion when silence is expected"},
                                                        {"half_difference", "first half less second half"},
                                                        {"onsets", "how often motion begins"},
                                                        {"longest_run", "longest stretch of motion"},
                                                        {"isolated", "single seconds with motion"},
                                                        {"single_gaps", "gaps of one second"},
                                                        {"double_gaps", "gaps of two seconds"},
                                                        {"longest_gap", "longest silence"},
                                                        {"dispersion", "motion comes in clumps"},
                                                        {"period_power", "motion comes periodically"},
                                                        {"cycle_strength", "motion keeps time with the arms"},
                                                        {"agreement", "motion comes when expected"},
                                                        {"lead_seconds", "motion before the main part"},
                                                        {"tail_seconds", "motion after the main part"},
                                                        {"late_tail_seconds", "motion long after the main part"},
                                                        {"run_variance", "runs differ from one another"},
                                                        {"joint_loss", "motion that two sensors lack at once"},
                                                        {"loss_in_company", "motion lost beside other sensors"},
                                                        {"share_of_time", "how motion spreads over the time"},
                                                        {"together", "motion while another sensor moves"}};
  if (const auto found = words.find(statistic); found != words.end()) return found->second;
  constexpr std::string_view again = "again_after_";
  if (statistic.starts_with(again)) return "motion again " + statistic.substr(again.size()) + " s later";
  std::string text = statistic;
  std::ranges::replace(text, '_', ' ');
  return text;
}

}  // namespace

io::Report plan_page(const PlanResult& result) {
  io::Report report;
  report.title = "What to measure";
  report.finding = sentence(result);
  report.paragraphs = {
      "Everything here comes from simulation, before any measuring: every effect of the catalogue in "
      "many rooms like this one, and what the data would then say. " +
      std::to_string(result.n_datasets) + " datasets that took no part in training were judged."};
  report.paragraphs.insert(report.paragraphs.end(), result.left_out.begin(), result.left_out.end());
  io::Table numbers{
      {"measured", "min", "right effect the likeliest", "bits", "bits more", "95 %", "bits more a minute"}, {}};
  for (const Design& d : result.designs) {
    const bool planned = &d == &result.designs.front();
    numbers.rows.push_back({d.what, short_number(d.minutes), percent(d.right), fixed(d.bits, 2),
                            planned ? "" : fixed(d.more_bits, 2),
                            planned ? "" : fixed(d.more_bits_95.low, 2) + " to " + fixed(d.more_bits_95.high, 2),
                            planned           ? ""
                            : d.minutes > 0.0 ? short_number(d.more_bits / d.minutes)
                                              : "takes no time"});
  }
  report.sections = {{"What to measure next", {}, {}, {gain_chart(result)}},
                     {"The same in numbers", {}, {std::move(numbers)}, {}},
                     {"What would be seen at all", {}, {}, {power_grid(result)}},
                     {"What would be taken for what", {}, {}, {confusion_chart(result)}}};
  return report;
}

std::string to_json(const PlanResult& result) {
  Json designs = Json::array(), power = Json::array();
  for (const Design& d : result.designs) {
    designs.push_back({{"name", d.name},
                       {"what", d.what},
                       {"minutes", d.minutes},
                       {"bits", d.bits},
                       {"right", d.right},
                       {"more_bits", d.more_bits},
                       {"more_bits_95", {d.more_bits_95.low, d.more_bits_95.high}}});
  }
  for (const PlannedPower& one : result.power) {
    power.push_back(
        {{"effect", one.effect}, {"strength", name(one.strength)}, {"seen", one.seen.hits}, {"of", one.seen.of}});
  }
  const Json json{{"pirsim_reconcile_plan", 1},
                  {"sentence", sentence(result)},
                  {"designs", designs},
                  {"power", power},
                  {"hypotheses", result.hypotheses},
                  {"confusion", result.confusion},
                  {"datasets", result.n_datasets},
                  {"notes", result.left_out}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

void write_plan(const std::filesystem::path& folder, const PlanResult& result, const std::string& made_by) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  io::Report page = plan_page(result);
  page.footer = made_by;
  io::write_text_file(folder / "plan.csv", table_of(design_columns, result.designs));
  io::write_text_file(folder / "plan.html", io::to_html(page));
  io::write_text_file(folder / "plan.json", to_json(result));
}

io::GridChart difference_chart(const Location& location, double alpha) {
  io::GridChart chart;
  chart.title = "Measured less expected, seconds with motion";
  chart.note =
      "Orange: more motion was measured than the model expects; blue: less. A frame marks differences that chance and "
      "an inexactly known room don't explain.";
  chart.label = "seconds";
  chart.rows = distinct(location.cells, &LocatedCell::trial);
  chart.columns = distinct(location.cells, &LocatedCell::sensor);
  chart.colours = io::GridChart::Colours::about_zero;
  chart.max = 1.0;
  for (const std::string& trial : chart.rows) {
    for (const std::string& sensor : chart.columns) {
      const auto cell = std::ranges::find_if(
          location.cells, [&](const LocatedCell& c) { return c.trial == trial && c.sensor == sensor; });
      chart.cells.push_back(cell == location.cells.end()
                                ? io::GridChart::Cell{{}, "not measured", {}, io::GridChart::Mark::none}
                                : square(*cell, alpha));
      if (chart.cells.back().value) chart.max = std::max(chart.max, std::abs(*chart.cells.back().value));
    }
  }
  return chart;
}

io::BandChart envelope_chart(const Location& location, double alpha) {
  io::BandChart chart;
  chart.title = "All that was compared";
  chart.note =
      "Each dot is a number taken from the data, of one sensor or of all. The grey band holds what the model gives. "
      "Red dots lie outside: there the model is wrong. Point at a dot to see what it is.";
  chart.low = "less than the model";
  chart.high = "more than the model";
  chart.label = "deviation, in half-widths of the band";
  std::map<std::string, std::size_t> row_of;
  for (const EnvelopeFeature& feature : location.envelope) {
    const auto& [text, statistic, place] = feature.name;
    const std::string subject = in_plain_words(statistic);
    const auto [row, is_new] = row_of.try_emplace(subject, chart.rows.size());
    if (is_new) chart.rows.push_back({subject, {}});
    const bool outside = feature.adjusted_p <= alpha;
    chart.rows[row->second].points.push_back(
        {beside_band(feature),
         (place.empty() ? text : place) + "\n" + subject + "\n" + (outside ? "outside" : "inside") +
             " the band, adjusted p " + short_number(feature.adjusted_p),
         outside ? io::BandChart::Point::Mark::outside : io::BandChart::Point::Mark::inside});
  }
  return chart;
}

io::BarChart ranking_chart(const Outcome& outcome) {
  io::BarChart chart;
  chart.title = "Which effect explains the data best";
  chart.note =
      "Long bars: likelier than the others. That alone decides nothing: only effects that can also make such data by "
      "themselves are kept (coloured).";
  chart.label = "probability among all hypotheses of the catalogue";
  constexpr double worth_drawing = 0.005;
  std::size_t left_out = 0;
  for (const Candidate& candidate : outcome.candidates) {
    const HypothesisScore& score = candidate.score;
    if (!candidate.kept && score.probability < worth_drawing) {
      ++left_out;
      continue;
    }
    chart.bars.push_back({score.hypothesis,
                          score.probability,
                          percent(score.probability) + (candidate.kept ? ", kept" : ""),
                          candidate.kept ? io::BarChart::Weight::strong : io::BarChart::Weight::faint,
                          {},
                          {},
                          in_words(candidate)});
  }
  if (left_out > 0) chart.note += " " + std::to_string(left_out) + " effects below 0.5 % are not drawn.";
  return chart;
}

std::vector<io::DotsChart> posterior_charts(const FittedEffect& fitted, const std::optional<RangeEnd>& end) {
  std::vector<io::DotsChart> charts;
  for (const FittedParameter& p : fitted.parameters) {
    const auto& infos = effects::find(fitted.effect.name).info.parameters;
    const auto info = std::ranges::find(infos, p.name, &effects::ParameterInfo::name);
    if (info == infos.end() || p.equally_likely.empty()) continue;
    io::DotsChart chart;
    chart.title = fitted.effect.name + ": " + p.name;
    const bool stepped = end && end->found && end->effect == fitted.effect.name && end->parameter == p.name;
    chart.note = stepped
                     ? "Each dot is a strength that was tried beyond the range looked for and with which the model can "
                       "have made the data. The shaded range spans them."
                     : "Each dot is as likely as any other to be the truth; in about nine cases of ten the truth lies "
                       "in the shaded range. The axis spans what was thought possible.";
    chart.label = p.unit;
    chart.values = p.equally_likely;
    chart.low = p.interval.low;
    chart.high = p.interval.high;
    chart.axis_low = std::min(info->low, chart.low);
    chart.axis_high = std::max(info->high, chart.high);
    if (info->scale == effects::Scale::logarithmic) {
      chart.scale = io::DotsChart::Scale::logarithmic;
    } else if (p.is_strength) {
      chart.axis_low = std::min(chart.axis_low, p.off);
      chart.axis_high = std::max(chart.axis_high, p.off);
    }
    if (p.is_strength) {
      chart.reference = p.off;
      chart.reference_label = "no effect";
    }
    charts.push_back(std::move(chart));
  }
  return charts;
}

std::string with_interval(const Rate& rate) {
  if (rate.of == 0) return "no case";
  const Interval interval = rate.interval();
  return percent(rate.value()) + " (" + percent(interval.low) + " to " + percent(interval.high) + ", " +
         std::to_string(rate.hits) + " of " + std::to_string(rate.of) + ")";
}

io::GridChart::Cell share_cell(const Rate& rate) {
  io::GridChart::Cell cell;
  cell.hint = with_interval(rate);
  if (rate.of == 0) return cell;
  cell.value = rate.value();
  cell.text = fixed(100.0 * rate.value(), 0);
  return cell;
}

io::GridChart confusion_grid(const std::vector<std::string>& hypotheses, const std::vector<std::vector<double>>& shares,
                             const std::string& title, const std::string& note) {
  constexpr double worth_a_number = 0.05;
  io::GridChart chart;
  chart.title = title;
  chart.note = note;
  chart.label = "share of a row";
  chart.rows = chart.columns = hypotheses;
  for (const std::vector<double>& row : shares) {
    const bool any = std::ranges::any_of(row, [](double share) { return share > 0.0; });
    for (const double share : row) {
      io::GridChart::Cell cell;
      if (any) cell.value = share;
      if (share >= worth_a_number) cell.text = fixed(100.0 * share, 0);
      cell.hint = any ? percent(share) : "no case";
      chart.cells.push_back(std::move(cell));
    }
  }
  return chart;
}

io::Report report_page(const Outcome& outcome, const Watched& watched) {
  const Outcome rows = as_compared(outcome);
  io::Report report;
  report.title = "Model and measurement";
  report.finding = sentence(outcome);
  report.paragraphs = details(outcome);
  report.paragraphs.push_back(next_step(outcome));
  if (!outcome.data_findings.empty()) report.sections.push_back(file_section(outcome.data_findings));
  for (auto& section : {where(rows, watched), envelope(rows.location, rows.alpha), candidates(rows)})
    report.sections.push_back(section);
  if (!rows.fits.empty()) report.sections.push_back(strength(rows));
  if (rows.verification) report.sections.push_back(held_out(rows));
  if (rows.verdict != Verdict::no_disagreement) report.sections.push_back(reasons(rows));
  return report;
}

}  // namespace pirsim::reconcile
