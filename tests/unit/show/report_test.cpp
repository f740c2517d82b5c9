#include "show/report.hpp"

#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::io;

namespace {

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++n;
  return n;
}

MapChart small_map() {
  MapChart chart;
  chart.title = "it's";
  chart.columns = 2;
  chart.rows = 1;
  chart.spacing_m = 0.5;
  chart.values = {3.0, std::nullopt};
  chart.max = 60;
  chart.plan.outline = {{{0, 0}, {1, 0}, {1, 0.5}}};
  return chart;
}

}  // namespace

TEST_CASE("names from files can't become markup or end a script", "[report]") {
  Report empty;
  const std::size_t scripts = count(to_html(empty), "</script>");
  Report report;
  const std::string evil = "</script><script>alert(1)</script><b>&\"";
  report.title = report.footer = evil;
  report.paragraphs = {evil};
  HistogramChart histogram{evil, evil, evil, evil, {{1, 1}, {2, 3}}, {}};
  report.sections = {{evil, {evil}, {{{evil}, {{evil}}}}, {histogram}}};
  const std::string html = to_html(report);
  CHECK(count(html, "</script>") == scripts);
  CHECK(count(html, "<b>") == 0);
  CHECK(count(html, "&lt;b&gt;&amp;&quot;") >= 5);
}

TEST_CASE("a page carries Vega with it and points nowhere else", "[report]") {
  const std::string html = to_html({});
  CHECK(html.size() > 400000);
  CHECK(count(html, "src=\"http") == 0);
  CHECK(count(html, "<link") == 1);  // the empty icon, so that browsers don't ask for one
}

TEST_CASE("maps go into the page as numbers, holes as null", "[report]") {
  Report report;
  report.sections = {{"maps", {}, {}, {small_map()}}};
  CHECK(count(to_html(report), "\"values\":[3,null]") == 1);
}

TEST_CASE("a grid goes into the page square by square with its colours", "[report]") {
  GridChart chart;
  chart.rows = {"S1"};
  chart.columns = {"PIR1", "PIR2"};
  chart.colours = GridChart::Colours::about_zero;
  chart.max = 9;
  chart.cells = {{-9.0, "-9", "measured 0 s", GridChart::Mark::framed},
                 {{}, "not measured", "", GridChart::Mark::none}};
  Report report;
  report.sections = {{"grid", {}, {}, {chart}}};
  const std::string html = to_html(report);
  CHECK(count(html, "<div class=\"charts grid\">") == 1);
  CHECK(count(html, R"({"v":-9,"text":"-9","hint":"measured 0 s","framed":true})") == 1);
  CHECK(count(html, R"({"v":null,"text":"not measured","hint":"","framed":false})") == 1);
  CHECK(count(html, R"("colours":"about_zero","max":9)") == 1);
}

TEST_CASE("a finding is set off below the title and long cells are prose", "[report]") {
  Report report;
  report.finding = "a < b";
  report.sections = {{"t", {}, {{{"n", "why"}, {{"1", std::string(31, 'x')}, {"2", "y"}}}}, {}}};
  const std::string html = to_html(report);
  CHECK(count(html, "<p class=\"lead\">a &lt; b</p>") == 1);
  CHECK(count(html, "<td class=\"words\">") == 2);
  CHECK(count(html, "<th scope=\"col\" class=\"words\">why") == 1);
}

TEST_CASE("only a long room's map stands in a row of its own", "[report]") {
  MapChart usual = small_map(), wide = small_map();
  wide.columns = 3;
  wide.values.emplace_back();
  Report report;
  report.sections = {{"maps", {}, {}, {usual, wide}}};
  const std::string html = to_html(report);
  CHECK(count(html, "<div class=\"charts map\">") == 1);
  CHECK(count(html, "<div class=\"charts map wide\">") == 1);
}

TEST_CASE("ranges and clocks go into the page as they were given", "[report]") {
  DotsChart dots;
  dots.values = {1.0};
  dots.low = 0.5;
  dots.high = 2.0;
  LineChart hours;
  hours.x_ticks = LineChart::Ticks::clock;
  hours.lines = {{"S1", {{8.0, 1.0, 0.0, 3.0}}}};
  Report report;
  report.sections = {{"ranges", {}, {}, {dots, hours, LineChart{}}}};
  const std::string html = to_html(report);
  CHECK(count(html, R"("low":0.5,"high":2.0,)") == 1);
  CHECK(count(html, R"({"line":"S1","x":8.0,"y":1.0,"low":0,"high":3,)") == 1);
  CHECK(count(html, R"("clock":true)") == 1);
}
