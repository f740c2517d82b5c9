#include "reconcile/report/pages.hpp"

#include <algorithm>

#include "core/text.hpp"
#include "io/files/atomic_file.hpp"
#include "reconcile/report/sentences.hpp"
#include "stats/intervals.hpp"

namespace pirsim::reconcile {
namespace {

io::Table rate_table(const SelftestResult& result) {
  io::Table table{{"how often", "share (95 % interval)"}, {}};
  for (const Rate& rate : rates_of(result))
    table.rows.push_back({std::string(in_words(rate.what)), with_interval(rate)});
  return table;
}

io::Table pair_table(const std::vector<ConfusedPair>& pairs) {
  io::Table table{{"pair", "share", "in the catalogue", "what each does to the data"}, {}};
  for (const ConfusedPair& pair : pairs) {
    table.rows.push_back({pair.first + ", " + pair.second, with_interval(pair.rate),
                          pair.expected ? "foreseen" : "not foreseen",
                          pair.first + ": " + pair.first_does + ". " + pair.second + ": " + pair.second_does + "."});
  }
  return table;
}

io::ReportSection confusion(const SelftestResult& result) {
  io::ReportSection section{"What is taken for what", {}, {}, {}};
  section.charts.emplace_back(confusion_chart(result));
  return section;
}

io::ReportSection pairs(const SelftestResult& result) {
  io::ReportSection section{"What can't be told apart, and why", {}, {}, {}};
  const std::vector<ConfusedPair> confused = confused_pairs(result);
  section.paragraphs.push_back(confused.empty()
                                   ? "No two effects are taken for each other in a tenth of their cases."
                                   : "These are taken for each other in a tenth of their cases or more. They "
                                     "change the data in similar ways:");
  if (!confused.empty()) section.tables.push_back(pair_table(confused));
  return section;
}

/// The shares that a reader asks for first.
std::string finding(const SelftestResult& result) {
  const std::vector<Rate> rates = rates_of(result);
  std::string text =
      "In " + std::to_string(result.cases.size()) + " simulated datasets, with something hidden or nothing: ";
  std::string between;
  for (const Counted what : {Counted::alarm_on_nothing, Counted::seen, Counted::exact_name, Counted::wrong_name}) {
    const Rate& rate = *std::ranges::find(rates, what, &Rate::what);
    if (rate.of == 0) continue;
    text += between + std::string(in_words(what)) + " in " + percent(rate.value());
    between = "; ";
  }
  return text + ".";
}

io::ReportSection power(const SelftestResult& result) {
  io::ReportSection section{"How strong an effect must be", {}, {}, {}};
  section.paragraphs = {
      "First all effects, then a picture for each. Blue: how often a disagreement was seen at all; red: how often the "
      "effect was then "
      "among those kept. Lines show what chance leaves open (95 %)."};
  section.charts.emplace_back(power_grid(result));
  for (std::size_t hypothesis = 1; hypothesis < result.hypotheses.size(); ++hypothesis) {
    section.charts.emplace_back(power_chart(result, result.hypotheses[hypothesis]));
  }
  return section;
}

std::string strength_and(const Rate& rate) {
  return std::string(name(rate.strength)) + (rate.what == Counted::seen ? ": seen" : ": seen and in the set");
}

}  // namespace

io::GridChart confusion_chart(const SelftestResult& result) {
  io::GridChart chart = confusion_grid(result.hypotheses, confusion_of(result));
  chart.title = "What was hidden (rows), and what it looked like most (columns)";
  chart.note =
      "Dark squares on the diagonal are right; dark squares beside it are two effects that look alike. Cases of an "
      "effect without a disagreement are left out.";
  return chart;
}

io::LineChart power_chart(const SelftestResult& result, const std::string& effect) {
  io::LineChart chart;
  chart.title = effect;
  chart.x_names = {"weak", "medium", "strong"};
  chart.x_low = 0.8;
  chart.x_high = 3.2;
  chart.y_label = "share";
  chart.lines = {{"seen", {}}, {"in the set", {}}};
  const std::vector<Rate> rates = power_of(result, effect);
  for (std::size_t i = 0; i < rates.size(); ++i) {
    if (rates[i].of == 0) continue;
    const auto strength = static_cast<double>(1 + i / 2);
    const double beside = i % 2 == 0 ? -0.02 : 0.02;  // so that the ranges don't cover each other
    chart.lines[i % 2].points.push_back({strength + beside, rates[i].value(), rates[i].interval.low,
                                         rates[i].interval.high,
                                         strength_and(rates[i]) + ": " + with_interval(rates[i])});
  }
  return chart;
}

io::GridChart power_grid(const SelftestResult& result) {
  io::GridChart chart;
  chart.title = "How often a disagreement is seen, by strength of the effect";
  chart.label = "share seen";
  chart.columns = {"weak", "medium", "strong"};
  for (std::size_t hypothesis = 1; hypothesis < result.hypotheses.size(); ++hypothesis) {
    chart.rows.push_back(result.hypotheses[hypothesis]);
    const std::vector<Rate> rates = power_of(result, result.hypotheses[hypothesis]);
    for (std::size_t i = 0; i < rates.size(); i += 2) chart.cells.push_back(share_cell(rates[i]));
  }
  return chart;
}

io::LineChart reliability_chart(const SelftestResult& result) {
  io::LineChart chart;
  chart.title = "Do the probabilities mean what they say";
  chart.note =
      "On the dashed line, what is called 70 % likely is right in 70 % of cases; below it, the program is too "
      "sure of itself.";
  chart.x_label = "probability of the likeliest hypothesis";
  chart.y_label = "share in which it was right";
  chart.guide = io::LineChart::Guide::diagonal;
  chart.lines = {{"likeliest hypothesis", {}}};
  for (const stats::ReliabilityBin& bin : result.reliability.bins) {
    if (bin.rows == 0) continue;
    const auto hits = static_cast<std::size_t>(bin.share_right * static_cast<double>(bin.rows) + 0.5);
    const Interval interval = stats::clopper_pearson(hits, bin.rows);
    chart.lines[0].points.push_back({bin.mean_probability, bin.share_right, interval.low, interval.high,
                                     "called " + percent(bin.mean_probability) + ", right in " + std::to_string(hits) +
                                         " of " + std::to_string(bin.rows)});
  }
  return chart;
}

io::BarChart coverage_chart(const SelftestResult& result) {
  io::BarChart chart;
  chart.title = "How often the 90 % intervals hold the true parameter";
  chart.note =
      "Should be near 90 %. Lines show what chance leaves open (95 %); effects without a fitted case are left "
      "out.";
  chart.label = "share of parameters covered";
  for (const std::string& hypothesis : result.hypotheses) {
    std::size_t hits = 0, of = 0;
    for (const InjectedCase& c : result.cases) {
      if (c.kind != CaseKind::one || c.truth != hypothesis) continue;
      hits += c.n_covered;
      of += c.n_parameters;
    }
    if (of == 0) continue;
    const Rate rate{Counted::parameters_covered, hits, of, stats::clopper_pearson(hits, of), Strength::none};
    chart.bars.push_back({hypothesis, rate.value(), percent(rate.value()) + " of " + std::to_string(of),
                          io::BarChart::Weight::plain, rate.interval.low, rate.interval.high, with_interval(rate)});
  }
  return chart;
}

io::Report selftest_page(const SelftestResult& result) {
  io::Report report;
  report.title = "Does reconciliation find what is hidden?";
  report.finding = finding(result);
  report.sections = {confusion(result), pairs(result), power(result)};
  io::ReportSection calibration{"Can probabilities and intervals be trusted", {}, {}, {}};
  calibration.paragraphs = {"Mean distance between probability and share: " + calibration_error(result) + "."};
  calibration.charts.emplace_back(reliability_chart(result));
  if (io::BarChart chart = coverage_chart(result); !chart.bars.empty())
    calibration.charts.emplace_back(std::move(chart));
  report.sections.push_back(std::move(calibration));
  report.sections.push_back({"All rates", {}, {rate_table(result)}, {}});
  return report;
}

void write_selftest(const std::filesystem::path& folder, const SelftestResult& result, const std::string& made_by) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  io::write_text_file(folder / "selftest.csv", to_csv(result));
  io::write_text_file(folder / "selftest.md", to_markdown(result));
  io::Report page = selftest_page(result);
  page.footer = made_by;
  io::write_text_file(folder / "selftest.html", io::to_html(page));
}

}  // namespace pirsim::reconcile
