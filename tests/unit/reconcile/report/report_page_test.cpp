// The page of a reconciliation, from outcomes made by hand.
#include "reconcile/report/pages.hpp"

#include <cmath>

#include "reconcile/report/sentences.hpp"
#include "support/catch.hpp"

using namespace pirsim;
using namespace pirsim::reconcile;

namespace {

FeatureName mean_of(const std::string& statistic) { return {"mean " + statistic, statistic, "all cells, mean"}; }

Location two_cells() {
  Location location;
  location.p = 0.01;
  location.n_simulated = 999;
  location.cells = {{"S1", "PIR1", 30.0, 12.4, 8.0, 17.0, 0.01, 7.0}, {"S1", "PIR2", 3.0, 3.2, 0.0, 6.0, 0.8}};
  location.envelope = {{{"S1 PIR1 seconds", "seconds", "S1 PIR1"}, 2.0, 0.0, -1.0, 0.5, 0.01},
                       {mean_of("longest_gap"), -0.5, 0.0, -1.0, 1.0, 0.9}};
  return location;
}

FittedEffect fitted() {
  FittedEffect fit;
  fit.effect = {"soft_zone_edges", {{"sigma_deg", 0.9}}, {}, {}};
  FittedParameter sigma;
  sigma.name = "sigma_deg";
  sigma.unit = "deg";
  sigma.value = 0.9;
  sigma.interval = {0.7, 1.2};
  sigma.equally_likely = {0.7, 0.8, 0.9, 1.0, 1.2};
  fit.parameters = {sigma};
  return fit;
}

Outcome named() {
  Outcome outcome;
  outcome.verdict = Verdict::named;
  outcome.location = two_cells();
  outcome.candidates = {{{"soft_zone_edges", 0.9, 0.5, 0.6, 1.0},
                         effects::Family::optics,
                         true,
                         {"Kept", "it can have made these data."}},
                        {{"fidgeting", 0.1, 0.01, 0.6, 0.02},
                         effects::Family::motion,
                         false,
                         {"Dropped", "another explains the data better than is usual for its own (p = 0.01)."}}};
  outcome.named = {"soft_zone_edges"};
  outcome.fits = {fitted()};
  outcome.verification.emplace();
  outcome.verification->n_folds = 5;
  outcome.verification->before.energy_score = 4.0;
  outcome.verification->after.energy_score = 1.5;
  outcome.verification->noise_floor = 1.25;
  outcome.verification->placebo = 3.5;
  outcome.verification->placebo_effect = "fidgeting";
  outcome.verification->shrunk = true;
  return outcome;
}

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

}  // namespace

TEST_CASE("differences stand in their cells in seconds and those flagged are framed", "[report]") {
  const io::GridChart chart = difference_chart(two_cells(), 0.05);
  REQUIRE(chart.cells.size() == 2);
  CHECK(*chart.cells[0].value == Approx(17.6));
  CHECK(chart.cells[0].text == "+18");
  CHECK(chart.cells[0].mark == io::GridChart::Mark::framed);
  CHECK(chart.cells[1].text == "0");  // no sign and no minus for what rounds to nothing
  CHECK(chart.cells[1].mark == io::GridChart::Mark::none);
  CHECK(chart.max == Approx(17.6));
}

TEST_CASE("a trial without a sensor's data has an empty square", "[report]") {
  Location location = two_cells();
  location.cells.push_back({"S2", "PIR2", 1.0, 1.0, 0.0, 2.0, 1.0});
  const io::GridChart chart = difference_chart(location, 0.05);
  REQUIRE(chart.cells.size() == 4);
  CHECK_FALSE(chart.cells[2].value);
  CHECK(chart.cells[2].text == "not measured");
}

TEST_CASE("a point is beyond one exactly where its number leaves its envelope", "[report]") {
  const io::BandChart chart = envelope_chart(two_cells(), 0.05);
  REQUIRE(chart.rows.size() == 2);
  CHECK(chart.rows[0].points[0].position == Approx(4.0));  // 2 above the median, where the envelope reaches 0.5 above
  CHECK(chart.rows[0].points[0].mark == io::BandChart::Point::Mark::outside);
  CHECK(chart.rows[1].name == "longest silence");
  CHECK(chart.rows[1].points[0].position == Approx(-0.5));
  CHECK(chart.rows[1].points[0].mark == io::BandChart::Point::Mark::inside);
}

TEST_CASE("an envelope without width lets nothing through but its one value", "[report]") {
  Location location = two_cells();
  location.envelope = {{mean_of("seconds"), 0.0, 0.0, 0.0, 0.0, 1.0}, {mean_of("onsets"), 0.1, 0.0, 0.0, 0.0, 0.01}};
  const io::BandChart chart = envelope_chart(location, 0.05);
  CHECK(chart.rows[0].points[0].position == 0.0);
  CHECK(chart.rows[1].points[0].position > 100.0);
  CHECK(std::isfinite(chart.rows[1].points[0].position));
}

TEST_CASE("parts of the time and pairs of sensors have rows of their own, and each point says whose it is",
          "[report]") {
  Location location;
  for (const auto& [text, statistic] :
       {std::pair("all sensors, part 3 of 18 of the time", "share_of_time"),
        std::pair("PIR1 while PIR2 moves", "together"), std::pair("PIR1, part 3 of 18 of the time", "share_of_time")})
    location.envelope.push_back({{text, statistic}, 0.0, 0.0, -1.0, 1.0, 1.0});
  const io::BandChart chart = envelope_chart(location, 0.05);
  REQUIRE(chart.rows.size() == 2);
  CHECK(chart.rows[0].name == "how motion spreads over the time");
  REQUIRE(chart.rows[0].points.size() == 2);
  CHECK(says(chart.rows[0].points[0].hint, "all sensors, part 3 of 18 of the time\n"));
  CHECK(says(chart.rows[0].points[1].hint, "PIR1, part 3 of 18 of the time\n"));
  CHECK(chart.rows[1].name == "motion while another sensor moves");
  CHECK(says(chart.rows[1].points[0].hint, "PIR1 while PIR2 moves\n"));
}

