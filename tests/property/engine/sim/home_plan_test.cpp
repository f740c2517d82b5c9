// A household's days in the shipped flat: who is where, against what was drawn.
#include "engine/sim/schedule.hpp"

#include <algorithm>
#include <map>

#include "engine/sim/compiled_study.hpp"
#include "pirsim/look.hpp"
#include "pirsim/study.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"

using namespace pirsim;

namespace {

Model flat() {
  return compile(test::shipped_scene("flat.gltf"), test::shipped_script("flat_week.yaml", {"sensing.response=zones"}));
}

}  // namespace

TEST_CASE("no two of a household have the same place planned for them at one time", "[people]") {
  const Model model = flat();
  for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
    const sim::DayPlan plan = sim::plan_home_day(model.compiled(), run);
    std::map<std::string, std::vector<std::pair<double, double>>> taken;
    for (const std::vector<ScriptedAction>& actions : plan) {
      std::string place;
      double since_s = 0.0;
      for (const ScriptedAction& action : actions) {
        if (!action.at_s) continue;
        if (!place.empty()) taken[place].push_back({since_s, *action.at_s});
        const auto* sit = std::get_if<action::Sit>(&action.what);
        const auto* lie = std::get_if<action::Lie>(&action.what);
        const auto* stand = std::get_if<action::Stand>(&action.what);
        place = sit != nullptr ? sit->seat : lie != nullptr ? lie->place : stand != nullptr ? stand->place : "";
        since_s = *action.at_s;
      }
    }
    for (auto& [place, spells] : taken) {
      std::ranges::sort(spells);
      for (std::size_t i = 1; i < spells.size(); ++i) {
        CAPTURE(run, place, spells[i].first, spells[i - 1].second);
        CHECK(spells[i].first >= spells[i - 1].second - 1.0);  // times are whole seconds
      }
    }
  }
}

TEST_CASE("residents lie in their beds at four, and are where the day has them but for their ways",
          "[people][seconds]") {
  const Model model = flat();
  const std::uint32_t run = 1;
  const sim::HomeDay drawn = sim::draw_home_day(*model.compiled().trial_of(run).schedule->household,
                                                model.compiled().seed(), run, 20514 + run);
  const RunResult result = run_once(model, run);
  REQUIRE(result.samples.size() == 86400);
  CHECK(result.samples.front().people == 2);
  CHECK(result.samples.front().bits == std::vector<std::uint8_t>(6, 0));  // who sleeps since long is no motion
  int right = 0;
  for (std::size_t row = 0; row < result.samples.size(); ++row) {
    const double day_s = sim::home_day_begins_s + static_cast<double>(row + 1);
    int at_home = 0;
    for (const std::vector<sim::HomeStay>& stays : drawn.residents) {
      const auto stay = std::ranges::find_if(stays, [&](const sim::HomeStay& s) { return day_s <= s.to_s; });
      at_home += stay->activity == sim::HomeActivity::away ? 0 : 1;
    }
    for (const sim::Visit& visit : drawn.visits) at_home += visit.comes_s < day_s && day_s <= visit.goes_s ? 1 : 0;
    right += result.samples[row].people == at_home ? 1 : 0;
  }
  // Each of a few ways in and out takes a dozen seconds.
  CHECK(right > 86400 - 300);
}

