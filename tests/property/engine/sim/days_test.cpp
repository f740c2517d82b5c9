// Days of a schedule in a room: empty hours that aren't ticked, clock times, the same bytes however they are run.
#include <algorithm>
#include <set>

#include "engine/sim/compiled_study.hpp"
#include "engine/sim/schedule.hpp"
#include "pirsim/state.hpp"
#include "support/catch.hpp"
#include "support/shipped.hpp"
#include "surveys/check_study.hpp"
#include "surveys/picture.hpp"
#include "surveys/study_report.hpp"

using namespace pirsim;
using namespace pirsim::test;

namespace {

/// Sensors answer by hard zones, which cost least, unless `more` says how they do.
ScriptSpec days_of(const std::string& schedule, const std::string& more = "") {
  ScriptSpec script = io::parse_script("pirsim_script: 1\n" + more + "schedule:\n" + schedule, "s.yaml");
  if (!script.sensing.response) script.sensing.response = Response::zones;
  return script;
}

Model day_model(const std::string& schedule, const std::string& more = "",
                const std::string& room = "meeting_room.gltf") {
  return compile(shipped_scene(room), days_of(schedule, more));
}

/// Every tick, whether there is anybody or not.
std::vector<Sample> ticked(const Model& model, std::uint32_t run) {
  std::vector<Sample> samples;
  State state(model, run);
  while (!state.finished()) {
    if (step_tick(model, state)) samples.push_back(state.sample());
  }
  return samples;
}

/// Two meet for two minutes; before and after there is nobody.
const std::string short_meeting =
    "  from: 09:50\n  to: 10:15\n  meetings: {held: [{at: 10:00, duration_min: 2, people: 2}], lateness_min: 0}\n";

}  // namespace

TEST_CASE("Empty hours that are passed over leave every bit as if they had been ticked", "[seconds]") {
  const std::vector<std::string> variants{
      "",
      "sensing: {reader: free_running}\n",
      "sensing: {response: analog, analog_rays_per_zone: 4}\n",
      "effects: [soft_zone_edges]\n",
      "effects: [dual_polarity]\n",
      "effects: [{false_triggers: {rate_per_s: 0.05}}, pulse_stretching, {trigger_bursts: {length_s: 5}}]\n",
      "effects: [warm_chair, missed_triggers, clock_lag, dead_time, dead_sensor]\n",
      "effects: [warm_chair, {clock_lag: {lag_s: -7.3, drift_percent: -0.5}}, dead_time]\n"};
  for (const std::string& more : variants) {
    INFO(more);
    const Model model = day_model(short_meeting, more);
    const std::vector<Sample> expected = ticked(model, 0);
    CHECK(run_once(model, 0).samples == expected);
    std::vector<Sample> stepped;
    State state(model, 0);
    while (step(model, state)) stepped.push_back(state.sample());
    CHECK(stepped == expected);
    CHECK(std::ranges::any_of(expected, [](const Sample& row) { return row.people == 2; }));
    const auto n_empty = std::ranges::count(expected, 0, &Sample::people);
    CHECK(n_empty > 1000);
    if (more.find("false_triggers") == std::string::npos) continue;
    CHECK(std::ranges::any_of(expected, [](const Sample& row) {
      return row.people == 0 && std::ranges::any_of(row.bits, [](auto bit) { return bit != 0; });
    }));
  }
}

TEST_CASE("A script with pauses is passed over in the same way") {
  const Model model =
      compile(shipped_scene("meeting_room.gltf"),
              io::parse_script(
                  "pirsim_script: 1\nduration_s: 300\npeople:\n  - id: a\n    actions: [{wait_s: 60.4, phase: early},"
                  " {enter: door}, {leave: door}, {wait_s: 30}, {enter: door, at_s: 150.02}, {leave: door}]\n",
                  "s.yaml"));
  CHECK(run_once(model, 0).samples == ticked(model, 0));
}

