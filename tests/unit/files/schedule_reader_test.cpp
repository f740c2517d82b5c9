// Schedules as users write them, and what is said of those that can't be.
#include "engine/study/people.hpp"
#include "pirsim/io.hpp"
#include "support/catch.hpp"

using namespace pirsim;

namespace {

ScriptSpec script_with(const std::string& schedule, const std::string& more = "") {
  return io::parse_script("pirsim_script: 1\n" + more + "schedule:\n" + schedule, "s.yaml");
}

void refused(const std::string& schedule, const std::string& message, const std::string& more = "") {
  INFO(schedule);
  CHECK_THROWS_WITH(script_with(schedule, more), contains(message));
}

SceneSpec scene_with(int seats) {
  SceneSpec scene;
  scene.name = "room";
  for (int i = 1; i <= seats; ++i) scene.seats.emplace_back().id = "S" + std::to_string(i);
  scene.entrances.emplace_back().id = "door";
  return scene;
}

void refused_in_room(const std::string& schedule, int seats, const std::string& message) {
  INFO(schedule);
  const ScriptSpec script = script_with(schedule);
  CHECK_THROWS_WITH(people_of(*script.trials.front().schedule, scene_with(seats), 1), contains(message));
}

}  // namespace

TEST_CASE("A schedule is read, written and read again to the same") {
  const ScriptSpec script = script_with(
      "  first_day: 2026-05-04\n  from: 07:30\n  to: 20:00\n  staff: [{role: manager, seats: [S2]}, {count: 3}]\n"
      "  arrival: {mean: 09:15, sd_min: 20}\n  cleaning: 18:30\n  entrances: [door]\n"
      "  meetings: {most_a_day: 4, most_people: 5, held: [{at: 10:00, duration_min: 45, people: 3}], seats: [S5]}\n");
  const ScheduleSpec& schedule = *script.trials.front().schedule;
  CHECK(schedule.from_h == 7.5);
  CHECK(schedule.arrival.mean_h == 9.25);
  CHECK(schedule.staff[0].role == Role::manager);
  CHECK(schedule.staff[1].count == 3);
  CHECK(schedule.meetings[0].held[0].duration_min == 45.0);
  const std::string text = io::to_yaml(script);
  CHECK(io::to_yaml(io::parse_script(text, "again.yaml")) == text);
  CHECK_THAT(text, contains("first_day: 2026-05-04"));
}

TEST_CASE("What can't be in a schedule is refused with its place") {
  refused("  staf: [{count: 2}]\n", "s.yaml:3:3: error: schedule: unknown key 'staf'");
  refused("  staff: [{count: 2}]\n  to: 25:00\n", "s.yaml:4:7: error: to: expected a time of day from 00:00 to 24:00");
  refused("  staff: [{count: 2}]\n  from: 18:00\n  to: 9:00\n",
          "s.yaml:5:7: error: schedule: `to` is not after `from`");
  refused("  staff: [{count: 2}]\n  arrival: {mean: 18:00}\n  departure: {mean: 09:00}\n",
          "s.yaml:5:14: error: schedule: departure must be after arrival");
  refused("  staff: [{count: 2}]\n  arrival: {mean: half past eight}\n", "s.yaml:4:19: error: mean: expected a time");
  refused("  first_day: 2026-02-30\n  staff: [{count: 2}]\n", "s.yaml:3:14: error: '2026-02-30' is no date");
  refused("  from: 08:00\n", "s.yaml:3:3: error: schedule: nobody comes");
  refused("  staff: [{count: 2, seats: [S1, S2, S1]}]\n", "s.yaml:3:38: error: staff: seats: 'S1' is named twice");
  refused("  staff: [{role: manger}]\n", "(did you mean 'manager'?)");
  refused("  meetings: {held: [{at: 10:00, duration_min: 60}, {at: 10:30, duration_min: 60}]}\n",
          "error: held: overlaps");
  refused("  meetings: {held: [{at: 23:30, duration_min: 60}]}\n", "beyond midnight");
  refused("  meetings: {probabilities: [1, 2]}\n", "probabilities: expected");
  refused("  meetings: {probabilities: [0.5, 0.5]}\n", "probabilities: expected one for each of durations_min");
  refused("  staff: [{count: 2}]\n", "leave out duration_s", "duration_s: 90000\n");
}

