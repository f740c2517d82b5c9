// A household's days in the shipped flat: who is where, against what was drawn.
#include "engine/sim/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

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

constexpr const char* many_days = "replicates=60";  // so that two want the toilet at once on some

}  // namespace

TEST_CASE("no two of a household have the same place planned for them at one time", "[people]") {
  const Model model = compile(test::shipped_scene("flat.gltf"),
                              test::shipped_script("flat_week.yaml", {"sensing.response=zones", many_days}));
  for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
    const sim::DayPlan plan = sim::plan_home_day(model.compiled(), run);
    std::map<std::string, std::vector<std::pair<double, double>>> taken;
    for (const std::vector<ScriptedAction>& actions : plan) {
      std::string place;
      double since_s = 0.0;
      for (const ScriptedAction& action : actions) {
        if (!action.at_s) {  // back from an errand
          if (const auto* seat = std::get_if<action::Sit>(&action.what)) place = seat->seat;
          continue;
        }
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

/// What a day's plan has people do, and on which seat or place: {"eating", "table_1"}.
std::set<std::pair<std::string, std::string>> deeds_of(const Model& model, std::uint32_t run) {
  std::set<std::pair<std::string, std::string>> deeds;
  for (const std::vector<ScriptedAction>& actions : sim::plan_home_day(model.compiled(), run)) {
    std::string place;
    for (const ScriptedAction& action : actions) {
      if (const auto* sit = std::get_if<action::Sit>(&action.what)) place = sit->seat;
      if (const auto* lie = std::get_if<action::Lie>(&action.what)) place = lie->place;
      if (const auto* stand = std::get_if<action::Stand>(&action.what)) place = stand->place;
      if (std::holds_alternative<action::Walk>(action.what) || std::holds_alternative<action::Enter>(action.what))
        place.clear();
      const bool stays =
          std::holds_alternative<action::Wait>(action.what) || std::holds_alternative<action::Work>(action.what);
      if (stays && !place.empty()) deeds.emplace(action.phase, place);
    }
  }
  return deeds;
}

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
    } else if (const auto* back = std::get_if<action::Sit>(&action.what)) {
      seat = back->seat;  // from an errand, which is part of the work
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

TEST_CASE("with too few chairs residents eat on the sofa, and wait for the toilet", "[people]") {
  SceneSpec scene = test::shipped_scene("flat.gltf");
  std::erase_if(scene.seats,
                [](const SeatSpec& seat) { return seat.id.starts_with("table_") && seat.id != "table_1"; });
  const Model model =
      compile(std::move(scene), test::shipped_script("flat_week.yaml", {"sensing.response=zones", many_days}));
  std::set<std::string> eaten_at, toilets;
  for (std::uint32_t run = 0; run < model.n_runs(); ++run) {
    for (const auto& [what, place] : deeds_of(model, run)) {
      if (what == "eating") eaten_at.insert(place);
      if (what == "toilet") toilets.insert(place);
    }
  }
  CHECK(eaten_at.contains("table_1"));
  CHECK(eaten_at.size() > 1);
  for (const std::string& place : eaten_at) CHECK((place == "table_1" || place.starts_with("sofa")));
  CHECK(toilets == std::set<std::string>{"wc"});
  const auto tells = [](const Issue& warning) {
    return warning.message == "household: 1 place for eating and 2 residents: the others eat where they rest";
  };
  CHECK(std::ranges::any_of(check_study(model).warnings, tells));
  CHECK(std::ranges::none_of(check_study(flat()).warnings, tells));
}

TEST_CASE("nobody works beside another one's bed while there is another place", "[people]") {
  SceneSpec scene = test::shipped_scene("flat.gltf");
  const auto desks = [](const SceneSpec& of) {
    const Model model =
        compile(of, test::shipped_script("flat_week.yaml", {"sensing.response=zones", ann_works_at_home}));
    std::set<std::string> at;
    for (std::uint32_t run = 0; run < model.n_runs(); ++run)
      for (const auto& [what, place] : deeds_of(model, run))
        if (what == "working") at.insert(place);
    return at;
  };
  CHECK(desks(scene) == std::set<std::string>{"desk_chair"});
  PlaceSpec& bed = *std::ranges::find(scene.places, "bed_right", &PlaceSpec::id);
  bed.world_from_place.origin = {7.4, 0.5, -5.6};  // in the study
  CHECK(desks(scene) == std::set<std::string>{"table_1"});
}

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

namespace {

/// Get-ups of a day's plan: of who sat, whatever they go on to. errands: those that interrupt what a day has drawn.
struct GetUps {
  int all = 0, errands = 0;
};
GetUps get_ups(const std::vector<ScriptedAction>& plan) {
  GetUps found;
  bool sits = false;
  for (const ScriptedAction& action : plan) {
    const bool is_seat = std::holds_alternative<action::Sit>(action.what);
    const bool is_walk = std::holds_alternative<action::Walk>(action.what);
    const bool stays =
        std::holds_alternative<action::Wait>(action.what) || std::holds_alternative<action::Work>(action.what);
    if (sits && !stays) ++found.all;
    if (sits && is_walk) ++found.errands;
    if (!stays) sits = is_seat;
  }
  return found;
}

}  // namespace

TEST_CASE("whoever sits at home gets up as often as people with monitors do", "[people]") {
  // A day: 55.0 +- 21.8, n = 727 [Blankenship2021]; 60 +- 22, n = 140 [DallKerr2010]; 71 +- 25, n = 20 [Grant2011].
  // The plan has none of those outdoors: 2.5 h on 85 % of the days, of 15 h that somebody is up.
  constexpr double indoors = 1.0 - 0.85 * 2.5 / 15.0;
  const double least = indoors * (55.0 - 2.0 * 21.8 / std::sqrt(727.0)), most = 71.0 + 2.0 * 25.0 / std::sqrt(20.0);
  std::vector<double> all, drawn;
  for (int seed = 1; seed <= 10; ++seed) {
    const Model model =
        compile(test::shipped_scene("flat.gltf"),
                test::shipped_script("flat_week.yaml", {"sensing.response=zones", "seed=" + std::to_string(seed)}));
    GetUps week;
    for (std::uint32_t run = 0; run < 7; ++run) {
      const GetUps day = get_ups(sim::plan_home_day(model.compiled(), run)[1]);
      week.all += day.all;
      week.errands += day.errands;
    }
    all.push_back(week.all / 7.0);
    drawn.push_back((week.all - week.errands) / 7.0);
  }
  const auto agrees = [&](const std::vector<double>& values) {
    double sum = 0.0, squares = 0.0;
    for (const double value : values) sum += value, squares += value * value;
    const auto n = static_cast<double>(values.size());
    const double error = std::sqrt((squares / n - sum * sum / n / n) / (n - 1.0));
    UNSCOPED_INFO(sum / n << " +- " << error << " a day, published " << least << " to " << most);
    return sum / n > least - 2.0 * error && sum / n < most + 2.0 * error;
  };
  CHECK(agrees(all));
  CHECK_FALSE(agrees(drawn));  // a twin who gets up for what the day has drawn alone
}

TEST_CASE("whoever eats stays at the table for most meals", "[people]") {
  // A meal lasts 25 to 60 min, and in a quarter to a half of them somebody fetches something: an errand in 60 to 240
  // min.
  int errands = 0;
  double eating_s = 0.0;
  for (int seed = 1; seed <= 4; ++seed) {
    const Model model =
        compile(test::shipped_scene("flat.gltf"),
                test::shipped_script("flat_week.yaml", {"sensing.response=zones", "seed=" + std::to_string(seed)}));
    for (std::uint32_t run = 0; run < 7; ++run) {
      for (const std::vector<ScriptedAction>& plan : sim::plan_home_day(model.compiled(), run)) {
        double began_s = -1.0;
        for (const ScriptedAction& action : plan) {
          const bool eats = action.phase == std::string("eating");
          if (action.at_s && !eats && began_s >= 0.0) eating_s += *action.at_s - std::exchange(began_s, -1.0);
          if (action.at_s && eats && began_s < 0.0) began_s = *action.at_s;
          if (eats && action.at_s && std::holds_alternative<action::Walk>(action.what)) ++errands;
        }
      }
    }
  }
  REQUIRE(eating_s > 50.0 * 3600.0);
  INFO(errands << " errands in " << eating_s / 3600.0 << " h");
  CHECK(eating_s / errands > 60.0 * 60.0);
  CHECK(eating_s / errands < 240.0 * 60.0);
}

namespace {

/// Steps of a second of the shipped flat's people from one side of a wall to the other, beside its doorways.
int ways_through_walls(const std::vector<OccupantRow>& rows, double living_door_x_m) {
  constexpr double half_door_m = 0.45;
  constexpr double corner_m = 0.25;  // by which the chord of a second on foot cuts a corner
  std::map<std::string, Vec2> last;
  int found = 0;
  for (const OccupantRow& row : rows) {
    const Vec2 to = row.place_m;
    const auto [known, is_new] = last.try_emplace(row.person, to);
    const Vec2 from = std::exchange(known->second, to);
    const auto crossing = [&](int axis, double at) -> std::optional<double> {
      const double a = from[axis] - at, b = to[axis] - at;
      if (is_new || (a < 0.0) == (b < 0.0) || glm::distance(from, to) > 2.5) return std::nullopt;  // away meanwhile
      return from[1 - axis] + (to[1 - axis] - from[1 - axis]) * a / (a - b);
    };
    const auto through = [&](std::optional<double> at, std::initializer_list<double> doors, double low, double high) {
      return at && *at > low && *at < high &&
             std::ranges::none_of(doors, [&](double door) { return std::abs(*at - door) < half_door_m + corner_m; });
    };
    found += through(crossing(1, -3.4), {living_door_x_m, 7.05}, 0.0, 9.0) ? 1 : 0;
    found += through(crossing(1, -4.6), {1.95, 5.25, 7.65}, 0.0, 9.0) ? 1 : 0;
    found += through(crossing(0, 5.5), {}, -3.4, 0.0) ? 1 : 0;
    found += through(crossing(0, 4.0), {}, -8.0, -4.6) ? 1 : 0;
    found += through(crossing(0, 6.4), {}, -8.0, -4.6) ? 1 : 0;
  }
  return found;
}

}  // namespace

TEST_CASE("residents are about the flat all day, through its doorways alone, on any thread", "[people][seconds]") {
  const Model model = flat();
  const RunResult alone = run_once(model, 5, Record::samples, Trace::none, Occupants::told);
  CHECK(ways_through_walls(alone.occupants, 2.45) == 0);
  CHECK(ways_through_walls(alone.occupants, 1.35) > 5);  // a twin with its doorway elsewhere
  for (const RunIncident& incident : alone.incidents) CHECK(incident.kind != IncidentKind::passed_through);
  StudyOptions options;
  options.threads = 2;
  options.chosen = std::vector<std::uint32_t>{4, 5};
  int alike = 0;
  run_study(model, options, [&](const RunResult& result) { alike += result.samples == alone.samples ? 1 : 0; });
  CHECK(alike == 1);  // the other one is another day
}
