#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "core/text.hpp"
#include "io/files/atomic_file.hpp"
#include "pirsim/csv.hpp"
#include "reconcile/report/pages.hpp"
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
        {what_of(d), d.more_bits, short_number(d.more_bits) + " bits in " + short_number(d.minutes) + " min",
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
  io::GridChart chart = confusion_grid(result.hypotheses, result.confusion);
  chart.title = "What would be hidden (rows), and what it would look like most (columns), % of cases";
  chart.note =
      "Dark squares on the diagonal are right; dark squares beside it are pairs that what is planned can hardly "
      "tell apart.";
  return chart;
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
  for (const LeftOut& left_out : result.left_out) report.paragraphs.push_back(in_words(left_out));
  io::ReportSection gain{"What to measure next", {}, {}, {}};
  gain.charts.emplace_back(gain_chart(result));
  io::ReportSection table{"The same in numbers", {}, {}, {}};
  io::Table numbers{
      {"measured", "min", "right effect the likeliest", "bits", "bits more", "95 %", "bits more a minute"}, {}};
  for (const Design& d : result.designs) {
    const bool planned = &d == &result.designs.front();
    numbers.rows.push_back({what_of(d), short_number(d.minutes), percent(d.right), fixed(d.bits, 2),
                            planned ? "" : fixed(d.more_bits, 2),
                            planned ? "" : fixed(d.more_bits_95.low, 2) + " to " + fixed(d.more_bits_95.high, 2),
                            planned           ? ""
                            : d.minutes > 0.0 ? short_number(d.more_bits / d.minutes)
                                              : "takes no time"});
  }
  table.tables.push_back(std::move(numbers));
  io::ReportSection seen{"What would be seen at all", {}, {}, {}};
  seen.charts.emplace_back(power_grid(result));
  io::ReportSection confused{"What would be taken for what", {}, {}, {}};
  confused.charts.emplace_back(confusion_chart(result));
  report.sections = {std::move(gain), std::move(table), std::move(seen), std::move(confused)};
  return report;
}

std::string to_json(const PlanResult& result) {
  Json designs = Json::array(), power = Json::array();
  for (const Design& d : result.designs) {
    designs.push_back({{"name", name(d)},
                       {"what", what_of(d)},
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
  Json notes = Json::array();
  for (const LeftOut& left_out : result.left_out) notes.push_back(in_words(left_out));
  const Json json{{"pirsim_reconcile_plan", 1},
                  {"sentence", sentence(result)},
                  {"designs", designs},
                  {"power", power},
                  {"hypotheses", result.hypotheses},
                  {"confusion", result.confusion},
                  {"datasets", result.n_datasets},
                  {"notes", notes}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

namespace {

struct DesignLine {
  const Design& design;
  std::string name;
};

constexpr Column<DesignLine> design_lines[]{
    {{"design", Holds::text, "what would be measured"}, [](const DesignLine& line) -> Cell { return line.name; }},
    {{"minutes", Holds::number, "more than what is planned; of the plan itself all of it", "min"},
     [](const DesignLine& line) -> Cell { return line.design.minutes; }},
    {{"bits", Holds::number, "told about which effect it is, mean over datasets"},
     [](const DesignLine& line) -> Cell { return line.design.bits; }},
    {{"right", Holds::number, "share of datasets whose effect is the likeliest"},
     [](const DesignLine& line) -> Cell { return line.design.right; }},
    {{"more_bits", Holds::number, "than what is planned"},
     [](const DesignLine& line) -> Cell { return line.design.more_bits; }},
    {{"more_bits_low", Holds::number, "low end of their 95 % interval"},
     [](const DesignLine& line) -> Cell { return line.design.more_bits_95.low; }},
    {{"more_bits_high", Holds::number, "high end of their 95 % interval"},
     [](const DesignLine& line) -> Cell { return line.design.more_bits_95.high; }},
};

}  // namespace

std::string to_csv(const PlanResult& result) {
  std::ostringstream out;
  io::TableWriter<DesignLine> csv(out, std::span<const Column<DesignLine>>(design_lines));
  for (const Design& design : result.designs) csv.write({design, name(design)});
  return out.str();
}

void write_plan(const std::filesystem::path& folder, const PlanResult& result, const std::string& made_by) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  io::Report page = plan_page(result);
  page.footer = made_by;
  io::write_text_file(folder / "plan.csv", to_csv(result));
  io::write_text_file(folder / "plan.html", io::to_html(page));
  io::write_text_file(folder / "plan.json", to_json(result));
}

}  // namespace pirsim::reconcile