TEST_CASE("Rows tell the time of day, and what the room is used for") {
  const Model model = day_model(short_meeting);
  CHECK(model.columns()[3] == "time");
  const std::vector<Sample> rows = run_once(model, 0).samples;
  REQUIRE(rows.size() == 25 * 60);
  CHECK(rows.front().clock == "2026-03-02T09:50:01");
  CHECK(rows.back().clock == "2026-03-02T10:15:00");
  std::set<std::string> phases;
  for (const Sample& row : rows) {
    phases.insert(row.phase);
    CHECK((row.phase == "empty") == (row.people == 0));
  }
  CHECK(phases == std::set<std::string>{"empty", "meeting", "occupied"});
  for (const std::string to : {"09:01", "09:05", "09:07", "09:40"}) {
    const Model part = day_model("  from: 09:00\n  to: " + to + "\n  cleaning: 19:00\n");
    CHECK(run_once(part, 0).samples.back().clock == "2026-03-02T" + to + ":00");
  }
  const Model midnight = day_model("  from: 23:59\n  to: 24:00\n  meetings: {}\n");
  CHECK(run_once(midnight, 0).samples.back().clock == "2026-03-03T00:00:00");
}

TEST_CASE("Days are the same for any threads and in any part of the study") {
  const Model model = day_model(
      "  from: 09:58\n  to: 10:06\n  meetings: {held: [{at: 10:00, duration_min: 4, people: 3}]}\n", "replicates: 3\n");
  const auto rows_of = [&](StudyOptions options) {
    std::vector<std::vector<Sample>> rows;
    run_study(model, options, [&](const RunResult& result) { rows.push_back(result.samples); });
    return rows;
  };
  const auto one = rows_of({.threads = 1});
  CHECK(rows_of({.threads = 3}) == one);
  CHECK(rows_of({.runs = RunRange{1, 2}}).front() == one[1]);
  CHECK(one[0] != one[1]);
  CHECK(one[1].front().clock == "2026-03-03T09:58:01");
}

TEST_CASE("All come at once through one door") {
  const Model model =
      day_model("  from: 08:59\n  to: 09:04\n  staff: [{count: 8}]\n  arrival: {mean: 09:00, sd_min: 0}\n");
  const RunResult result = run_once(model, 0);
  CHECK(!result.fault);
  CHECK(result.samples.back().people == 8);
}

TEST_CASE("Who is there when the part of a day begins comes in first") {
  const Model model = day_model("  from: 10:00\n  to: 10:05\n  staff: [{count: 3}]\n", "", "open_office.gltf");
  const studies::ScheduleOutlook expected = studies::outlook(model.compiled());
  CHECK(expected.staff.size() == 3);
  CHECK(expected.working_days == 1U);
  CHECK((expected.most_at_once >= 1 && expected.most_at_once <= 3));
  CHECK(expected.seats == std::vector<std::string>{"S1", "S2", "S3"});
  const RunResult result = run_once(model, 0, Record::samples, Trace::none, Occupants::told);
  CHECK(!result.fault);
  std::set<std::string> seen;
  for (const OccupantRow& row : result.occupants) seen.insert(row.person);
  CHECK(!seen.empty());
  for (const Sample& row : result.samples) {
    const auto there = std::ranges::count_if(result.occupants, [&](const OccupantRow& other) {
      return other.time_s == row.time_s && other.where == OccupantRow::Where::inside;
    });
    CHECK(there == row.people);
  }
}

TEST_CASE("A day's page shows the room that people were in: the mirrored one if the study is mirrored") {
  const Model model = day_model(short_meeting, "effects: [{mirrored_room: {across: z}}]\n");
  studies::DayReport report(model);
  report.add_run(run_once(model, 0, Record::samples, Trace::none, Occupants::told));
  const io::ReportSection section = report.section("");
  const auto is_map = [](const io::Chart& chart) { return std::holds_alternative<io::MapChart>(chart); };
  const auto chart = std::ranges::find_if(section.charts, is_map);
  REQUIRE(chart != section.charts.end());
  const std::vector<io::RoomPlan::Door> doors = std::get<io::MapChart>(*chart).plan.doors;
  REQUIRE(doors.size() == 1);
  CHECK(doors[0].from == studies::plan_of(model.compiled().scene()).doors[0].from);
  CHECK(doors[0].from != studies::plan_of(model.scene()).doors[0].from);
  const std::vector<io::MapChart::Marker>& sensors = std::get<io::MapChart>(*chart).markers;
  REQUIRE(sensors.size() == model.scene().sensors.size());
  for (std::size_t i = 0; i < sensors.size(); ++i)
    CHECK(sensors[i].point == floor_point(model.compiled().scene().sensors[i].world_from_sensor.origin));
}