TEST_CASE("each of a couple gets out of bed at their own side, while the other one sleeps", "[people][seconds]") {
  const Model model = flat();
  const auto over = [](const Model& checked) {
    return std::ranges::count_if(check_study(checked).warnings, [](const Issue& warning) {
      return warning.message.find("gets into 'bed_right' over 'bed_left'") != std::string::npos;
    });
  };
  CHECK(over(model) == 0);
  // Day 1 has somebody up at six, beside somebody who sleeps: whoever goes to the toilet is in the bathroom then.
  const RunResult result = run_once(model, 0, Record::samples, Trace::none, Occupants::told);
  std::map<std::string, int> visits, in_bath;
  std::map<std::string, std::string> doing;
  std::map<std::string, bool> was_there;
  for (const OccupantRow& row : result.occupants) {
    if (row.activity == "toilet" && doing[row.person] != "toilet") ++visits[row.person], was_there[row.person] = false;
    if (row.activity == "toilet" && row.area == "bath" && !was_there[row.person])
      ++in_bath[row.person], was_there[row.person] = true;
    doing[row.person] = row.activity;
  }
  CHECK(visits.size() == 2);
  CHECK(visits == in_bath);
  // A twin: the bedroom's door, open at a right angle, shuts off the bed's far side.
  SceneSpec narrow = test::shipped_scene("flat.gltf");
  std::ranges::find(narrow.doors, "bedroom", &DoorSpec::id)->open_deg = 90.0;
  CHECK(over(compile(std::move(narrow), test::shipped_script("flat_week.yaml", {"sensing.response=zones"}))) == 1);
}

namespace {

constexpr const char* ann_works_at_home = "schedule.household.residents.0.occupation=works_at_home";

/// Seconds that the first of the people is at work by a day's plan, each on a seat for it.
double seconds_at_work(const Model& model, std::uint32_t run) {
  const sim::DayPlan plan = sim::plan_home_day(model.compiled(), run);
  const std::vector<SeatSpec>& seats = model.compiled().scene().seats;
  std::string seat;
  double since_s = 0.0, sum_s = 0.0;
  bool works = false;
  for (const ScriptedAction& action : plan.front()) {
    if (action.at_s) {
      if (works) sum_s += *action.at_s - since_s;
      const auto* sit = std::get_if<action::Sit>(&action.what);
      seat = sit != nullptr ? sit->seat : "";
      since_s = *action.at_s;
      works = false;
    }
    if (!std::holds_alternative<action::Work>(action.what)) continue;
    const auto at = std::ranges::find(seats, seat, &SeatSpec::id);
    works = at != seats.end() && std::ranges::find(at->uses, "work") != at->uses.end();
  }
  return sum_s;
}

bool lacks_place_for_work(const Model& model) {
  return std::ranges::any_of(check_study(model).warnings, [](const Issue& warning) {
    return warning.message.find("no place for working (`for: [work]`") != std::string::npos;
  });
}

}  // namespace

TEST_CASE("who works at home does so on a seat for work, for as long as the day has it", "[people]") {
  const auto compiled = [](SceneSpec scene, const std::vector<std::string>& overrides) {
    return compile(std::move(scene), test::shipped_script("flat_week.yaml", overrides));
  };
  const Model model = compiled(test::shipped_scene("flat.gltf"), {"sensing.response=zones", ann_works_at_home});
  CHECK_FALSE(lacks_place_for_work(model));
  for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
    const sim::HomeDay day = sim::draw_home_day(*model.compiled().trial_of(run).schedule->household,
                                                model.compiled().seed(), run, 20514 + run);
    double drawn_s = 0.0;
    for (const sim::HomeStay& stay : day.residents[0])
      if (stay.activity == sim::HomeActivity::work) drawn_s += stay.to_s - stay.from_s;
    CAPTURE(run, drawn_s);
    CHECK(std::abs(seconds_at_work(model, run) - drawn_s) < 30.0);  // each change is in whole seconds
    CHECK((drawn_s > 0.0) == (run < 5));
    CHECK(seconds_at_work(flat(), run) == 0.0);  // a twin who works elsewhere
  }
  SceneSpec bare = test::shipped_scene("flat.gltf");
  for (SeatSpec& seat : bare.seats) {
    if (std::erase(seat.uses, "work") > 0 && seat.uses.empty()) seat.uses = {"play"};
  }
  CHECK(lacks_place_for_work(compiled(bare, {"sensing.response=zones", ann_works_at_home})));
  CHECK_FALSE(lacks_place_for_work(compiled(bare, {"sensing.response=zones"})));
}
