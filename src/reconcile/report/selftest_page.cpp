#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "files/disk/file.hpp"
#include "model/core/text.hpp"
#include "pirsim/csv.hpp"
#include "reconcile/report/pages.hpp"
#include "reconcile/report/sentences.hpp"
#include "stats/intervals.hpp"

namespace pirsim::reconcile {
namespace {

io::Table pair_table(const std::vector<ConfusedPair>& pairs) {
  io::Table table{{"pair", "share", "in the catalogue", "what each does to the data"}, {}};
  const auto does = [](const std::string& effect) {
    return effect + ": " + effects::find(effect).info.fingerprint + ".";
  };
  for (const ConfusedPair& pair : pairs) {
    table.rows.push_back({pair.first + ", " + pair.second, with_interval(pair.rate),
                          pair.expected ? "foreseen" : "not foreseen", does(pair.first) + " " + does(pair.second)});
  }
  return table;
}

io::ReportSection pairs(const SelftestResult& result) {
  const std::string heading = "What can't be told apart, and why";
  const std::vector<ConfusedPair> confused = confused_pairs(result);
  if (confused.empty())
    return {heading, {"No two effects are taken for each other in a tenth of their cases."}, {}, {}};
  return {heading,
          {"These are taken for each other in a tenth of their cases or more. They change the data in similar ways:"},
          {pair_table(confused)},
          {}};
}

/// The shares that a reader asks for first.
std::string finding(const SelftestResult& result) {
  const std::vector<Rate> rates = rates_of(result);
  std::string text =
      "In " + std::to_string(result.cases.size()) + " simulated datasets, with something hidden or nothing: ";
  std::string between;
  for (const char* what : {alarm_on_nothing, disagreement_seen, exact_name, wrong_name}) {
    const Rate& rate = *std::ranges::find(rates, what, &Rate::what);
    if (rate.of == 0) continue;
    text += between + what + " in " + percent(rate.value());
    between = "; ";
  }
  return text + ".";
}

/// How often each effect is seen against its strength, all in one picture.
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

std::string share(const Rate& rate) {
  if (rate.of == 0) return "no case";
  const Interval interval = rate.interval();
  return fixed(rate.value(), 3) + " (" + fixed(interval.low, 3) + "-" + fixed(interval.high, 3) + ", " +
         std::to_string(rate.hits) + " of " + std::to_string(rate.of) + ")";
}

struct CaseLine {
  const InjectedCase& one;
  std::string named, hidden;

  explicit CaseLine(const InjectedCase& of) : one(of), named(joined(of.named, " ")) {
    for (const EffectSpec& effect : one.effects) {
      for (const auto& [parameter, value] : effect.parameters)
        hidden += (hidden.empty() ? "" : " ") + parameter + "=" + io::csv_number(value);
      for (const auto& [choice, value] : effect.choices) hidden += " " + choice + "=" + value;
    }
  }
};

constexpr Column<CaseLine> case_lines[]{
    {{"dataset", Holds::count, "which dataset of those that were injected"},
     [](const CaseLine& line) -> Cell { return static_cast<std::int64_t>(line.one.injected); }},
    {{"kind", Holds::text, "what was hidden"}, [](const CaseLine& line) -> Cell { return name(line.one.kind); }},
    {{"truth", Holds::text, "the effects hidden, or nothing"},
     [](const CaseLine& line) -> Cell { return line.one.truth; }},
    {{"strength", Holds::text, "how strong"}, [](const CaseLine& line) -> Cell { return name(line.one.strength); }},
    {{"verdict", Holds::text, "what the workflow says"},
     [](const CaseLine& line) -> Cell { return name(line.one.verdict); }},
    {{"named", Holds::text, "effects that it names, or can't tell apart"},
     [](const CaseLine& line) -> Cell { return line.named; }},
    {{"family", Holds::text, "that it tells"},
     [](const CaseLine& line) -> Cell { return line.one.family ? Cell(name(*line.one.family)) : Cell(); }},
    {{"likeliest", Holds::text, "effect with the greatest probability"},
     [](const CaseLine& line) -> Cell { return line.one.likeliest; }},
    {{"p", Holds::number, "of the global test"}, [](const CaseLine& line) -> Cell { return line.one.p; }},
    {{"parameters", Holds::count, "fitted, if the right effect was named"},
     [](const CaseLine& line) -> Cell { return static_cast<std::int64_t>(line.one.n_parameters); }},
    {{"covered", Holds::count, "of them, whose interval holds the truth"},
     [](const CaseLine& line) -> Cell { return static_cast<std::int64_t>(line.one.n_covered); }},
    {{"hidden", Holds::text, "parameters of what was hidden"},
     [](const CaseLine& line) -> Cell { return line.hidden; }},
};

/// How often the likeliest hypothesis was right, against the probability that it was given.
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

/// Effect by effect: how often the 90 % intervals hold the truth.
io::BarChart coverage_chart(const SelftestResult& result) {
  io::BarChart chart;
  chart.title = "How often the 90 % intervals hold the true parameter";
  chart.note =
      "Should be near 90 %. Lines show what chance leaves open (95 %); effects without a fitted case are left "
      "out.";
  chart.label = "share of parameters covered";
  for (const std::string& hypothesis : result.hypotheses) {
    Rate rate;
    for (const InjectedCase& c : result.cases) {
      if (c.kind != CaseKind::one || c.truth != hypothesis) continue;
      rate.hits += c.n_covered;
      rate.of += c.n_parameters;
    }
    if (rate.of == 0) continue;
    const Interval interval = rate.interval();
    chart.bars.push_back({hypothesis, rate.value(), percent(rate.value()) + " of " + std::to_string(rate.of),
                          io::BarChart::Weight::plain, interval.low, interval.high, with_interval(rate)});
  }
  return chart;
}

std::string calibration_error(const SelftestResult& result) {
  return result.reliability.bins.empty() ? "no case" : fixed(result.reliability.expected_calibration_error, 3);
}

}  // namespace

io::GridChart confusion_chart(const SelftestResult& result) {
  return confusion_grid(result.hypotheses, confusion_of(result),
                        "What was hidden (rows), and what it looked like most (columns)",
                        "Dark squares on the diagonal are right; dark squares beside it are two effects that "
                        "look alike. Cases of an effect without a disagreement are left out.");
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
    const Interval interval = rates[i].interval();
    chart.lines[i % 2].points.push_back(
        {strength + beside, rates[i].value(), interval.low, interval.high,
         chart.x_names[i / 2] + (i % 2 == 0 ? ": seen" : ": seen and in the set") + ": " + with_interval(rates[i])});
  }
  return chart;
}