TEST_CASE("candidates that were kept stand out from the merely probable", "[report]") {
  const io::BarChart chart = ranking_chart(named());
  REQUIRE(chart.bars.size() == 2);
  CHECK(chart.bars[0].weight == io::BarChart::Weight::strong);
  CHECK(chart.bars[1].weight == io::BarChart::Weight::faint);
  CHECK(chart.bars[1].hint == "Dropped: another explains the data better than is usual for its own (p = 0.01).");
}

TEST_CASE("a posterior shows its values on the scale of its prior", "[report]") {
  const auto charts = posterior_charts(fitted());
  REQUIRE(charts.size() == 1);
  CHECK(charts[0].scale == io::DotsChart::Scale::logarithmic);
  CHECK(charts[0].axis_low == Approx(0.2));
  CHECK(charts[0].axis_high == Approx(2.0));
  CHECK(charts[0].values.size() == 5);
  CHECK_THAT(charts[0].note, contains("nine cases of ten"));
  const FittedEffect& fit = fitted();
  RangeEnd end;
  end.effect = fit.effect.name;
  end.parameter = fit.parameters.front().name;
  CHECK_THAT(posterior_charts(fit, end).front().note, contains("nine cases of ten"));  // nothing lies beyond
  end.found = 3.0;
  CHECK_THAT(posterior_charts(fit, end).front().note, contains("beyond the range looked for"));
}

TEST_CASE("the page says the verdict first and shows what each verdict has", "[report]") {
  Outcome outcome = named();
  const std::string page = to_html(report_page(outcome));
  const auto at = [&](const char* what) { return page.find(what); };
  CHECK(at("The measurement shows soft_zone_edges, which the simulation") < at("Where they differ</h2>"));
  for (const char* kind : {"grid", "band", "bars", "dots"}) {
    CHECK(says(page, "<div class=\"charts " + std::string(kind) + "\">"));
  }
  CHECK(says(page, "placebo: with fidgeting instead"));
  outcome = {};
  outcome.location = two_cells();
  const std::string nothing = to_html(report_page(outcome));
  CHECK_FALSE(says(nothing, "<div class=\"charts dots\">"));
  CHECK(says(nothing, "Nothing was looked for"));
}

TEST_CASE("the page names the commands that show the model where a cell is framed", "[report]") {
  Outcome outcome;
  outcome.location = two_cells();
  outcome.location.cells[0].trial = "it's S 8";
  const std::string& sensor = outcome.location.cells[0].sensor;
  const auto page = [&](double alpha, const Watched& watched) {
    outcome.alpha = alpha;
    return io::to_html(report_page(outcome, watched));
  };
  const std::string told =
      page(0.05, {{"--scene", "my room.gltf", "--script", "in/study.yaml", "--set", "people.0.id=a b"}, "working"});
  CHECK_THAT(told, contains("pirsim view --scene 'my room.gltf' --script in/study.yaml --set 'people.0.id=a b' "
                            "--trial 'it'\\''s S 8' -o it_s_S_8.html"));
  CHECK_THAT(told, contains("it_s_S_8.html#phase=working&amp;sensor=" + sensor));
  CHECK_THAT(page(0.05, {{"--scene", "a.gltf"}, ""}), contains("it_s_S_8.html#sensor=" + sensor));
  CHECK_THAT(page(0.0, {{"--scene", "a.gltf"}, ""}), !contains("pirsim view"));
}

TEST_CASE("the page says what held-out trials show and no more", "[report]") {
  Outcome outcome = named();
  const auto page = [&] { return to_html(report_page(outcome)); };
  CHECK(says(page(), "these trials alone are too few to tell even the model as it is"));
  outcome.verification->refused = true;
  outcome.verification->after.p = 0.049;
  outcome.verification->share_closed = 0.9;
  CHECK(says(page(), "the test of everything still finds a difference there (p = 0.049)"));
  CHECK(says(page(), "90 % of what can be closed is closed"));
  outcome.verification->share_closed = -0.2;
  CHECK_FALSE(says(page(), "of what can be closed"));
  CHECK(says(page(), "farther from the model with it than without"));
  outcome.verification->share_closed = 1.05;
  CHECK_FALSE(says(page(), "of what can be closed"));
  CHECK(says(page(), "as near to the model as two of its own runs"));
  outcome.verification->closed = true;
  CHECK(says(page(), "the simulation with soft_zone_edges agrees with the data."));
  outcome.verification->noise_floor = outcome.verification->before.energy_score + 1.0;
  CHECK(says(page(), "was as near to these trials already"));
}

TEST_CASE("an effect that changes the model as another does stands beside it wherever candidates are listed",
          "[report]") {
  Outcome outcome = named();
  outcome.candidates[1].score.hypothesis = "range_scale";
  const std::vector<Candidate> all = with_twins(outcome.candidates);
  REQUIRE(all.size() == 3);
  CHECK(all[2].score.hypothesis == "thermal_contrast");
  CHECK_THAT(in_words(all[2]), contains("Judged as range_scale"));
  CHECK(says(to_html(report_page(outcome)), "thermal_contrast"));
  outcome.candidates[0].score.hypothesis = "thermal_contrast";  // asked for by itself
  CHECK(with_twins(outcome.candidates).size() == 2);
}