TEST_CASE("Motion is told by the number of people in the area that a sensor watches") {
  const Model model = compile(shipped_scene("two_rooms.gltf"), shipped_script("two_rooms.yaml"));
  const RunResult result = run_once(model, 0, Record::samples, Trace::none, Occupants::told);
  studies::DayReport report(model);
  report.add_run(result);
  const io::ReportSection section = report.section("");
  const auto is_grid = [](const io::Chart& chart) { return std::holds_alternative<io::GridChart>(chart); };
  const io::GridChart& chart = std::get<io::GridChart>(*std::ranges::find_if(section.charts, is_grid));
  REQUIRE(chart.rows == std::vector<std::string>{"PIR1", "PIR2"});  // of the living room, of the bedroom
  int n_others = 0;
  for (std::size_t sensor = 0; sensor < 2; ++sensor) {
    for (std::size_t people = 0; people < chart.columns.size(); ++people) {
      double rows = 0.0, moved = 0.0, rows_of_all = 0.0;
      for (const Sample& row : result.samples) {
        rows_of_all += static_cast<std::size_t>(row.people) == people ? 1.0 : 0.0;
        if (static_cast<std::size_t>(row.people_of_areas[sensor]) != people) continue;
        rows += 1.0;
        moved += row.bits[sensor];
      }
      const io::GridChart::Cell& cell = chart.cells[sensor * chart.columns.size() + people];
      CAPTURE(sensor, people);
      REQUIRE(cell.value.has_value() == (rows > 0.0));
      if (cell.value) CHECK(*cell.value == Approx(100.0 * moved / rows));
      n_others += rows != rows_of_all ? 1 : 0;
    }
  }
  CHECK(n_others > 2);  // people of the whole floor would tell otherwise
}

TEST_CASE("A wait's label ends with the wait, also where empty seconds are passed over") {
  ScriptSpec script = script_of({person("anna", {act(action::Wait{5.0}), act_at(15.0, action::Enter{"door"})})});
  script.trials.front().people.front().actions.front().phase = "early";
  script.trials.front().duration_s = 20.0;
  const Model model = compile(shipped_scene("meeting_room.gltf"), script);
  const std::vector<Sample> rows = run_once(model, 0).samples;
  CHECK(rows == ticked(model, 0));
  CHECK(std::ranges::count(rows, "early", &Sample::phase) == 5);
}

TEST_CASE("A thing that an effect adds is nobody, and nobody's day is another for it", "[seconds]") {
  const std::string schedule =
      "  from: 08:30\n  to: 13:00\n  staff: [{count: 3}]\n  arrival: {mean: 09:00}\n  cleaning: 08:35\n"
      "  meetings: {held: [{at: 10:00, duration_min: 20, people: 2}]}\n";
  const Model alone = day_model(schedule, "", "open_office.gltf"),
              beside = day_model(schedule, "effects: [{warm_object: {present: 1}}]\n", "open_office.gltf");
  const sim::DayPlan expected = sim::draw_day(alone.compiled(), 0), planned = sim::draw_day(beside.compiled(), 0);
  REQUIRE(planned.size() == expected.size() + 1);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(std::ranges::equal(expected[i], planned[i], [](const ScriptedAction& a, const ScriptedAction& b) {
      return a.at_s == b.at_s && a.phase == b.phase && a.what.index() == b.what.index();
    }));
  }
  std::set<std::string> phases;
  bool empty_means_nobody = true;
  for (const Sample& row : run_once(beside, 0).samples) {
    phases.insert(row.phase);
    empty_means_nobody = empty_means_nobody && (row.people == 0) == (row.phase == "empty");
  }
  CHECK(empty_means_nobody);
  CHECK(phases == std::set<std::string>{"cleaning", "empty", "meeting", "occupied"});
}

TEST_CASE("People of another schedule aren't shared between studies") {
  const auto arriving = [&](const std::string& at) {
    return "  from: 08:00\n  to: 10:00\n  staff: [{count: 1}]\n  arrival: {mean: " + at + ", sd_min: 0}\n";
  };
  const Model early = day_model(arriving("08:30"));
  const ScriptSpec later = days_of(arriving("09:30"));
  CompileOptions like;
  like.like = &early;
  const Model alone = compile(shipped_scene("meeting_room.gltf"), later),
              shared = compile(shipped_scene("meeting_room.gltf"), later, like);
  CHECK(run_once(shared, 0).samples == run_once(alone, 0).samples);
  CHECK_FALSE(run_once(early, 0).samples == run_once(alone, 0).samples);
}