TEST_CASE("What a room can't hold is refused with its place, and the nearest name") {
  refused_in_room("  staff:\n    - {count: 2}\n    - {count: 5}\n", 4,
                  "s.yaml:5:7: error: schedule: more staff than the 4 seats");
  refused_in_room("  staff: [{seats: [s1]}]\n", 4, "seat 's1' is not in room (did you mean 'S1'?)");
  refused_in_room("  staff: [{seats: [S1]}, {seats: [S1]}]\n", 4, "'S1' is the own desk of two people");
  refused_in_room("  staff: [{count: 1}]\n  entrances: [dor]\n", 4,
                  "entrance 'dor' is not in room (did you mean 'door'?)");
  refused_in_room("  meetings: {most_people: 6}\n", 4, "6 people for the 4 seats of room");
  refused_in_room("  staff: [{count: 3}]\n  meetings: {}\n", 4, "2 people for the 1 seat of");
  refused_in_room("  meetings: {held: [{at: 10:00, people: 9}]}\n", 4, "9 people for the 4 seats");
}

TEST_CASE("Meetings take the seats that are nobody's desk") {
  const ScriptSpec script = script_with("  staff: [{seats: [S2]}, {count: 2}]\n  meetings: {}\n");
  const ScheduleSpec& schedule = *script.trials.front().schedule;
  const SceneSpec scene = scene_with(6);
  CHECK(meeting_seats(schedule, 0, scene) == std::vector<std::string>{"S4", "S5", "S6"});
  const auto people = people_of(schedule, scene, 1);
  REQUIRE(people.size() == 6);
  CHECK(people[0].seat == "S2");
  CHECK(people[2].seat == "S3");
  CHECK(people[5].part == SchedulePart::guest);
}

namespace {

/// Seats 1 m apart along x, all but the first two in an area; `desk` and `sofa` are for something.
SceneSpec floor_with_meeting_room() {
  SceneSpec scene = scene_with(8);
  for (std::size_t i = 0; i < scene.seats.size(); ++i) scene.seats[i].world_from_seat.origin = {double(i), 0.5, 0.0};
  scene.seats[1].uses = {"toilet"};
  scene.seats[7].uses = {"work"};
  scene.areas.push_back({"meet", FloorArea({{{3.5, 1.0}, {7.5, 1.0}, {7.5, -1.0}, {3.5, -1.0}}}, 0.0)});
  return scene;
}

std::vector<std::string> faults_on_floor(const std::string& schedule) {
  const ScriptSpec script = script_with(schedule);
  try {
    static_cast<void>(people_of(*script.trials.front().schedule, floor_with_meeting_room(), 1));
  } catch (const Error& error) {
    std::vector<std::string> messages;
    for (const Issue& issue : error.issues()) messages.push_back(issue.message);
    return messages;
  }
  return {};
}

}  // namespace

TEST_CASE("Rooms for meetings are told apart by area or by seats, and are nobody's desk") {
  const ScriptSpec script =
      script_with("  staff: [{count: 3}]\n  meetings:\n    - {area: meet, attendees: staff}\n    - {seats: [S4]}\n");
  const ScheduleSpec& schedule = *script.trials.front().schedule;
  CHECK(schedule.meetings[0].attendees == Attendees::staff);
  const std::string text = io::to_yaml(script);
  CHECK(io::to_yaml(io::parse_script(text, "again.yaml")) == text);
  const SceneSpec scene = floor_with_meeting_room();
  CHECK(meeting_seats(schedule, 0, scene) == std::vector<std::string>{"S5", "S6", "S7"});  // S8 is for work
  CHECK(most_at_meeting(schedule, 0, scene) == 3);
  const ScheduleSpec two_desks = *script_with("  staff: [{count: 2}]\n  meetings: {area: meet}\n").trials[0].schedule;
  const auto people = people_of(two_desks, scene, 1);
  CHECK(people[0].seat == "S1");
  CHECK(people[1].seat == "S3");  // not the second, which is a toilet's
  CHECK(people.size() == 2 + 3);
}

TEST_CASE("Rooms for meetings that a scene can't hold are refused") {
  const auto one = [](const std::string& schedule, const std::string& message) {
    INFO(schedule);
    const std::vector<std::string> faults = faults_on_floor(schedule);
    REQUIRE(faults.size() == 1);
    CHECK_THAT(faults.front(), contains(message));
  };
  one("  meetings: {area: met}\n", "area 'met' is not in room (did you mean 'meet'?)");
  one("  staff: [{count: 1}]\n  meetings: [{attendees: staff}]\n", "2 people, and 1 of the staff");
  one("  meetings: [{seats: [S1, S3]}, {seats: [S3, S4]}]\n", "seat 'S3' is another room's too");
  one("  meetings: [{}, {}]\n", "is another room's too: say the `area` or the `seats` of each");
  one("  staff: [{count: 4}]\n  meetings: {area: meet}\n", "more staff than the 3 seats");
  refused("  meetings: [{held: [{at: 10:00, duration_min: 60}, {at: 10:30, duration_min: 60}]}]\n", "held: overlaps");
  refused("  meetings: [{attendees: stuff}]\n", "(did you mean 'staff'?)");
}