io::Report selftest_page(const SelftestResult& result) {
  io::Report report;
  report.title = "Does reconciliation find what is hidden?";
  report.finding = finding(result);
  io::Table rates{{"how often", "share (95 % interval)"}, {}};
  for (const Rate& rate : rates_of(result)) rates.rows.push_back({rate.what, with_interval(rate)});
  io::ReportSection calibration{"Can probabilities and intervals be trusted",
                                {"Mean distance between probability and share: " + calibration_error(result) + "."},
                                {},
                                {reliability_chart(result)}};
  if (io::BarChart chart = coverage_chart(result); !chart.bars.empty())
    calibration.charts.emplace_back(std::move(chart));
  report.sections = {{"What is taken for what", {}, {}, {confusion_chart(result)}},
                     pairs(result),
                     power(result),
                     std::move(calibration),
                     {"All rates", {}, {std::move(rates)}, {}}};
  return report;
}

void write_selftest(const std::filesystem::path& folder, const SelftestResult& result, const std::string& made_by) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  io::write_text_file(folder / "selftest.csv", table_of(case_lines, result.cases));
  io::write_text_file(folder / "selftest.md", to_markdown(result));
  io::Report page = selftest_page(result);
  page.footer = made_by;
  io::write_text_file(folder / "selftest.html", io::to_html(page));
}

// Plans and what a self-test counts in words, and a self-test as text.

std::string sentence(const PlanResult& result) {
  const Design& planned = result.designs.front();
  const std::string now = "what is planned makes the right effect the likeliest in " + percent(planned.right) +
                          " of cases (" + short_number(planned.bits) + " bits)";
  const Design* best = result.best();
  if (best == nullptr) return "None of the further measurements tried is shown to help: " + now + ".";
  return "The best next measurement is " + best->what + " (" + short_number(best->minutes) + " min more): " + now +
         ", with it " + percent(best->right) + " (" + short_number(best->more_bits) + " bits more, 95 % interval " +
         short_number(best->more_bits_95.low) + " to " + short_number(best->more_bits_95.high) + ").";
}

std::string to_markdown(const SelftestResult& result) {
  std::ostringstream out;
  out << "| how often | share (95 % interval) |\n|---|---|\n";
  for (const Rate& rate : rates_of(result)) out << "| " << rate.what << " | " << share(rate) << " |\n";
  out << "| calibration error of the probabilities | " << calibration_error(result) << " |\n\n| effect |";
  for (const char* strength : {"weak", "medium", "strong"}) out << ' ' << strength << ": seen | and in the set |";
  out << "\n|---|---|---|---|---|---|---|\n";
  for (std::size_t hypothesis = 1; hypothesis < result.hypotheses.size(); ++hypothesis) {
    out << "| " << result.hypotheses[hypothesis] << " |";
    for (const Rate& rate : power_of(result, result.hypotheses[hypothesis])) {
      out << ' ' << (rate.of == 0 ? "no case" : fixed(rate.value(), 2)) << " |";
    }
    out << '\n';
  }
  out << "\nConfusion: of the cases with a disagreement (of nothing: of all), the share in which the column's "
         "hypothesis is "
         "the likeliest; less than 0.05 left out.\n\n| hidden | taken for |\n|---|---|\n";
  const auto confusion = confusion_of(result);
  for (std::size_t row = 0; row < confusion.size(); ++row) {
    out << "| " << result.hypotheses[row] << " |";
    std::string list;
    for (std::size_t column = 0; column < confusion.size(); ++column) {
      if (confusion[row][column] < 0.05) continue;
      list += (list.empty() ? " " : ", ") + result.hypotheses[column] + " " + fixed(confusion[row][column], 2);
    }
    out << list << " |\n";
  }
  return out.str();
}

}  // namespace pirsim::reconcile