namespace {

constexpr const char* couple =
    "  household:\n    residents:\n      - {id: ann, occupation: works, age_years: 38}\n      - {id: bob, bed: B2}\n";

SceneSpec flat_with_beds(int beds) {
  SceneSpec scene = scene_with(1);
  for (int i = 1; i <= beds; ++i) {
    PlaceSpec& bed = scene.places.emplace_back();
    bed.id = "B" + std::to_string(i);
    bed.posture = PlacePosture::lie;
    bed.uses = {"sleep"};
  }
  return scene;
}

void no_home(const std::string& schedule, int beds, const std::string& message) {
  INFO(schedule);
  const ScriptSpec script = script_with(schedule);
  CHECK_THROWS_WITH(people_of(*script.trials.front().schedule, flat_with_beds(beds), 1), contains(message));
}

}  // namespace

TEST_CASE("A household is read, written and read again to the same, its days go from four to four") {
  const ScriptSpec script =
      script_with(std::string(couple) + "    visits_a_week: 2\n    wakes: {mean: 06:30, sd_min: 10}\n");
  const ScheduleSpec& schedule = *script.trials.front().schedule;
  REQUIRE(schedule.household);
  CHECK(schedule.from_h == 4.0);
  CHECK(schedule.to_h == 28.0);
  CHECK(schedule.household->residents[0].occupation == Occupation::works);
  CHECK(schedule.household->residents[1].bed == "B2");
  CHECK(schedule.household->wakes.mean_h == 6.5);
  CHECK(schedule.household->visits_a_week == 2.0);
  const std::string text = io::to_yaml(script);
  CHECK(io::to_yaml(io::parse_script(text, "again.yaml")) == text);
}

TEST_CASE("What can't be a household is refused with its place") {
  refused("  household: {}\n", "s.yaml:3:14: error: household: residents: nobody lives there");
  refused("  household: {residents: [{id: a}, {id: b}, {id: c}, {id: d}, {id: e}, {id: f}]}\n", "more than five");
  refused("  household: {residents: [{id: a}, {id: a}]}\n", "'a'");
  refused("  household: {residents: [{name: a}]}\n", "unknown key 'name'");
  refused("  household: {pets: [{kind: cat}], residents: [{id: a}]}\n",
          "household: unknown key 'pets': it belongs to the script itself, at the left margin");
  refused("  pets: [{kind: cat}]\n  household: {residents: [{id: a}]}\n", "it belongs to the script itself");
  refused("  household: {residents: [{id: a, occupation: work}]}\n", "did you mean 'works'?");
  refused("  household: {residents: [{id: a, occupation: work_at_home}]}\n", "did you mean 'works_at_home'?");
  refused("  household: {residents: [{id: a, age_years: 3}]}\n", "age_years: expected");
  refused("  household: {residents: [{id: a}], goes_to_bed: {mean: 06:00}}\n", "goes_to_bed: is not after `wakes`");
  refused(std::string(couple) + "  cleaning: 19:00\n", "schedule: `household` goes without `staff`, `meetings`");
  refused(std::string(couple) + "  from: 06:00\n", "leave out `from` and `to`");
}

TEST_CASE("Residents take their own beds, then those that nobody has, one without is an error") {
  const ScriptSpec script = script_with(couple);
  const auto people = people_of(*script.trials.front().schedule, flat_with_beds(2), 1);
  REQUIRE(people.size() == 3);
  CHECK(people[0].seat == "B1");
  CHECK(people[1].seat == "B2");
  CHECK(people[2].part == SchedulePart::visitor);
  no_home(couple, 0, "bed 'B2' is no place for sleep in room");
  no_home("  household: {residents: [{id: a}, {id: b}]}\n", 1, "household: 'b' has no bed: room has 1 place");
  no_home("  household: {residents: [{id: a, bed: B1}, {id: b, bed: B1}]}\n", 2, "'B1' is the own bed of two people");
}
